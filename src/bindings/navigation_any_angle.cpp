// The shortest path between points of a grid whose cells are not made into polygons, as a raw entry:
// _grid_any_angle(world, planner, options, start, goal) → route, or None where an end lies in no
// free cell; _grid_any_angle_trace(world, start, goal) → the arrays of its trace.
#include "bindings.hpp"
#include "library/navigation_grid.hpp"
#include "maps_grid.hpp"
#include "navigation_route.hpp"

namespace nb = nanobind;
using namespace cspace;
using namespace cspace::navigation;

namespace {

bool find_freely(const GridWorld& world, Point start, Point goal, Route& route, Trace* trace) {
    const nb::gil_scoped_release free;
    return find_any_angle_route(world, start, goal, heed_interrupts, route, trace);
}

PyObject* ask(PyObject*, PyObject* args) {
    PyObject *grid, *planner, *options, *start_given, *goal_given;
    if (!PyArg_ParseTuple(args, "OUOOO", &grid, &planner, &options, &start_given, &goal_given))
        return nullptr;
    const GridWorld* world = grid_of(grid);
    if (!world) return nullptr;
    Point start, goal;
    if (!read_point(start_given, start) || !read_point(goal_given, goal)) Py_RETURN_NONE;
    return search_grid(*world, [&]() -> PyObject* {
        const Watch watch;
        Route route;
        if (!find_freely(*world, start, goal, route, nullptr)) Py_RETURN_NONE;
        return make_route(grid, planner, options, start, goal, route, watch.seconds());
    });
}

PyObject* retrace(PyObject*, PyObject* args) {
    PyObject *grid, *start_given, *goal_given;
    if (!PyArg_ParseTuple(args, "OOO", &grid, &start_given, &goal_given)) return nullptr;
    const GridWorld* world = grid_of(grid);
    if (!world) return nullptr;
    return search_grid(*world, [&] {
        Point start, goal;
        Route route;
        Trace trace;
        if (read_point(start_given, start) && read_point(goal_given, goal))
            find_freely(*world, start, goal, route, &trace);
        return trace_arrays(trace);
    });
}

PyMethodDef methods[] = {{"_grid_any_angle", ask, METH_VARARGS, nullptr},
                         {"_grid_any_angle_trace", retrace, METH_VARARGS, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_any_angle(nb::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
}
