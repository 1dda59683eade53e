// The shortest path in a polygon world as a raw entry: it is worth a microsecond.
#include <chrono>

#include "polygon_world.hpp"
#include "route.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

Route shortest(PolygonCore& core, Point start, Settled& from, Point goal, Settled& to, Trace* trace) {
    if (core.world.shared_component(from, to) == none) {
        Route route;
        route.status = Status::unreachable;
        return route;
    }
    if (!core.shortest) core.shortest = std::make_unique<Polyanya>(core.world.mesh());
    for (Settled* ends : {&from, &to})
        for (Index& t : ends->triangles) t = core.world.mesh().of_triangle[std::size_t(t)];
    Route route = core.shortest->solve(from.at, from.triangles, to.at, to.triangles, trace);
    if (!route.path.empty()) route.path.front() = start, route.path.back() = goal;
    return route;
}

// _any_angle(world, core, planner, options, start, goal) → route, or None where an end needs a closer look.
PyObject* any_angle(PyObject*, PyObject* const* args, Py_ssize_t count) {
    PolygonCore* core = count == 6 ? polygon_core_of(args[1]) : nullptr;
    if (!core) {
        PyErr_SetString(PyExc_TypeError,
                        "_any_angle takes a world, its core, a planner, options and two points");
        return nullptr;
    }
    double ends[4];
    if (!read_point(args[4], ends) || !read_point(args[5], ends + 2)) Py_RETURN_NONE;
    const auto begin = std::chrono::steady_clock::now();
    const Point start{ends[0], ends[1]}, goal{ends[2], ends[3]};
    Settled from = core->world.settle(start, core->tolerance), to = core->world.settle(goal, core->tolerance);
    if (!from.is_free() || !to.is_free()) Py_RETURN_NONE;
    const Route route = shortest(*core, start, from, goal, to, nullptr);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return make_route(args[0], args[2], args[3] == Py_None ? nullptr : args[3], ends, ends + 2, route,
                      seconds);
}

// _any_angle_trace(core, start, goal) → the arrays of its trace
PyObject* any_angle_trace(PyObject*, PyObject* args) {
    PyObject *owner, *start_given, *goal_given;
    double start[2], goal[2];
    if (!PyArg_ParseTuple(args, "OOO", &owner, &start_given, &goal_given)) return nullptr;
    PolygonCore* core = polygon_core_of(owner);
    if (!core || !read_point(start_given, start) || !read_point(goal_given, goal)) {
        PyErr_SetString(PyExc_TypeError, "_any_angle_trace takes a core and two points");
        return nullptr;
    }
    const Point a{start[0], start[1]}, b{goal[0], goal[1]};
    Settled from = core->world.settle(a, core->tolerance), to = core->world.settle(b, core->tolerance);
    Trace trace;
    if (from.is_free() && to.is_free()) shortest(*core, a, from, b, to, &trace);
    return trace_arrays(trace);
}

PyMethodDef methods[] = {
    {"_any_angle", reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(any_angle)), METH_FASTCALL,
     nullptr},
    {"_any_angle_trace", any_angle_trace, METH_VARARGS, nullptr},
    {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_any_angle(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
