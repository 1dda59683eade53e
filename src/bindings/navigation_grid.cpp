// Planners over grids, their fields, and coverage.
#include "library/navigation_grid.hpp"

#include <nanobind/stl/tuple.h>

#include "library/navigation_coverage.hpp"
#include "library/navigation_fields_grid.hpp"
#include "navigation_query.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

// A search of few cells takes no longer than to free the interpreter.
bool has_many_cells(const GridWorld& grid) { return grid.cells() > 1 << 14; }

PyMethodDef methods[] = {{"_grid_route", as_method(ask<plan_cells, has_many_cells>), METH_FASTCALL, nullptr},
                         {"_grid_any_angle", as_method(ask<plan_runs>), METH_FASTCALL, nullptr},
                         {"_potential_a_star", as_method(ask<plan_by_potential>), METH_FASTCALL, nullptr},
                         {"_fast_marching", as_method(ask<plan_march>), METH_FASTCALL, nullptr},
                         {"_harmonic", as_method(ask<plan_harmonic>), METH_FASTCALL, nullptr},
                         {"_brushfire", as_method(ask<plan_brushfire>), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_grid(nb::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
    m.def("_cover", cover_grid, "grid"_a, "row"_a, "column"_a, "half"_a, "along_rows"_a, WithoutLock(),
          "Path, regions, their order, passes, cells reached and free, lanes and leftovers.");
    m.def("_walls_divide", walls_divide, "grid"_a, "start"_a, "goal"_a, WithoutLock(),
          "Whether walls certainly divide two points.");
    nb::class_<GridReplanner>(m, "GridReplanner", "The compiled half of cspace.navigation.DStarLite.")
        .def(nb::init<const GridWorld&, int, Point, Point>(), "world"_a, "corners"_a, "start"_a, "goal"_a)
        .def("set", &GridReplanner::set_cells, "cells"_a, "blocked"_a, WithoutLock(),
             "Cells (k, 2) become blocked or free.")
        .def("move", &GridReplanner::move_to, "point"_a, "The robot has moved.")
        .def("replan", &GridReplanner::replan, WithoutLock(),
             "Status, path, length, nodes, edges, and the cells settled, in their order.")
        .def("unpack", &GridReplanner::unpack, "A byte per cell (rows, columns).");
    nb::class_<ClearanceField>(m, "ClearanceField",
                               "The distance of every cell of a grid to the nearest wall.")
        .def(nb::init<const GridWorld&>(), "grid"_a, WithoutLock())
        .def("march_times", march_times, "grid"_a, "goal"_a, "slow_within"_a, WithoutLock(),
             "When a front from the goal arrives (rows, columns) [m, over the speed].");
    nb::class_<HarmonicPotential>(m, "HarmonicField", "A harmonic potential over the cells of a grid.")
        .def(nb::init<const GridWorld&, const ClearanceField&, Point, double, int>(), "grid"_a, "clearance"_a,
             "goal"_a, "residual"_a, "most_cycles"_a, WithoutLock())
        .def_ro("residual", &HarmonicPotential::residual, "By what share a cell is off its mean, at most.")
        .def_ro("cycles", &HarmonicPotential::cycles, "Of the solver.")
        .def_ro("rests", &HarmonicPotential::rests, "Cells but the goal from which no step leads down.")
        .def("heights", list_heights, "grid"_a, "Minus the logarithm of the chance (rows, columns).");
    nb::class_<BrushfireDiagram>(m, "BrushfireCore",
                                 "The compiled half of cspace.navigation.BrushfireDiagram.")
        .def(nb::init<const GridWorld&>(), "grid"_a, WithoutLock())
        .def("clearance", &BrushfireDiagram::clearance, "Of each cell (rows, columns) [m].")
        .def("labels", &BrushfireDiagram::labels,
             "The nearest piece of boundary of each cell (rows, columns), or -1.")
        .def("cells", &BrushfireDiagram::cells, "A byte per cell (rows, columns): 1 in the diagram.")
        .def("branches", &BrushfireDiagram::branches,
             "Ends (k, 4), lengths (k,) [m] and least clearances (k,) [m].");
}
