// Occupancy grids and the searches over them.
#include "library/navigation_grid.hpp"

#include <utility>

#include "maps_points.hpp"
#include "navigation_query.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

using Bytes = Array<const std::uint8_t, nb::ndim<2>>;
using BytesOut = Array<std::uint8_t, nb::ndim<2>>;

void new_grid(GridWorld* at, Bytes blocked, double resolution, double x, double y) {
    new (at) GridWorld(blocked.data(), int(blocked.shape(0)), int(blocked.shape(1)), resolution, {x, y});
}
// Of a grid, or of the one that a replanner keeps.
template <class Grid>
void unpack(const Grid& grid, BytesOut into) {
    if (int(into.shape(0)) != grid.rows() || int(into.shape(1)) != grid.columns())
        throw nb::value_error("the array must have the shape of the grid");
    grid.unpack(into.data());
}
// Which points (k, 2) lie in free cells or on their borders.
void free_points(const GridWorld& world, Points points, Array<std::uint8_t, nb::ndim<1>> into) {
    if (into.shape(0) != points.shape(0)) throw nb::value_error("into must have one entry per point");
    std::uint8_t* out = into.data();
    for (const Point p : points_of(points)) *out++ = world.locate(p).state == 0;
}
double path_least(const GridWorld& world, Points path) {
    const nb::gil_scoped_release free;
    return world.path_clearance(points_of(path));
}
nb::tuple locate(const GridWorld& world, double x, double y) {
    const auto [state, row, column] = world.locate({x, y});
    return nb::make_tuple(state, row, column);
}

// kind, corners, metric, g_weight, h_weight, bound, costs, least_cost
struct CellsSearch : SearchOf<GridWorld, GridFinding> {
    static constexpr int settings = 8;
    GridQuestion q;
    double side;
    // Its memory is kept from one query to the next. Making the route may collect garbage and so run any
    // code, another query too, which then finds it empty.
    static thread_local GridFinding kept;

    CellsSearch() { found = std::move(kept); }
    ~CellsSearch() { kept = std::move(found); }

    bool read(const Core& world, PyObject* const* args) {
        std::array<std::int64_t, 3> words;
        std::array<double, 3> weights;
        if (!read_settings(args, words) || !read_settings(args + 3, weights)) return false;
        q = {words[0],   words[1],   words[2], weights[0],
             weights[1], weights[2], nullptr,  PyFloat_AsDouble(args[7])};
        side = world.resolution();
        if (PyErr_Occurred() || (args[6] != Py_None && !read_costs(world, args[6]))) return false;
        return q.is_known() ||
               (PyErr_SetString(PyExc_ValueError, "unknown planner, corner rule or metric"), false);
    }
    bool read_costs(const Core& world, PyObject* given) {
        auto* array = reinterpret_cast<PyArrayObject*>(given);
        if (!PyArray_Check(given) || PyArray_TYPE(array) != NPY_DOUBLE || !PyArray_ISCARRAY_RO(array) ||
            PyArray_NDIM(array) != 2 || PyArray_DIM(array, 0) != world.rows() ||
            PyArray_DIM(array, 1) != world.columns()) {
            PyErr_SetString(PyExc_TypeError,
                            "costs must be a contiguous float64 array of the shape of the grid");
            return false;
        }
        q.costs = static_cast<const double*>(PyArray_DATA(array));
        return true;
    }
    // A search of few cells takes no longer than to free the interpreter.
    bool is_concurrent(const Core& world) const { return world.cells() > 1 << 14; }
    bool find(const Core& world, Point start, Point goal, Trace* trace) {
        return find_grid_route(world, q, start, goal, found, trace);
    }
    // Where path and length do not say it: what the way costs, and a bound below the best.
    PyObject* evidence() const {
        if (found.parts) return Py_BuildValue("{s:L}", "parts", static_cast<long long>(found.parts));
        if (!found.found || !q.has_bounds()) return nullptr;
        return Py_BuildValue("{s:d,s:d}", "cost", side * found.cost, "at_least", side * found.least);
    }
};
thread_local GridFinding CellsSearch::kept;

