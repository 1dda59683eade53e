// The planners that are shown a polygon world, as raw entries: a question is worth microseconds. Each comes
// twice, as _NAME(world, core, planner, options, start, goal) → route, or None where an end needs a closer
// look, and as _NAME_trace(core, start, goal) → the arrays of its trace.
#include "library/navigation_polygons.hpp"

#include "maps_polygon_world.hpp"

using namespace cspace;
using namespace cspace::navigation;

namespace {

template <PolygonPlanner planner>
PyObject* ask(PyObject*, PyObject* const* args, Py_ssize_t count) {
    PolygonQuestion q;
    if (count != 6) return PyErr_SetString(PyExc_TypeError, "a planner needs six arguments"), nullptr;
    if (!q.read(args[1], args[4], args[5])) return no_answer();
    const Watch watch;
    Route route;
    if (!find_polygon_route(*q.core, planner, q.start, q.goal, route, nullptr)) Py_RETURN_NONE;
    return make_route(args[0], args[2], args[3], q.start, q.goal, route, watch.seconds());
}

template <PolygonPlanner planner>
PyObject* retrace(PyObject*, PyObject* const* args, Py_ssize_t count) {
    PolygonQuestion q;
    Route route;
    Trace trace;
    if (count != 3) return PyErr_SetString(PyExc_TypeError, "a trace needs three arguments"), nullptr;
    if (q.read(args[0], args[1], args[2]))
        find_polygon_route(*q.core, planner, q.start, q.goal, route, &trace);
    return PyErr_Occurred() ? nullptr : trace_arrays(trace);
}

// _visibility_graph(core) → its nodes (n, 2) and edges (k, 2), each once
PyObject* visibility_graph(PyObject*, PyObject* owner) {
    const PolygonCore* core = polygon_core_of(owner);
    if (!core) return nullptr;
    std::vector<Point> nodes;
    std::vector<std::int32_t> edges;
    list_visibility_graph(*core, nodes, edges);
    return Py_BuildValue("NN", rows_of(nodes), rows_of(edges, 2, NPY_INT32));
}

// _exact_cells_all(core) → the corners of each cell (k, 8): lower left, lower right, upper right, upper left;
// the doors as pairs of cells (d, 2)
PyObject* exact_cells_all(PyObject*, PyObject* owner) {
    const PolygonCore* core = polygon_core_of(owner);
    if (!core) return nullptr;
    std::vector<Point> corners;
    std::vector<std::int32_t> doors;
    list_exact_cells(*core, corners, doors);
    return Py_BuildValue("NN", rows_of(corners, 4), rows_of(doors, 2, NPY_INT32));
}

constexpr auto any_angle = PolygonPlanner::any_angle, visibility = PolygonPlanner::visibility,
               exact_cells = PolygonPlanner::exact_cells;
PyMethodDef methods[] = {{"_any_angle", fast(ask<any_angle>), METH_FASTCALL, nullptr},
                         {"_any_angle_trace", fast(retrace<any_angle>), METH_FASTCALL, nullptr},
                         {"_visibility", fast(ask<visibility>), METH_FASTCALL, nullptr},
                         {"_visibility_trace", fast(retrace<visibility>), METH_FASTCALL, nullptr},
                         {"_visibility_graph", visibility_graph, METH_O, nullptr},
                         {"_exact_cells", fast(ask<exact_cells>), METH_FASTCALL, nullptr},
                         {"_exact_cells_trace", fast(retrace<exact_cells>), METH_FASTCALL, nullptr},
                         {"_exact_cells_all", exact_cells_all, METH_O, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_polygons(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
