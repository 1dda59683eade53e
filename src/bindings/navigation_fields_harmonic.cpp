// Harmonic potentials over grids, and descents in them.
#include "library/navigation_fields_grid.hpp"
#include "maps_grid.hpp"
#include "navigation_fields.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

void make(HarmonicPotential* at, const GridWorld& world, const ClearanceField& clearance, PointRow goal,
          double residual, int most_cycles) {
    const nb::gil_scoped_release free;
    new (at) HarmonicPotential(world, clearance, point_of(goal), residual, most_cycles, heed_interrupts);
}
bool divide(const GridWorld& world, PointRow start, PointRow goal) {
    const nb::gil_scoped_release free;
    return walls_divide(world, point_of(start), point_of(goal));
}
// seconds: what making the field took.
nb::object route(const HarmonicPotential& field, const GridWorld& world, nb::handle owner, nb::handle planner,
                 nb::handle options, PointRow start, PointRow goal, double seconds, nb::object evidence) {
    const Watch watch;
    Route route;
    {
        const nb::gil_scoped_release free;
        route = field.descend(world, point_of(start), point_of(goal));
    }
    nb::object made =
        fields::made_route(owner, planner, options, start, goal, route, watch.seconds() + seconds);
    fields::set_evidence(made, std::move(evidence));
    return made;
}
nb::object heights(const HarmonicPotential& field, const GridWorld& world) {
    return table(field.heights(world), std::size_t(world.rows()), std::size_t(world.columns()));
}
nb::object trace(const HarmonicPotential& field, const GridWorld& world, PointRow start) {
    Trace events;
    field.trace_descent(world, point_of(start), events);
    return fields::arrays_of(events);
}

}  // namespace

void bind_navigation_fields_harmonic(nb::module_& m) {
    m.def("_walls_divide", divide, "grid"_a, "start"_a, "goal"_a,
          "Whether walls certainly divide two points.");
    nb::class_<HarmonicPotential>(m, "HarmonicField", "A harmonic potential over the cells of a grid.")
        .def("__init__", make, "grid"_a, "clearance"_a, "goal"_a, "residual"_a, "most_cycles"_a,
             nb::sig(
                 "def __init__(self, grid: GridBase, clearance: ClearanceField, goal: ArrayLike, residual: "
                 "float, most_cycles: int) -> None"))
        .def_prop_ro("residual", &HarmonicPotential::residual,
                     "By what share a cell is off its mean, at most.")
        .def_prop_ro("cycles", &HarmonicPotential::cycles, "Of the solver.")
        .def_prop_ro("cells", &HarmonicPotential::cells, "From which a way leads to the goal.")
        .def_prop_ro("rests", &HarmonicPotential::rests, "Cells but the goal from which no step leads down.")
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
