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

// The scratch of this thread, or, for a search that a signal handler runs amid another one, its own. More
// than so many bytes are given back after a search, which took far longer than to ask for them again.
class Borrowed {
  public:
    Borrowed() {
        if (depth()++ > 0) own_ = std::make_unique<Scratch>();
    }
    ~Borrowed() {
        constexpr std::size_t kept_bytes = std::size_t(32) << 20;
        if (--depth() == 0 && of_thread().nodes.bytes() > kept_bytes) of_thread().nodes.release();
    }
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;
    Scratch& get() { return own_ ? *own_ : of_thread(); }

  private:
    static Scratch& of_thread() {
        thread_local Scratch one;
        return one;
    }
    static int& depth() {
        thread_local int one = 0;
        return one;
    }
    std::unique_ptr<Scratch> own_;
};

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

bool GridQuestion::is_known() const {
    return planner >= 0 && planner <= int(GridPlanner::waves) && corners >= 0 && corners < corner_rules &&
           metric >= 0 && metric <= int(Metric::euclidean);
}

bool GridQuestion::has_bounds() const { return costs || planner == int(GridPlanner::focal); }

bool find_grid_route(const maps::GridWorld& grid, const GridQuestion& question, Point start, Point goal,
                     GridFinding& finding, Trace* trace) {
    maps::GridWorld::State& world = grid.state();
    maps::Cell from, to;
    if (!world.find_cells(start, goal, from, to)) return false;
    const GridQuery query{static_cast<GridPlanner>(question.planner),
                          static_cast<Corners>(question.corners),
                          static_cast<Metric>(question.metric),
                          question.g_weight,
                          question.h_weight,
                          question.bound,
                          question.costs,
                          question.least_cost};
    Borrowed borrowed;
    auto& [nodes, answer] = borrowed.get();
    std::vector<Settled> settled;
    answer.settled = trace ? &settled : nullptr;
    find_way(world.bits, from, to, query, nodes, answer, &world.parts);
    if (trace) list_settled(world.frame, settled, *trace);
    draw_route(world.frame, start, goal, answer, finding.route);
    finding.found = answer.found;
    finding.cost = answer.cost, finding.least = answer.least;
    finding.parts = answer.parts;
    return true;
}

bool find_any_angle_route(const maps::GridWorld& world, Point start, Point goal, Route& route, Trace* trace) {
    auto& [bits, frame, parts] = world.state();
    if (!maps::RunMesh::fits(bits))
        throw std::invalid_argument(
            "the grid has too many cells for a search over runs of cells; use larger cells");
    GridAnyAngle search(bits, frame);
    const SettledInRuns from = search.settle(start), to = search.settle(goal);
    if (from.runs.empty() || to.runs.empty()) return false;
    route = search.solve(start, from, goal, to, &parts, trace);
    return true;
}

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
    visit_range(0, cells.size() / 2,
                [&](std::size_t k) { state_->search.set({cells[2 * k], cells[2 * k + 1]}, blocked); });
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
