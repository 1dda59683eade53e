// The planners that are shown a polygon world, as raw entries: a question is worth microseconds. Each comes
// twice, as _NAME(world, core, planner, options, start, goal) → route, or None where an end needs a closer
// look, and as _NAME_trace(core, start, goal) → the arrays of its trace.
#include <chrono>

#include "maps_polygon_world.hpp"
#include "navigation_route.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

struct Question {
    PolygonCore& core;
    double start[2], goal[2];
    Settled from{}, to{};

    bool read(PyObject* start_given, PyObject* goal_given) {
        return read_point(start_given, start) && read_point(goal_given, goal);
    }
    // False where an end lies in an obstacle.
    bool settle() {
        from = core.world.settle({start[0], start[1]}, core.tolerance);
        to = core.world.settle({goal[0], goal[1]}, core.tolerance);
        return from.is_free() && to.is_free();
    }
};

using Planner = Route (*)(Question&, Trace*);

Route answer(Planner planner, Question& q, Trace* trace) {
    Route route;
    route.status = Status::unreachable;
    if (q.core.world.shared_component(q.from, q.to) == none) return route;
    route = planner(q, trace);
    const Point start{q.start[0], q.start[1]}, goal{q.goal[0], q.goal[1]};
    if (route.path.empty() || (q.from.at == start && q.to.at == goal)) return route;
    route.path.front() = start, route.path.back() = goal;  // they were taken off a wall
    route.length = length_of(route.path);
    return route;
}

template <class T, class... Arguments>
T& made(std::unique_ptr<T>& kept, const Arguments&... arguments) {
    if (!kept) kept = std::make_unique<T>(arguments...);
    return *kept;
}

Route any_angle(Question& q, Trace* trace) {
    const ConvexMesh& mesh = q.core.world.mesh();
    for (Settled* end : {&q.from, &q.to})
        for (Index& t : end->triangles) t = mesh.of_triangle[std::size_t(t)];
    return made(q.core.shortest, mesh).solve(q.from.at, q.from.triangles, q.to.at, q.to.triangles, trace);
}
Route visibility(Question& q, Trace* trace) {
    return made(q.core.visibility, q.core.world).solve(q.from, q.to, trace);
}
Route exact_cells(Question& q, Trace* trace) {
    return made(q.core.cells, q.core.world).solve(q.from.at, q.to.at, trace);
}

template <Planner planner>
PyObject* ask(PyObject*, PyObject* const* args, Py_ssize_t count) {
    PolygonCore* core = count == 6 ? polygon_core_of(args[1]) : nullptr;
    if (!core) {
        PyErr_SetString(PyExc_TypeError, "a planner takes a world, its core, a name, options and two points");
        return nullptr;
    }
    Question q{*core, {}, {}};
    if (!q.read(args[4], args[5])) Py_RETURN_NONE;
    const auto begin = std::chrono::steady_clock::now();
    if (!q.settle()) Py_RETURN_NONE;
    const Route route = answer(planner, q, nullptr);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return make_route(args[0], args[2], args[3] == Py_None ? nullptr : args[3], q.start, q.goal, route,
                      seconds);
}

template <Planner planner>
PyObject* retrace(PyObject*, PyObject* args) {
    PyObject *owner, *start, *goal;
    if (!PyArg_ParseTuple(args, "OOO", &owner, &start, &goal)) return nullptr;
    PolygonCore* core = polygon_core_of(owner);
    if (!core) {
        PyErr_SetString(PyExc_TypeError, "a trace takes the core of a world and two points");
        return nullptr;
    }
    Question q{*core, {}, {}};
    Trace trace;
    if (q.read(start, goal) && q.settle()) answer(planner, q, &trace);
    return trace_arrays(trace);
}

// An array of numpy and its numbers.
template <class T>
PyObject* rows(npy_intp count, npy_intp width, int type, T*& data) {
    npy_intp shape[2] = {count, width};
    PyObject* array = PyArray_SimpleNew(2, shape, type);
    data = array ? static_cast<T*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array))) : nullptr;
    return array;
}

// _visibility_graph(core) → its nodes (n, 2) and edges (k, 2), each once
PyObject* visibility_graph(PyObject*, PyObject* owner) {
    PolygonCore* core = polygon_core_of(owner);
    if (!core) {
        PyErr_SetString(PyExc_TypeError, "_visibility_graph takes the core of a world");
        return nullptr;
    }
    const VisibilityGraph& graph = made(core->visibility, core->world).graph();
    std::vector<std::pair<Index, Index>> pairs;
    for (Index n = 0; n < graph.size(); ++n)
        for (const auto& edge : graph.edges_of(n))
            if (n < edge.to) pairs.push_back({n, edge.to});
    Point* point;
    Index* pair;
    PyObject* nodes = rows(graph.size(), 2, NPY_DOUBLE, point);
    PyObject* edges = rows(npy_intp(pairs.size()), 2, NPY_INT32, pair);
    if (!nodes || !edges) return Py_XDECREF(nodes), Py_XDECREF(edges), nullptr;
    for (Index n = 0; n < graph.size(); ++n) point[n] = graph.point(n);
    for (const auto& [a, b] : pairs) *pair++ = a, *pair++ = b;
    return Py_BuildValue("NN", nodes, edges);
}

// _exact_cells_all(core) → the corners of each cell (k, 8): lower left, lower right, upper right, upper left;
// the doors as pairs of cells (d, 2)
PyObject* exact_cells_all(PyObject*, PyObject* owner) {
    PolygonCore* core = polygon_core_of(owner);
    if (!core) {
        PyErr_SetString(PyExc_TypeError, "_exact_cells_all takes the core of a world");
        return nullptr;
    }
    const Trapezoids& all = made(core->cells, core->world).cells();
    Point* corner;
    Index* pair;
    PyObject* cells = rows(npy_intp(all.cells.size()), 8, NPY_DOUBLE, corner);
    PyObject* doors = rows(npy_intp(all.doors.size()), 2, NPY_INT32, pair);
    if (!cells || !doors) return Py_XDECREF(cells), Py_XDECREF(doors), nullptr;
    for (const Trapezoid& c : all.cells) {
        const SweptWall &bottom = all.wall(c.bottom), &top = all.wall(c.top);
        *corner++ = {c.left.x, bottom.y_at(c.left.x)};
        *corner++ = {c.right.x, bottom.y_at(c.right.x)};
        *corner++ = {c.right.x, top.y_at(c.right.x)};
        *corner++ = {c.left.x, top.y_at(c.left.x)};
    }
    for (const Door& d : all.doors) *pair++ = d.left, *pair++ = d.right;
    return Py_BuildValue("NN", cells, doors);
}

PyCFunction fast(PyObject* (*function)(PyObject*, PyObject* const*, Py_ssize_t)) {
    return reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(function));
}

PyMethodDef methods[] = {{"_any_angle", fast(ask<any_angle>), METH_FASTCALL, nullptr},
                         {"_any_angle_trace", retrace<any_angle>, METH_VARARGS, nullptr},
                         {"_visibility", fast(ask<visibility>), METH_FASTCALL, nullptr},
                         {"_visibility_trace", retrace<visibility>, METH_VARARGS, nullptr},
                         {"_visibility_graph", visibility_graph, METH_O, nullptr},
                         {"_exact_cells", fast(ask<exact_cells>), METH_FASTCALL, nullptr},
                         {"_exact_cells_trace", retrace<exact_cells>, METH_VARARGS, nullptr},
                         {"_exact_cells_all", exact_cells_all, METH_O, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_polygons(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
