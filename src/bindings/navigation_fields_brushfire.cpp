// The diagram of a grid by brushfire, made once, and ways along it.
#include "cspace/navigation/fields/brushfire.hpp"
#include "navigation_fields_grid.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

enum Word : std::int8_t { burn_word, meet_word, keep_word };

struct BrushfireCore {
    Diagram diagram;
    maps::GridFrame frame;
};

void make(BrushfireCore* at, const GridWorld& world) {
    nb::gil_scoped_release free;
    new (at) BrushfireCore{Diagram(world.bits), world.frame};
}

nb::object clearance_of(const BrushfireCore& core) {
    const maps::BitGrid& grid = core.diagram.grid();
    return fields::map_of<double>(grid, [&](maps::Cell c) {
        return core.frame.resolution * core.diagram.clearance().of(grid.number(c));
    });
}
nb::object labels_of(const BrushfireCore& core) {
    const maps::BitGrid& grid = core.diagram.grid();
    return fields::map_of<std::int32_t>(grid, [&](maps::Cell c) {
        return grid.blocked(c) ? -1 : core.diagram.pieces().piece(core.diagram.mark(grid.number(c)));
    });
}
nb::object cells_of(const BrushfireCore& core) {
    const maps::BitGrid& grid = core.diagram.grid();
    return fields::map_of<std::uint8_t>(
        grid, [&](maps::Cell c) { return core.diagram.place(grid.number(c)) != Diagram::none; });
}
// Cells (row, column, row, column) where branches end, their lengths in cells, their least clearance.
nb::tuple branches_of(const BrushfireCore& core) {
    const maps::BitGrid& grid = core.diagram.grid();
    std::vector<std::int32_t> ends;
    std::vector<double> lengths, least;
    for (const Diagram::Branch& branch : core.diagram.branches()) {
        for (const std::uint32_t n : {branch.from, branch.to}) {
            ends.push_back(grid.cell(n).row);
            ends.push_back(grid.cell(n).column);
        }
        lengths.push_back(core.frame.resolution * branch.steps);
        least.push_back(0.5 * core.frame.resolution * std::sqrt(double(branch.squared)));
    }
    const std::size_t count = lengths.size();
    return nb::make_tuple(fields::table(std::move(ends), count, 4),
                          fields::table(std::move(lengths), count, 0),
                          fields::table(std::move(least), count, 0));
}

nb::object route(const BrushfireCore& core, nb::handle world, nb::handle planner, nb::handle options,
                 fields::PointRow start, fields::PointRow goal, bool widest) {
    const fields::Watch watch;
    const maps::BitGrid& grid = core.diagram.grid();
    const maps::Cell from = fields::free_cell(grid, core.frame, start);
    const maps::Cell to = fields::free_cell(grid, core.frame, goal);
    BrushfireAnswer answer;
    Route found;
    {
        nb::gil_scoped_release free;
        answer = find_along(core.diagram, from, to, widest ? Prefer::clearance : Prefer::length);
        draw_route(core.frame, {start.data()[0], start.data()[1]}, {goal.data()[0], goal.data()[1]},
                   answer.way, found);
    }
    nb::object made = fields::made_route(world, planner, options, start, goal, found, watch.seconds());
    if (answer.way.found) {
        nb::dict evidence;
        evidence["least_clearance"] = 0.5 * core.frame.resolution * std::sqrt(double(answer.squared));
        fields::set_evidence(made, evidence);
    }
    return made;
}

// The waves as they burn, outwards from walls, and the diagram that they leave.
nb::object trace(const BrushfireCore& core) {
    const Diagram& diagram = core.diagram;
    const maps::BitGrid& grid = diagram.grid();
    const double side = core.frame.resolution;
    std::vector<std::uint32_t> order;
    for (std::uint32_t n = 0; n < grid.numbers(); ++n)
        if (!grid.blocked(grid.cell(n))) order.push_back(n);
    thinning::sort_by_key(order, diagram.clearance().squared);
    Trace events;
    const auto add = [&](std::int8_t word, std::uint32_t n, bool from_wall) {
        const Point at = core.frame.center(grid.cell(n));
        const auto mark = diagram.pieces().at(diagram.mark(n));
        const Point wall = core.frame.origin + (0.5 * side) * Point{double(mark.column), double(mark.row)};
        events.push_back({word, from_wall ? wall : at, at, side * diagram.clearance().of(n)});
    };
    for (const std::uint32_t n : order) add(burn_word, n, true);
    for (const std::uint32_t n : diagram.cells()) add(diagram.is_meet(n) ? meet_word : keep_word, n, false);
    return fields::arrays_of(events);
}

}  // namespace

void bind_navigation_fields_brushfire(nb::module_& m) {
    nb::class_<BrushfireCore>(m, "BrushfireCore", "The compiled half of cspace.navigation.BrushfireDiagram.")
        .def("__init__", make, "grid"_a)
        .def("clearance", clearance_of, nb::sig("def clearance(self) -> NDArray[numpy.float64]"),
             "Of each cell (rows, columns) [m].")
        .def("labels", labels_of, nb::sig("def labels(self) -> NDArray[numpy.int32]"),
             "The nearest piece of boundary of each cell (rows, columns), or -1.")
        .def("cells", cells_of, nb::sig("def cells(self) -> NDArray[numpy.uint8]"),
             "A byte per cell (rows, columns): 1 in the diagram.")
        .def("branches", branches_of,
             nb::sig("def branches(self) -> tuple[NDArray[numpy.int32], NDArray[numpy.float64], "
                     "NDArray[numpy.float64]]"),
             "Ends (k, 4), lengths (k,) [m] and least clearances (k,) [m].")
        .def_prop_ro(
            "pieces", [](const BrushfireCore& core) { return core.diagram.pieces().count(); },
            "How many pieces the boundary has.")
        .def("route", route,
             nb::sig("def route(self, world: Any, planner: str, options: dict[str, Any], start: ArrayLike, "
                     "goal: ArrayLike, widest: bool) -> Any"),
             "world"_a, "planner"_a, "options"_a, "start"_a, "goal"_a, "widest"_a, "A way along the diagram.")
        .def("trace", trace,
             nb::sig("def trace(self) -> tuple[NDArray[numpy.int8], NDArray[numpy.float64], "
                     "NDArray[numpy.float64], NDArray[numpy.float64]]"),
             "The waves and the diagram as arrays of a trace.");
}
