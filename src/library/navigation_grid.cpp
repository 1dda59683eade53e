#include "navigation_grid.hpp"

#include <memory>

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

// Writes what a search finds, and the cells that it settles if they are asked for; false where an end lies in
// no free cell.
bool search_cells(maps::GridWorld::State& world, const GridQuestion& question, Look look,
                  std::vector<Settled>* settled, GridFinding& finding) {
    maps::Cell from, to;
    if (!world.find_cell(question.start, from) || !world.find_cell(question.goal, to)) return false;
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
    answer.settled = settled;
    find_way(world.bits, from, to, query, nodes, answer, &world.parts, look);
    draw_route(world.frame, question.start, question.goal, answer, finding.route);
    finding.found = answer.found;
    finding.cost = answer.cost, finding.least = answer.least;
    finding.parts = answer.parts;
    return true;
}

}  // namespace

bool GridQuestion::is_known() const {
    return planner >= 0 && planner <= int(GridPlanner::waves) && corners >= 0 && corners < corner_rules &&
           metric >= 0 && metric <= int(Metric::euclidean);
}

bool GridQuestion::has_bounds() const { return costs || planner == int(GridPlanner::focal); }

bool find_grid_route(const maps::GridWorld& world, const GridQuestion& question, Look look,
                     GridFinding& finding) {
    return search_cells(world.state(), question, look, nullptr, finding);
}

bool list_settled_cells(const maps::GridWorld& world, const GridQuestion& question, Look look,
                        std::vector<std::int32_t>& cells, std::vector<double>& g) {
    std::vector<Settled> settled;
    GridFinding finding;
    if (!search_cells(world.state(), question, look, &settled, finding)) return false;
    for (const auto& [cell, parent, way] : settled) {
        cells.insert(cells.end(), {cell.row, cell.column, parent.row, parent.column});
        g.push_back(world.resolution() * way);
    }
    return true;
}

}  // namespace cspace::navigation
