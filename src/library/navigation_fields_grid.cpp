#include "navigation_fields_grid.hpp"

#include "cspace/navigation/fields/fast_marching.hpp"
#include "cspace/navigation/fields/potential_search.hpp"
#include "navigation_fields_state.hpp"

namespace cspace::navigation {

bool walls_divide(const GridWorld& world, Point start, Point goal) {
    auto& [bits, frame, parts] = world.state();
    const maps::Cell from = world.state().free_cell(start), to = world.state().free_cell(goal);
    return parts.of(bits, false).divide(from, to);
}

ClearanceField::ClearanceField(const GridWorld& world)
    : state_(new State{make_clearance(world.state().bits)}) {}

Route ClearanceField::find_potential_route(const GridWorld& world, Point start, Point goal, const double* s,
                                           int corners, Trace* trace) const {
    const auto& [bits, frame, parts] = world.state();
    const maps::Cell from = world.state().free_cell(start), to = world.state().free_cell(goal);
    GridAnswer answer;
    std::vector<Settled> settled;
    if (trace) answer.settled = &settled;
    find_by_potential(bits, state_->clearance, {s[0], s[1], s[2], s[3], s[4], s[5] != 0},
                      static_cast<Corners>(corners), from, to, answer);
    for (const Settled& one : settled)
        trace->push_back({0, frame.center(one.parent), frame.center(one.cell), frame.resolution * one.g});
    Route route;
    draw_route(frame, start, goal, answer, route);
    return route;
}

Route ClearanceField::find_march_route(const GridWorld& world, Point start, Point goal, double slow_within,
                                       double& time) const {
    const auto& [bits, frame, parts] = world.state();
    const maps::Cell from = world.state().free_cell(start), to = world.state().free_cell(goal);
    MarchAnswer answer = march(bits, frame, &state_->clearance, slow_within, start, from, goal, to, nullptr);
    time = frame.resolution * answer.time;
    return std::move(answer.route);
}

std::vector<double> ClearanceField::march_times(const GridWorld& world, Point goal,
                                                double slow_within) const {
    const maps::BitGrid& bits = world.state().bits;
    Front front(bits, &state_->clearance, slow_within, search::no_node);
    search::PriorityQueue queue;
    search::Effort effort;
    front.start(world.state().free_cell(goal), queue);
    search::best_first(front, queue, effort);
    return map_cells<double>(bits,
                             [&](maps::Cell c) { return world.resolution() * front.time(bits.number(c)); });
}

void ClearanceField::trace_march(const GridWorld& world, Point start, Point goal, double slow_within,
                                 Trace& trace) const {
    const auto& [bits, frame, parts] = world.state();
    Front front(bits, &state_->clearance, slow_within, bits.number(world.state().free_cell(start)));
    search::PriorityQueue queue;
    std::vector<std::uint32_t> order;
    search::Effort effort{0, 0, &order};
    front.start(world.state().free_cell(goal), queue);
    search::best_first(front, queue, effort);
    for (const std::uint32_t n : order) {
        const Point at = frame.center(bits.cell(n));
        trace.push_back({0, at, at, frame.resolution * front.time(n)});
    }
}

}  // namespace cspace::navigation
