// The planners of the grid family: one best-first loop, with each planner's queue, order, moves and parents.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/grid_parts.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "cspace/navigation/grid/grid_search.hpp"
#include "cspace/navigation/grid/jump_points.hpp"
#include "cspace/navigation/grid/nodes.hpp"
#include "cspace/navigation/grid/order.hpp"
#include "cspace/navigation/grid/parents.hpp"
#include "cspace/search/best_first.hpp"
#include "cspace/search/bucket_queue.hpp"
#include "cspace/search/focal_queue.hpp"

namespace cspace::navigation {

enum class GridPlanner : std::uint8_t {
    best_first,  // Dijkstra, A*, weighted A*, greedy: by the weights of the order
    focal,
    jump_points,
    theta_star,
    lazy_theta_star,
    waves,
};

struct GridQuery {
    GridPlanner planner = GridPlanner::best_first;
    Corners corners = Corners::never;
    Metric metric = Metric::octile;
    double g_weight = 1, h_weight = 1;
    double bound = 1;               // of focal search: at most so many times the shortest
    const double* costs = nullptr;  // of the cells, by rows; null: 1 each
    double least_cost = 1;          // the least of them
};

// Memory that searches reuse from one query to the next. Not for two threads at a time.
struct GridScratch {
    PagedNodes<Steps> steps;
    PagedNodes<double> lengths;
    SparseNodes sparse;
    search::BucketQueue buckets;
    search::Waves waves;

    std::size_t bytes() const {
        return steps.bytes() + lengths.bytes() + sparse.bytes() + buckets.bytes() + waves.bytes();
    }
};

namespace grid_search {

inline constexpr double bucket_width = 0.05;  // cells, or the least cost of one: few f differ by less

// The cost of a path from cell to adjacent cell.
template <class Length>
double sum_costs(const std::vector<maps::Cell>& cells, const Length& length) {
    typename Length::G sum{};
    for (std::size_t k = 1; k < cells.size(); ++k) {
        const int down = cells[k].row - cells[k - 1].row, along = cells[k].column - cells[k - 1].column;
        sum = sum + length.along(cells[k - 1], direction_of[down + 1][along + 1], 1);
    }
    return value_of(sum);
}

// What may prove, before all cells that can be reached have been settled, that the goal is none of them.
struct Division {
    const maps::BitGrid& grid;
    maps::LazyParts* parts;  // or null
    maps::Cell a, b;
    bool diagonal;

