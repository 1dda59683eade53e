// The planners that are shown a polygon world, and what they make of it.
#include "library/navigation_polygons.hpp"

#include <nanobind/stl/array.h>

#include "maps_points.hpp"
#include "navigation_query.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

template <PolygonPlanner planner>
struct PolygonSearch : SearchOf<PolygonCore> {
    bool is_concurrent(const Core&) const { return false; }
    bool find(const Core& core, Point start, Point goal, Trace* trace) {
        return find_polygon_route(core, planner, start, goal, found, trace);
    }
};

// depth, most_depth, refine, uniform, manhattan, most_cells; the evidence is what the last, called with the
// free, mixed and full leaves and the depth, makes of them.
struct CellSearch : SearchOf<PolygonCore, CellRoute> {
    static constexpr int settings = 7;
    std::array<std::int64_t, 6> numbers;
    PyObject* describe;

    bool read(const Core&, PyObject* const* args) { return describe = args[6], read_settings(args, numbers); }
    bool find(const Core& core, Point start, Point goal, Trace* trace) {
        return find_cell_route(core, start, goal, numbers.data(), found, trace);
    }
    PyObject* evidence() const {
        const auto& [free, mixed, full] = found.leaves;
        return PyObject_CallFunction(describe, "LLLi", free, mixed, full, found.depth);
    }
};

// planner, samples, seed, neighbours, step, goal bias; the evidence is made with the last, called with
// samples, nodes and edges.
struct SampleSearch : SearchOf<PolygonCore, SampledRoute> {
    static constexpr int settings = 2;
    SamplingSettings options;
    PyObject* describe;

    bool read(const Core&, PyObject* const* args) {
        describe = args[1];
        return PyArg_ParseTuple(args[0], "iLKLdd", &options.planner, &options.samples, &options.seed,
                                &options.neighbours, &options.step, &options.goal_bias);
    }
    bool find(const Core& core, Point start, Point goal, Trace* trace) {
        return find_sampled_route(core, options, start, goal, found, trace);
    }
    PyObject* evidence() const {
        return PyObject_CallFunction(describe, "LLL", found.samples, route().stats.nodes,
                                     route().stats.edges);
    }
};

// widest, tolerance; the evidence is made with the last, called with four clearances.
struct DiagramSearch : SearchOf<PolygonCore, DiagramRoute> {
    static constexpr int settings = 3;
    bool is_widest;
    double tolerance;
    PyObject* describe;

    bool read(const Core&, PyObject* const* args) {
        is_widest = args[0] == Py_True, tolerance = PyFloat_AsDouble(args[1]), describe = args[2];
        return !PyErr_Occurred();
    }
    bool find(const Core& core, Point start, Point goal, Trace* trace) {
        return find_voronoi_route(core, start, goal, is_widest, tolerance, found, trace);
    }
    PyObject* evidence() const {
        if (route().status != Status::found) return nullptr;
        return PyObject_CallFunction(describe, "dddd", found.clearance, found.on_diagram, found.at_start,
                                     found.at_goal);
    }
};

PyMethodDef methods[] = {
    {"_any_angle", fast(ask<PolygonSearch<PolygonPlanner::any_angle>>), METH_FASTCALL, nullptr},
    {"_visibility", fast(ask<PolygonSearch<PolygonPlanner::visibility>>), METH_FASTCALL, nullptr},
    {"_exact_cells", fast(ask<PolygonSearch<PolygonPlanner::exact_cells>>), METH_FASTCALL, nullptr},
    {"_approximate_cells", fast(ask<CellSearch>), METH_FASTCALL, nullptr},
    {"_sampling", fast(ask<SampleSearch>), METH_FASTCALL, nullptr},
    {"_voronoi", fast(ask<DiagramSearch>), METH_FASTCALL, nullptr},
    {nullptr, nullptr, 0, nullptr}};

// Its nodes (n, 2) and edges (k, 2), each once.
nb::tuple visibility_graph(const PolygonCore& core) {
    std::vector<Point> nodes;
    std::vector<std::int32_t> edges;
    list_visibility_graph(core, nodes, edges);
    return nb::make_tuple(point_table(nodes), table(std::move(edges), 2));
}

// The corners of each cell (k, 8): lower left, lower right, upper right, upper left; the doors as pairs of
// cells (d, 2).
nb::tuple exact_cells(const PolygonCore& core) {
    std::vector<Point> corners;
    std::vector<std::int32_t> doors;
    list_exact_cells(core, corners, doors);
    return nb::make_tuple(point_table(corners, 4), table(std::move(doors), 2));
}

// Squares (k, 4) and kinds (k,) of the leaves.
nb::tuple cell_leaves(const PolygonCore& core, const std::array<std::int64_t, 6>& settings) {
    std::vector<double> squares;
    std::vector<std::int8_t> kinds;
    {
        const nb::gil_scoped_release free;
        list_cell_leaves(core, settings.data(), squares, kinds);
    }
    return nb::make_tuple(table(std::move(squares), 4), table(std::move(kinds)));
}

// Vertices (n, 2), their clearance (n,), ends of arcs (k, 2), a list of (polyline, clearance), and whether
// all components are whole.
nb::tuple voronoi_diagram(const PolygonCore& core, double tolerance) {
    VoronoiArcs diagram = list_voronoi_arcs(core, tolerance);
    std::vector<std::int32_t> ends;
    nb::list arcs;
    for (VoronoiArc& arc : diagram.arcs) {
        ends.insert(ends.end(), {arc.from, arc.to});
        arcs.append(nb::make_tuple(point_table(arc.line), table(std::move(arc.clearance))));
    }
    return nb::make_tuple(point_table(diagram.vertices), table(std::move(diagram.clearance)),
                          table(std::move(ends), 2), arcs, diagram.is_whole);
}

}  // namespace

void bind_navigation_polygons(nb::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
    m.def("_visibility_graph", visibility_graph, "core"_a);
    m.def("_exact_cells_all", exact_cells, "core"_a);
    m.def("_approximate_cells_all", cell_leaves, "core"_a, "settings"_a);
    m.def("_voronoi_diagram", voronoi_diagram, "core"_a, "tolerance"_a);
}
