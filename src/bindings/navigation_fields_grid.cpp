// Planners over fields on a grid: a potential as heuristic, and fast marching.
#include "library/navigation_fields_grid.hpp"

#include <string>

#include "navigation_fields.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

// gain, rho_0, cap, all in cells; scale, weight, whether greedy.
using Six = Array<const double, nb::shape<6>>;

nb::object potential_route(const ClearanceField& field, const GridWorld& world, nb::handle owner,
                           nb::handle planner, nb::handle options, PointRow start, PointRow goal,
                           Six settings, int corners) {
    const Watch watch;
    Route route;
    {
        const nb::gil_scoped_release free;
        route = field.find_potential_route(world, point_of(start), point_of(goal), settings.data(), corners,
                                           nullptr);
    }
    return fields::made_route(owner, planner, options, start, goal, route, watch.seconds());
}
nb::object potential_trace(const ClearanceField& field, const GridWorld& world, PointRow start, PointRow goal,
                           Six settings, int corners) {
    Trace events;
    field.find_potential_route(world, point_of(start), point_of(goal), settings.data(), corners, &events);
    return fields::arrays_of(events);
}

nb::object march_route(const ClearanceField& field, const GridWorld& world, nb::handle owner,
                       nb::handle planner, nb::handle options, PointRow start, PointRow goal,
                       double slow_within) {
    const Watch watch;
    Route route;
    double time;
    {
        const nb::gil_scoped_release free;
        route = field.find_march_route(world, point_of(start), point_of(goal), slow_within, time);
    }
    nb::object made = fields::made_route(owner, planner, options, start, goal, route, watch.seconds());
    if (route.status == Status::found) {
        nb::dict evidence;
        evidence["time"] = time;
        fields::set_evidence(made, evidence);
    }
    return made;
}
// The times at which a front from the goal arrives, (rows, columns) [m, over the speed].
nb::object march_times(const ClearanceField& field, const GridWorld& world, PointRow goal,
                       double slow_within) {
    std::vector<double> times;
    {
        const nb::gil_scoped_release free;
        times = field.march_times(world, point_of(goal), slow_within);
    }
    return table(std::move(times), std::size_t(world.rows()), std::size_t(world.columns()));
}
nb::object march_trace(const ClearanceField& field, const GridWorld& world, PointRow start, PointRow goal,
                       double slow_within) {
    Trace events;
    field.trace_march(world, point_of(start), point_of(goal), slow_within, events);
    return fields::arrays_of(events);
}

constexpr const char* trace_type =
    " -> tuple[NDArray[numpy.int8], NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.float64]]";

}  // namespace

void bind_navigation_fields_grid(nb::module_& m) {
    static const std::string potential_trace_type =
        std::string(
            "def potential_trace(self, grid: GridBase, start: ArrayLike, goal: ArrayLike, "
            "settings: ArrayLike, corners: int)") +
        trace_type;
    static const std::string march_trace_type =
        std::string(
            "def march_trace(self, grid: GridBase, start: ArrayLike, goal: ArrayLike, "
            "slow_within: float)") +
        trace_type;
    nb::class_<ClearanceField>(m, "ClearanceField",
                               "The distance of every cell of a grid to the nearest wall.")
        .def(nb::init<const GridWorld&>(), "grid"_a, nb::call_guard<nb::gil_scoped_release>())
        .def("potential_route", potential_route,
             nb::sig("def potential_route(self, grid: GridBase, owner: Any, planner: str, "
                     "options: dict[str, Any], start: ArrayLike, goal: ArrayLike, settings: ArrayLike, "
                     "corners: int) -> Any"),
             "grid"_a, "owner"_a, "planner"_a, "options"_a, "start"_a, "goal"_a, "settings"_a, "corners"_a,
             "A search that counts on a potential.")
        .def("potential_trace", potential_trace, nb::sig(potential_trace_type.c_str()), "grid"_a, "start"_a,
             "goal"_a, "settings"_a, "corners"_a, "The cells in the order in which they are settled.")
        .def("march_route", march_route,
             nb::sig(
                 "def march_route(self, grid: GridBase, owner: Any, planner: str, options: dict[str, Any], "
                 "start: ArrayLike, goal: ArrayLike, slow_within: float) -> Any"),
             "grid"_a, "owner"_a, "planner"_a, "options"_a, "start"_a, "goal"_a, "slow_within"_a,
             "The way down the times of a front.")
        .def("march_times", march_times,
             nb::sig("def march_times(self, grid: GridBase, goal: ArrayLike, slow_within: float) -> "
                     "NDArray[numpy.float64]"),
             "grid"_a, "goal"_a, "slow_within"_a, "When a front from the goal arrives (rows, columns).")
        .def("march_trace", march_trace, nb::sig(march_trace_type.c_str()), "grid"_a, "start"_a, "goal"_a,
             "slow_within"_a, "The cells in the order in which the front arrives.");
}