struct AnyAngleSearch : SearchOf<GridWorld> {
    bool find(const Core& world, Point start, Point goal, Trace* trace) {
        return find_any_angle_route(world, start, goal, found, trace);
    }
};

PyMethodDef methods[] = {{"_grid_route", fast(ask<CellsSearch>), METH_FASTCALL, nullptr},
                         {"_grid_any_angle", fast(ask<AnyAngleSearch>), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

using Cells = Array<const std::int32_t, nb::shape<-1, 2>>;

void new_replanner(GridReplanner* at, const GridWorld& world, int corners, double x0, double y0, double x1,
                   double y1) {
    new (at) GridReplanner(world, corners, {x0, y0}, {x1, y1});
}
void set_cells(GridReplanner& planner, Cells cells, bool blocked) {
    const nb::gil_scoped_release free;
    planner.set_cells({cells.data(), 2 * cells.shape(0)}, blocked);
}
// (status, path (m, 2), length, nodes, edges, settled cells (k, 2))
nb::tuple replan(GridReplanner& planner) {
    std::vector<std::int32_t> settled;
    Route route;
    {
        const nb::gil_scoped_release free;
        route = planner.replan(settled);
    }
    return nb::make_tuple(int(route.status), point_table(std::move(route.path)), route.length,
                          route.stats.nodes, route.stats.edges, table(std::move(settled), 2));
}

void bind_replanner(nb::module_& m) {
    nb::class_<GridReplanner>(m, "GridReplanner", "The compiled half of cspace.navigation.DStarLite.")
        .def("__init__", new_replanner, "world"_a, "corners"_a, "x0"_a, "y0"_a, "x1"_a, "y1"_a)
        .def("set", set_cells, "cells"_a, "blocked"_a, "Cells (k, 2) become blocked or free.")
        .def(
            "move", [](GridReplanner& planner, double x, double y) { planner.move_to({x, y}); }, "x"_a, "y"_a,
            "The robot has moved.")
        .def("replan", replan, "Status, path, length, nodes, edges, and the cells settled, in their order.")
        .def("unpack", unpack<GridReplanner>, "into"_a, "Writes a byte per cell.");
}

}  // namespace

void bind_navigation_grid(nb::module_& m) {
    nb::class_<GridWorld>(m, "GridBase", "The compiled half of cspace.maps.OccupancyGrid.")
        .def("__init__", new_grid, "blocked"_a, "resolution"_a, "x"_a, "y"_a)
        .def(nb::init<const GridWorld&, double, bool>(), "other"_a, "radius"_a, "from_centers"_a,
             nb::call_guard<nb::gil_scoped_release>())
        .def("_unpack", unpack<GridWorld>, "into"_a, "Writes a byte per cell.")
        .def("_free", free_points, "points"_a, "into"_a, "Writes 1 for points in free cells.")
        .def("_path_clearance", path_least, "path"_a, "The least distance from a path to a blocked cell.")
        .def("_locate", locate, "x"_a, "y"_a, "Place, row and column of a point.")
        .def_prop_ro("rows", &GridWorld::rows, "Number of rows.")
        .def_prop_ro("columns", &GridWorld::columns, "Number of columns.")
        .def_prop_ro("resolution", &GridWorld::resolution, "Side of a cell [m].")
        .def_prop_ro("_x", [](const GridWorld& world) { return world.origin().x; })
        .def_prop_ro("_y", [](const GridWorld& world) { return world.origin().y; })
        .def_prop_ro("blocked_cells", &GridWorld::count_blocked, "How many cells are blocked.")
        .def_prop_ro("_corners", &GridWorld::count_corners)
        .def_prop_ro("nbytes", &GridWorld::bytes,
                     "Memory that the cells, and their parts if a search has asked for them, take [bytes].");
    bind_replanner(m);
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
}
