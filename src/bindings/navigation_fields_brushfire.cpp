// The diagram of a grid by brushfire, made once, and ways along it.
#include "library/navigation_fields_grid.hpp"
#include "navigation_fields.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

using Core = BrushfireDiagram;

// One number per cell (rows, columns).
template <class T>
nb::object map_of(const Core& core, std::vector<T>&& values) {
    return table(std::move(values), std::size_t(core.rows()), std::size_t(core.columns()));
}
// Cells (row, column, row, column) where branches end, their lengths, their least clearance.
nb::tuple branches_of(const Core& core) {
    Core::Branches all = core.branches();
    const std::size_t count = all.lengths.size();
    return nb::make_tuple(table(std::move(all.ends), count, 4), table(std::move(all.lengths)),
                          table(std::move(all.least)));
}

nb::object route(const Core& core, nb::handle world, nb::handle planner, nb::handle options, PointRow start,
                 PointRow goal, bool widest) {
    const Watch watch;
    Route found;
    double least_clearance = 0;
    {
        const nb::gil_scoped_release free;
        found = core.find_route(point_of(start), point_of(goal), widest, least_clearance);
    }
    nb::object made = fields::made_route(world, planner, options, start, goal, found, watch.seconds());
    if (found.status == Status::found) {
        nb::dict evidence;
        evidence["least_clearance"] = least_clearance;
        fields::set_evidence(made, evidence);
    }
    return made;
}

nb::object trace(const Core& core) {
    Trace events;
    core.trace_waves(events);
    return fields::arrays_of(events);
}

}  // namespace

void bind_navigation_fields_brushfire(nb::module_& m) {
    nb::class_<Core>(m, "BrushfireCore", "The compiled half of cspace.navigation.BrushfireDiagram.")
        .def(nb::init<const GridWorld&>(), "grid"_a, nb::call_guard<nb::gil_scoped_release>())
        .def(
            "clearance", [](const Core& core) { return map_of(core, core.clearance()); },
            nb::sig("def clearance(self) -> NDArray[numpy.float64]"), "Of each cell (rows, columns) [m].")
        .def(
            "labels", [](const Core& core) { return map_of(core, core.labels()); },
            nb::sig("def labels(self) -> NDArray[numpy.int32]"),
            "The nearest piece of boundary of each cell (rows, columns), or -1.")
        .def(
            "cells", [](const Core& core) { return map_of(core, core.cells()); },
            nb::sig("def cells(self) -> NDArray[numpy.uint8]"),
            "A byte per cell (rows, columns): 1 in the diagram.")
        .def("branches", branches_of,
             nb::sig("def branches(self) -> tuple[NDArray[numpy.int32], NDArray[numpy.float64], "
                     "NDArray[numpy.float64]]"),
             "Ends (k, 4), lengths (k,) [m] and least clearances (k,) [m].")
        .def_prop_ro("pieces", &Core::pieces, "How many pieces the boundary has.")
        .def("route", route,
             nb::sig("def route(self, world: Any, planner: str, options: dict[str, Any], start: ArrayLike, "
                     "goal: ArrayLike, widest: bool) -> Any"),
             "world"_a, "planner"_a, "options"_a, "start"_a, "goal"_a, "widest"_a, "A way along the diagram.")
        .def("trace", trace,
             nb::sig("def trace(self) -> tuple[NDArray[numpy.int8], NDArray[numpy.float64], "
                     "NDArray[numpy.float64], NDArray[numpy.float64]]"),
             "The waves and the diagram as arrays of a trace.");
}
