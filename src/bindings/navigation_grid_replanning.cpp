// D* Lite over an occupancy grid of its own.
#include <cstring>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/navigation/grid/d_star_lite.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "maps_grid.hpp"
#include "numpy_api.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

using Cells = Array<const std::int32_t, nb::shape<-1, 2>>;

struct Replanner {
    DStarLite search;
    maps::GridFrame frame;
    Point start, goal;
};

maps::Cell cell_of(const GridWorld& world, Point p) {
    maps::Cell cell = {0, 0};
    if (world.frame.locate(world.bits, p, cell) == maps::CellState::outside)
        throw nb::value_error("a point within the grid");
    return cell;
}

void new_replanner(Replanner* at, const GridWorld& world, int corners, double x0, double y0, double x1,
                   double y1) {
    if (corners < 0 || corners >= corner_rules) throw nb::value_error("a corner rule that the core knows");
    const Point start = {x0, y0}, goal = {x1, y1};
    new (at)
        Replanner{{world.bits, static_cast<Corners>(corners), cell_of(world, start), cell_of(world, goal)},
                  world.frame,
                  start,
                  goal};
}

void set_cells(Replanner& planner, Cells cells, bool blocked) {
    for (std::size_t k = 0; k < cells.shape(0); ++k) {
        const maps::Cell cell = {cells(k, 0), cells(k, 1)};
        if (!planner.search.grid().contains(cell)) throw nb::value_error("cells within the grid");
    }
    nb::gil_scoped_release free;
    for (std::size_t k = 0; k < cells.shape(0); ++k) planner.search.set({cells(k, 0), cells(k, 1)}, blocked);
}

void move_to(Replanner& planner, double x, double y) {
    maps::Cell cell = {0, 0};
    if (planner.frame.locate(planner.search.grid(), {x, y}, cell) == maps::CellState::outside)
        throw nb::value_error("a point within the grid");
    planner.start = {x, y};
    planner.search.move(cell);
}

PyObject* array_of(npy_intp rows, npy_intp columns, int type, const void* from, std::size_t bytes) {
    npy_intp shape[2] = {rows, columns};
    PyObject* array = PyArray_SimpleNew(2, shape, type);
    if (!array) throw nb::python_error();
    if (rows) std::memcpy(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array)), from, bytes);
    return array;
}

// (status, path (m, 2), length, nodes, edges, settled cells (k, 2))
nb::tuple replan(Replanner& planner) {
    GridAnswer answer;
    std::vector<std::uint32_t> order;
    std::vector<std::int32_t> settled;
    Route route;
    {
        nb::gil_scoped_release free;
        answer.effort.order = &order;
        answer.found = planner.search.replan(answer.effort);
        if (answer.found) planner.search.way(answer.cells);
        draw_route(planner.frame, planner.start, planner.goal, answer, route);
        for (const std::uint32_t number : order) {
            const maps::Cell cell = planner.search.grid().cell(number);
            settled.insert(settled.end(), {cell.row, cell.column});
        }
    }
    const auto count = npy_intp(route.path.size());
    return nb::make_tuple(
        int(route.status),
        nb::steal(array_of(count, 2, NPY_DOUBLE, route.path.data(), sizeof(Point) * std::size_t(count))),
        route.length, route.stats.nodes, route.stats.edges,
        nb::steal(array_of(npy_intp(order.size()), 2, NPY_INT32, settled.data(), 8 * order.size())));
}

void unpack(const Replanner& planner, Array<std::uint8_t, nb::ndim<2>> into) {
    const maps::BitGrid& grid = planner.search.grid();
    if (int(into.shape(0)) != grid.rows() || int(into.shape(1)) != grid.columns())
        throw nb::value_error("an array of the shape of the grid");
    grid.unpack(into.data());
}

}  // namespace

void bind_navigation_grid_replanning(nb::module_& m) {
    nb::class_<Replanner>(m, "GridReplanner", "The compiled half of cspace.navigation.DStarLite.")
        .def("__init__", new_replanner, "world"_a, "corners"_a, "x0"_a, "y0"_a, "x1"_a, "y1"_a)
        .def("set", set_cells, "cells"_a, "blocked"_a, "Cells (k, 2) become blocked or free.")
        .def("move", move_to, "x"_a, "y"_a, "The robot has moved.")
        .def("replan", replan, "Status, path, length, nodes, edges, and the cells settled, in their order.")
        .def("unpack", unpack, "into"_a, "Writes a byte per cell.");
}
