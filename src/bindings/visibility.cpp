// The visibility graph: built once for a world, then asked.
#include <chrono>

#include "polygon_world.hpp"
#include "route.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

VisibilitySearch& search_of(PolygonCore& core) {
    if (!core.visibility) core.visibility = std::make_unique<VisibilitySearch>(core.world);
    return *core.visibility;
}

struct Question {
    PolygonCore* core;
    double start[2], goal[2];
    Settled from, to;

    // False where an end lies in an obstacle.
    bool settle() {
        from = core->world.settle({start[0], start[1]}, core->tolerance);
        to = core->world.settle({goal[0], goal[1]}, core->tolerance);
        return from.is_free() && to.is_free();
    }
    Route answer(Trace* trace) {
        Route route;
        route.status = Status::unreachable;
        if (core->world.shared_component(from, to) == none) return route;
        route = search_of(*core).solve(from, to, trace);
        if (!route.path.empty())
            route.path.front() = {start[0], start[1]}, route.path.back() = {goal[0], goal[1]};
        return route;
    }
};

// _visibility(world, core, planner, options, start, goal) → route, or None where an end needs a closer look.
PyObject* visibility(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Question q{};
    q.core = count == 6 ? polygon_core_of(args[1]) : nullptr;
    if (!q.core) {
        PyErr_SetString(PyExc_TypeError,
                        "_visibility takes a world, its core, a planner, options and two points");
        return nullptr;
    }
    if (!read_point(args[4], q.start) || !read_point(args[5], q.goal)) Py_RETURN_NONE;
    const auto begin = std::chrono::steady_clock::now();
    if (!q.settle()) Py_RETURN_NONE;
    const Route route = q.answer(nullptr);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return make_route(args[0], args[2], args[3] == Py_None ? nullptr : args[3], q.start, q.goal, route,
                      seconds);
}

// _visibility_trace(core, start, goal) → the arrays of its trace
PyObject* visibility_trace(PyObject*, PyObject* args) {
    PyObject *owner, *start, *goal;
    if (!PyArg_ParseTuple(args, "OOO", &owner, &start, &goal)) return nullptr;
    Question q{};
    q.core = polygon_core_of(owner);
    if (!q.core || !read_point(start, q.start) || !read_point(goal, q.goal)) {
        PyErr_SetString(PyExc_TypeError, "_visibility_trace takes a core and two points");
        return nullptr;
    }
    Trace trace;
    if (q.settle()) q.answer(&trace);
    return trace_arrays(trace);
}

// _visibility_graph(core) → its nodes (n, 2) and edges (k, 2), each once
PyObject* visibility_graph(PyObject*, PyObject* owner) {
    PolygonCore* core = polygon_core_of(owner);
    if (!core) {
        PyErr_SetString(PyExc_TypeError, "_visibility_graph takes the core of a world");
        return nullptr;
    }
    const VisibilityGraph& graph = search_of(*core).graph();
    npy_intp node_shape[2] = {graph.size(), 2}, edge_shape[2] = {npy_intp(graph.edges() / 2), 2};
    PyObject* nodes = PyArray_SimpleNew(2, node_shape, NPY_DOUBLE);
    PyObject* edges = PyArray_SimpleNew(2, edge_shape, NPY_INT32);
    if (!nodes || !edges) {
        Py_XDECREF(nodes);
        Py_XDECREF(edges);
        return nullptr;
    }
    auto* point = static_cast<Point*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(nodes)));
    auto* pair = static_cast<Index*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(edges)));
    std::size_t k = 0;
    for (Index n = 0; n < graph.size(); ++n) {
        point[n] = graph.point(n);
        for (const auto& edge : graph.edges_of(n))
            if (n < edge.to && k < graph.edges() / 2) pair[2 * k] = n, pair[2 * k + 1] = edge.to, ++k;
    }
    return Py_BuildValue("NN", nodes, edges);
}

PyMethodDef methods[] = {
    {"_visibility", reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(visibility)), METH_FASTCALL,
     nullptr},
    {"_visibility_trace", visibility_trace, METH_VARARGS, nullptr},
    {"_visibility_graph", visibility_graph, METH_O, nullptr},
    {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_visibility(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
