#include "navigation_replanning.hpp"

#include <stdexcept>

#include "cspace/navigation/grid/d_star_lite.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "maps_grid_state.hpp"

namespace cspace::navigation {

namespace {

maps::Cell cell_at(const maps::GridFrame& frame, const maps::BitGrid& grid, Point p) {
    maps::Cell cell = {0, 0};
    if (frame.locate(grid, p, cell) == maps::CellState::outside)
        throw std::invalid_argument("the point must lie within the grid");
    return cell;
}
Corners known_rule(int corners) {
    if (corners < 0 || corners >= corner_rules) throw std::invalid_argument("unknown corner rule");
    return static_cast<Corners>(corners);
}

}  // namespace

struct GridReplanner::State {
    DStarLite search;
    maps::GridFrame frame;
    Point start, goal;

    State(const maps::GridWorld::State& world, Corners corners, Point from, Point to)
        : search(world.bits, corners, cell_at(world.frame, world.bits, from),
                 cell_at(world.frame, world.bits, to)),
          frame(world.frame),
          start(from),
          goal(to) {}
};

GridReplanner::GridReplanner(const maps::GridWorld& world, int corners, Point start, Point goal)
    : state_(new State(world.state(), known_rule(corners), start, goal)) {}
GridReplanner::GridReplanner(GridReplanner&&) noexcept = default;
GridReplanner::~GridReplanner() = default;

int GridReplanner::rows() const { return state_->search.grid().rows(); }
int GridReplanner::columns() const { return state_->search.grid().columns(); }
void GridReplanner::unpack(std::uint8_t* into) const { state_->search.grid().unpack(into); }

void GridReplanner::set_cells(std::span<const std::int32_t> cells, bool blocked) {
    for (std::size_t k = 0; k < cells.size(); k += 2)
        if (!state_->search.grid().contains({cells[k], cells[k + 1]}))
            throw std::invalid_argument("the cells must lie within the grid");
    for (std::size_t k = 0; k < cells.size(); k += 2) state_->search.set({cells[k], cells[k + 1]}, blocked);
}

void GridReplanner::move_to(Point start) {
    const maps::Cell cell = cell_at(state_->frame, state_->search.grid(), start);
    state_->start = start;
    state_->search.move(cell);
}

Route GridReplanner::replan(std::vector<std::int32_t>& settled) {
    auto& [search, frame, start, goal] = *state_;
    GridAnswer answer;
    std::vector<std::uint32_t> order;
    answer.effort.order = &order;
    answer.found = search.replan(answer.effort);
    if (answer.found) search.way(answer.cells);
    Route route;
    draw_route(frame, start, goal, answer, route);
    for (const std::uint32_t number : order) {
        const maps::Cell cell = search.grid().cell(number);
        settled.insert(settled.end(), {cell.row, cell.column});
    }
    return route;
}

}  // namespace cspace::navigation
