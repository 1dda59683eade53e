// Harmonic potentials over grids, and descents in them.
#include "cspace/navigation/fields/harmonic.hpp"
#include "navigation_fields_grid.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

Point point_of(const fields::PointRow& row) { return {row.data()[0], row.data()[1]}; }

void make(HarmonicField* at, const GridWorld& world, const Clearance& clearance, fields::PointRow goal,
          double residual, int most_cycles) {
    const maps::Cell to = fields::free_cell(world.bits, world.frame, goal);
    const auto look = [] {
        nb::gil_scoped_acquire held;
        if (PyErr_CheckSignals()) throw nb::python_error();
    };
    nb::gil_scoped_release free;
    new (at) HarmonicField(world.bits, clearance, to, residual, most_cycles, look);
}
// Whether start and goal certainly lie in different parts of the free cells; not told of small parts.
bool divide(GridWorld& world, fields::PointRow start, fields::PointRow goal) {
    const maps::Cell from = fields::free_cell(world.bits, world.frame, start);
    const maps::Cell to = fields::free_cell(world.bits, world.frame, goal);
    nb::gil_scoped_release free;
    return world.parts.of(world.bits, false).divide(from, to);
}
// seconds: what making the field took.
nb::object route(const HarmonicField& field, const GridWorld& world, nb::handle owner, nb::handle planner,
                 nb::handle options, fields::PointRow start, fields::PointRow goal, double seconds,
                 nb::object evidence) {
    const fields::Watch watch;
    const maps::Cell from = fields::free_cell(world.bits, world.frame, start);
    Route route;
    {
        nb::gil_scoped_release free;
        const GridAnswer answer = field.descend(from);
        draw_route(world.frame, point_of(start), point_of(goal), answer, route);
        if (!answer.found && !answer.cells.empty()) route.status = Status::undetermined;
    }
    nb::object made =
        fields::made_route(owner, planner, options, start, goal, route, watch.seconds() + seconds);
    fields::set_evidence(made, std::move(evidence));
    return made;
}
nb::object heights(const HarmonicField& field, const GridWorld& world) {
    return fields::map_of<double>(world.bits, [&](maps::Cell c) { return field.height(c); });
}
nb::object trace(const HarmonicField& field, const GridWorld& world, fields::PointRow start) {
    const GridAnswer answer = field.descend(fields::free_cell(world.bits, world.frame, start));
    Trace events;
    for (std::size_t k = 1; k < answer.cells.size(); ++k)
        events.push_back({0, world.frame.center(answer.cells[k - 1]), world.frame.center(answer.cells[k]),
                          field.height(answer.cells[k])});
    return fields::arrays_of(events);
}

}  // namespace

void bind_navigation_fields_harmonic(nb::module_& m) {
    m.def("_walls_divide", divide, "grid"_a, "start"_a, "goal"_a,
          "Whether walls certainly divide two points.");
    nb::class_<HarmonicField>(m, "HarmonicField", "A harmonic potential over the cells of a grid.")
        .def("__init__", make, "grid"_a, "clearance"_a, "goal"_a, "residual"_a, "most_cycles"_a,
             nb::sig(
                 "def __init__(self, grid: GridBase, clearance: ClearanceField, goal: ArrayLike, residual: "
                 "float, most_cycles: int) -> None"))
        .def_prop_ro("residual", &HarmonicField::residual, "By what share a cell is off its mean, at most.")
        .def_prop_ro("cycles", &HarmonicField::cycles, "Of the solver.")
        .def_prop_ro("cells", &HarmonicField::size, "From which a way leads to the goal.")
        .def_prop_ro("rests", &HarmonicField::rests, "Cells but the goal from which no step leads down.")
        .def("heights", heights, nb::sig("def heights(self, grid: GridBase) -> NDArray[numpy.float64]"),
             "grid"_a, "Minus the logarithm of the chance (rows, columns).")
        .def("route", route,
             nb::sig(
                 "def route(self, grid: GridBase, owner: Any, planner: str, options: dict[str, Any], start: "
                 "ArrayLike, goal: ArrayLike, seconds: float, evidence: Any) -> Any"),
             "grid"_a, "owner"_a, "planner"_a, "options"_a, "start"_a, "goal"_a, "seconds"_a, "evidence"_a,
             "The way down the field.")
        .def("trace", trace,
             nb::sig("def trace(self, grid: GridBase, start: ArrayLike) -> tuple[NDArray[numpy.int8], "
                     "NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.float64]]"),
             "grid"_a, "start"_a, "The steps of a descent.");
}