    // Parts are looked at before a search if they are known, else where it has taken long.
    std::uint64_t patience() const {
        return parts ? maps::LazyParts::patience(grid) : std::numeric_limits<std::uint64_t>::max();
    }
    bool is_known() const { return patience() < grid.numbers() && parts->is_made(diagonal); }
    bool proves(GridAnswer& answer) const {
        const maps::GridParts& made = parts->of(grid, diagonal);
        if (!made.divide(a, b)) return false;
        answer.parts = made.count();
        return true;
    }
};

// Best first from start, unless it is proven meanwhile that no path exists. Returns the goal, or no_node;
// settled_at(node) says what was settled.
template <class Space, class Queue, class SettledAt>
std::uint32_t search_from(maps::Cell start, Space& space, Queue& queue, const Division& division,
                          GridAnswer& answer, const SettledAt& settled_at) {
    constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();
    search::Effort& effort = answer.effort;
    space.start(start, queue, effort);
    std::uint32_t reached;
    for (effort.pause = division.is_known() ? never : division.patience();; effort.pause = never) {
        reached = search::best_first(space, queue, effort);
        if (reached != search::no_node || queue.empty() || division.proves(answer)) break;
    }
    answer.found = reached != search::no_node;
    for (const std::uint32_t node : answer.order) answer.settled.push_back(settled_at(node));
    return reached;
}

template <class Ranking, class Parents, class Queue>
void by_cells(const maps::BitGrid& grid, Corners corners, const Ranking& order, maps::Cell start,
              const Parents& parents, PagedNodes<typename Parents::G>& nodes, Queue& queue, bool reopen,
              const Division& division, GridAnswer& answer) {
    GridSearch space(grid, corners, order, parents, nodes, reopen);
    std::uint32_t at = search_from(start, space, queue, division, answer, [&](std::uint32_t k) {
        const auto& node = nodes.at(k);
        return Settled{grid.cell(k), grid.cell(node.parent), value_of(node.g)};
    });
    if (!answer.found) return;
    answer.cost = answer.least = value_of(nodes.at(at).g);
    answer.cells.assign(1, grid.cell(at));
    while (nodes.at(at).parent != at) {
        at = nodes.at(at).parent;
        answer.cells.push_back(grid.cell(at));
    }
    std::reverse(answer.cells.begin(), answer.cells.end());
    // Cells that were reached again on a shorter way have children that do not know it.
    if constexpr (requires { parents.length; })
        if (reopen) answer.cost = sum_costs(answer.cells, parents.length);
}

template <Corners rule>
void by_jumps(const maps::BitGrid& grid, const Order& order, maps::Cell start, GridScratch& scratch,
              const Division& division, GridAnswer& answer) {
    SparseNodes& nodes = scratch.sparse;
    JumpPoints<rule> space(grid, order, nodes);
    const auto settled_at = [&](std::uint32_t place) {
        const auto& node = nodes[place];
        return Settled{grid.cell(node.cell), grid.cell(nodes[node.parent].cell), node.g.value()};
    };
    const std::uint32_t reached = search_from(start, space, scratch.buckets, division, answer, settled_at);
    if (!answer.found) return;
    answer.cost = answer.least = nodes[reached].g.value();
    std::vector<maps::Cell>& cells = answer.cells;
    for (std::uint32_t place = reached;; place = nodes[place].parent) {
        const maps::Cell to = grid.cell(nodes[place].cell);
        cells.push_back(to);
        if (nodes[place].parent == place) break;
        // From its parent it is reached along a diagonal first, or a column, and then straight on.
        const maps::Cell from = grid.cell(nodes[nodes[place].parent].cell);
        const int down = to.row - from.row, along = to.column - from.column;
        const int lead = std::min(std::abs(down), std::abs(along));
        const maps::Cell turn = rule == Corners::four ? maps::Cell{to.row, from.column}
                                                      : maps::Cell{from.row + (down > 0 ? lead : -lead),
                                                                   from.column + (along > 0 ? lead : -lead)};
        if (!(turn == to) && !(turn == from)) cells.push_back(turn);
    }
    std::reverse(cells.begin(), cells.end());
}

}  // namespace grid_search

// The path from start to goal, both free cells of the grid. parts: of this grid, or null for none.
inline void find_way(const maps::BitGrid& grid, maps::Cell start, maps::Cell goal, const GridQuery& query,
                     GridScratch& scratch, GridAnswer& answer, maps::LazyParts* parts = nullptr) {
    const bool backward = query.planner == GridPlanner::waves;
    const Order order = {backward ? start : goal, query.metric, query.g_weight, query.h_weight,
                         query.least_cost};
    answer.begin();
    const grid_search::Division division{grid, parts, start, goal, query.corners == Corners::always};
    if (division.is_known() && division.proves(answer)) return;
    const auto run = [&](const auto& parents, auto& nodes, auto& queue, bool reopen) {
        grid_search::by_cells(grid, query.corners, order, backward ? goal : start, parents, nodes, queue,
                              reopen, division, answer);
    };
    const auto run_steps = [&](auto& queue, bool reopen) {
        if (query.costs)
            run(StepParents<StepCost>{StepCost(query.costs, grid.columns())}, scratch.lengths, queue, reopen);
        else
            run(StepParents<StepLength>{}, scratch.steps, queue, reopen);
    };
    constexpr std::array jumps = {grid_search::by_jumps<Corners::never>, grid_search::by_jumps<Corners::one>,
                                  grid_search::by_jumps<Corners::always>,
                                  grid_search::by_jumps<Corners::four>};
    scratch.buckets.begin(grid_search::bucket_width * query.least_cost);
    switch (query.planner) {
        case GridPlanner::best_first:
            run_steps(scratch.buckets, false);
            break;
        case GridPlanner::focal: {
            search::FocalQueue queue(query.bound, grid.numbers());
            run_steps(queue, true);
            answer.least = queue.least();
            break;
        }
        case GridPlanner::jump_points:
            jumps[std::size_t(query.corners)](grid, order, start, scratch, division, answer);
            break;
        case GridPlanner::theta_star:
            run(SightParents{query.corners}, scratch.lengths, scratch.buckets, false);
            break;
        case GridPlanner::lazy_theta_star:
            run(LazySightParents{query.corners}, scratch.lengths, scratch.buckets, false);
            break;
        case GridPlanner::waves:
            scratch.waves.clear();
            run(StepParents<StepCount>{}, scratch.steps, scratch.waves, false);
            std::reverse(answer.cells.begin(), answer.cells.end());
            break;
    }
}

}  // namespace cspace::navigation
