// D* Lite over an occupancy grid of its own.
#include "library/navigation_replanning.hpp"
#include "maps_grid.hpp"
#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

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
    const std::size_t count = settled.size() / 2;
    return nb::make_tuple(int(route.status), point_table(route.path), route.length, route.stats.nodes,
                          route.stats.edges, table(std::move(settled), count, 2));
}

void unpack(const GridReplanner& planner, Array<std::uint8_t, nb::ndim<2>> into) {
    if (int(into.shape(0)) != planner.rows() || int(into.shape(1)) != planner.columns())
        throw nb::value_error("the array must have the shape of the grid");
    planner.unpack(into.data());
}

}  // namespace

void bind_navigation_grid_replanning(nb::module_& m) {
    nb::class_<GridReplanner>(m, "GridReplanner", "The compiled half of cspace.navigation.DStarLite.")
        .def("__init__", new_replanner, "world"_a, "corners"_a, "x0"_a, "y0"_a, "x1"_a, "y1"_a)
        .def("set", set_cells, "cells"_a, "blocked"_a, "Cells (k, 2) become blocked or free.")
        .def(
            "move", [](GridReplanner& planner, double x, double y) { planner.move_to({x, y}); }, "x"_a, "y"_a,
            "The robot has moved.")
        .def("replan", replan, "Status, path, length, nodes, edges, and the cells settled, in their order.")
        .def("unpack", unpack, "into"_a, "Writes a byte per cell.");
}
