// Planners over fields on a grid: a potential as heuristic, and fast marching.
#include "navigation_fields_grid.hpp"

#include <string>

#include "cspace/navigation/fields/fast_marching.hpp"
#include "cspace/navigation/fields/potential_search.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

using Six = Array<const double, nb::shape<6>>;

void make(Clearance* at, const GridWorld& world) {
    nb::gil_scoped_release free;
    new (at) Clearance(make_clearance(world.bits));
}
Point point_of(const fields::PointRow& row) { return {row.data()[0], row.data()[1]}; }

// gain, rho_0, cap, all in cells; scale, weight, whether greedy.
PotentialOrder order_of(const Six& row) {
    const double* s = row.data();
    return {s[0], s[1], s[2], s[3], s[4], s[5] != 0};
}

nb::object potential_route(const Clearance& clearance, const GridWorld& world, nb::handle owner,
                           nb::handle planner, nb::handle options, fields::PointRow start,
                           fields::PointRow goal, Six settings, int corners) {
    const fields::Watch watch;
    const maps::Cell from = fields::free_cell(world.bits, world.frame, start);
    const maps::Cell to = fields::free_cell(world.bits, world.frame, goal);
    Route route;
    {
        nb::gil_scoped_release free;
        GridAnswer answer;
        find_by_potential(world.bits, clearance, order_of(settings), static_cast<Corners>(corners), from, to,
                          answer);
        draw_route(world.frame, point_of(start), point_of(goal), answer, route);
    }
    return fields::made_route(owner, planner, options, start, goal, route, watch.seconds());
}
nb::object potential_trace(const Clearance& clearance, const GridWorld& world, fields::PointRow start,
                           fields::PointRow goal, Six settings, int corners) {
    GridAnswer answer;
    std::vector<Settled> settled;
    answer.settled = &settled;
    find_by_potential(world.bits, clearance, order_of(settings), static_cast<Corners>(corners),
                      fields::free_cell(world.bits, world.frame, start),
                      fields::free_cell(world.bits, world.frame, goal), answer);
    Trace events;
    for (const Settled& one : settled)
        events.push_back({0, world.frame.center(one.parent), world.frame.center(one.cell),
                          world.frame.resolution * one.g});
    return fields::arrays_of(events);
}

nb::object march_route(const Clearance& clearance, const GridWorld& world, nb::handle owner,
                       nb::handle planner, nb::handle options, fields::PointRow start, fields::PointRow goal,
                       double slow_within) {
    const fields::Watch watch;
    const maps::Cell from = fields::free_cell(world.bits, world.frame, start);
    const maps::Cell to = fields::free_cell(world.bits, world.frame, goal);
    MarchAnswer answer;
    {
        nb::gil_scoped_release free;
        answer = march(world.bits, world.frame, &clearance, slow_within, point_of(start), from,
                       point_of(goal), to, nullptr);
    }
    nb::object made = fields::made_route(owner, planner, options, start, goal, answer.route, watch.seconds());
    if (answer.route.status == Status::found) {
        nb::dict evidence;
        evidence["time"] = world.frame.resolution * answer.time;
        fields::set_evidence(made, evidence);
    }
    return made;
}
// The times at which a front from the goal arrives, (rows, columns) [m, over the speed]; until the start's.
nb::object march_times(const Clearance& clearance, const GridWorld& world, fields::PointRow goal,
                       double slow_within) {
    const maps::BitGrid& grid = world.bits;
    Front front(grid, &clearance, slow_within, search::no_node);
    {
        nb::gil_scoped_release free;
        search::PriorityQueue queue;
        search::Effort effort;
        front.start(fields::free_cell(grid, world.frame, goal), queue);
        best_first(front, queue, effort);
    }
    return fields::map_of<double>(
        grid, [&](maps::Cell c) { return world.frame.resolution * front.time(grid.number(c)); });
}
nb::object march_trace(const Clearance& clearance, const GridWorld& world, fields::PointRow start,
                       fields::PointRow goal, double slow_within) {
    const maps::BitGrid& grid = world.bits;
    const maps::Cell from = fields::free_cell(grid, world.frame, start);
    Front front(grid, &clearance, slow_within, grid.number(from));
    search::PriorityQueue queue;
    std::vector<std::uint32_t> order;
    search::Effort effort{0, 0, &order};
    front.start(fields::free_cell(grid, world.frame, goal), queue);
    best_first(front, queue, effort);
    Trace events;
    for (const std::uint32_t n : order) {
        const Point at = world.frame.center(grid.cell(n));
        events.push_back({0, at, at, world.frame.resolution * front.time(n)});
    }
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
    nb::class_<Clearance>(m, "ClearanceField", "The distance of every cell of a grid to the nearest wall.")
        .def("__init__", make, "grid"_a)
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
