#include "navigation_grid.hpp"

#include <memory>
#include <stdexcept>

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/any_angle/grid_any_angle.hpp"
#include "cspace/navigation/grid/d_star_lite.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "cspace/navigation/grid/search.hpp"
#include "maps_grid_state.hpp"

namespace cspace::navigation {

namespace {

// What a thread's searches remember.
struct Scratch {
    GridScratch nodes;
    GridAnswer answer;
};

maps::Cell cell_at(const maps::GridFrame& frame, const maps::BitGrid& grid, Point p) {
    maps::Cell cell = {0, 0};
    if (frame.locate(grid, p, cell) == maps::CellState::outside)
        throw std::invalid_argument("the point must lie within the grid");
    return cell;
}
constexpr auto last_rule = static_cast<Corners>(corner_rules - 1);

template <class Choice>
Choice known_choice(std::int64_t number, Choice last) {
    if (number < 0 || number > std::int64_t(last))
        throw std::invalid_argument("unknown planner, corner rule or metric");
    return static_cast<Choice>(number);
}

// Of this thread; a search that a signal handler runs amid another one finds none.
thread_local std::unique_ptr<Scratch> kept_scratch;

}  // namespace

bool plan_cells(const Query<GridWorld>& query, Answer<std::int64_t, double, double>& answer,
                const std::array<std::int64_t, 3>& choices, const std::array<double, 3>& weights,
                std::span<const double> costs, double least_cost) {
    GridWorld::State& world = query.world.state();
    const auto planner = known_choice(choices[0], GridPlanner::waves);
    const auto corners = known_choice(choices[1], last_rule);
    const auto metric = known_choice(choices[2], Metric::euclidean);
    const double side = world.frame.resolution;
    if (!costs.empty() && costs.size() != std::size_t(query.world.rows) * std::size_t(query.world.columns))
        throw std::invalid_argument("costs need one number per cell");
    maps::Cell from, to;
    if (!world.find_cells(query.start, query.goal, from, to)) return false;
    const double* each = costs.empty() ? nullptr : costs.data();
    auto scratch = kept_scratch ? std::move(kept_scratch) : std::make_unique<Scratch>();
    auto& [nodes, found] = *scratch;
    found.is_traced = query.trace;
    find_way(world.bits, from, to,
             {planner, corners, metric, weights[0], weights[1], weights[2], each, least_cost}, nodes, found,
             &world.parts);
    if (query.trace) list_settled(world.frame, found.settled, *query.trace);
    draw_route(world.frame, query.start, query.goal, found, answer.route);
    if (found.parts || (found.found && (each || planner == GridPlanner::focal)))
        answer.evidence = {found.parts, side * found.cost, side * found.least};
    // More takes far longer to fill than to ask for again.
    constexpr std::size_t kept_bytes = std::size_t(32) << 20;
    if (nodes.bytes() <= kept_bytes) kept_scratch = std::move(scratch);
    return true;
}

bool plan_runs(const Query<GridWorld>& query, Route& route) {
    auto& [bits, frame, parts] = query.world.state();
    if (!maps::RunMesh::fits(bits))
        throw std::invalid_argument(
            "the grid has too many cells for a search over runs of cells; use larger cells");
    GridAnyAngle search(bits, frame);
    const SettledInRuns from = search.settle(query.start), to = search.settle(query.goal);
    if (from.runs.empty() || to.runs.empty()) return false;
    route = search.solve(query.start, from, query.goal, to, &parts, query.trace);
    return true;
}

struct GridReplanner::State {
    DStarLite search;
    maps::GridFrame frame;
    Point start, goal;
};

GridReplanner::GridReplanner(const maps::GridWorld& world, int corners, Point start, Point goal) {
    const auto& [bits, frame, parts] = world.state();
    DStarLite search(bits, known_choice(corners, last_rule), cell_at(frame, bits, start),
                     cell_at(frame, bits, goal));
    state_.reset(new State{std::move(search), frame, start, goal});
}

Table<std::uint8_t> GridReplanner::unpack() const { return maps::unpack_bits(state_->search.grid()); }

void GridReplanner::set_cells(std::span<const std::array<std::int32_t, 2>> cells, bool blocked) {
    for (const auto& [row, column] : cells)
        if (!state_->search.grid().contains({row, column}))
            throw std::invalid_argument("the cells must lie within the grid");
    visit_range(0, cells.size(),
                [&](std::size_t k) { state_->search.set({cells[k][0], cells[k][1]}, blocked); });
}

void GridReplanner::move_to(Point start) {
    const maps::Cell cell = cell_at(state_->frame, state_->search.grid(), start);
    state_->start = start;
    state_->search.move(cell);
}

std::tuple<int, Table<Point>, double, std::int64_t, std::int64_t, Table<std::int32_t>>
GridReplanner::replan() {
    auto& [search, frame, start, goal] = *state_;
    GridAnswer answer;
    std::vector<std::uint32_t> order;
    answer.effort.order = &order;
    answer.found = search.replan(answer.effort);
    if (answer.found) search.way(answer.cells);
    Route route;
    draw_route(frame, start, goal, answer, route);
    Table<std::int32_t> settled{{}, 2};
    for (const std::uint32_t number : order) {
        const maps::Cell cell = search.grid().cell(number);
        settled.values.insert(settled.values.end(), {cell.row, cell.column});
    }
    return {int(route.status), {std::move(route.path)}, route.length,
            route.stats.nodes, route.stats.edges,       std::move(settled)};
}

}  // namespace cspace::navigation
