// A potential over the cells of a grid as what a best-first search counts on: min(s U, Euclid) is never more
// than what is left, so the way is a shortest one; min(s U, w Euclid) never more than w times that, so the
// way is at most w times as long; and U alone, greedy, finds some way.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cspace/navigation/fields/clearance.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "cspace/navigation/grid/moves.hpp"
#include "cspace/navigation/grid/nodes.hpp"
#include "cspace/navigation/grid/order.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

struct PotentialOrder {
    double gain = 0;   // of ½ (1/ρ − 1/ρ₀)² [cells³]
    double rho_0 = 1;  // [cells]
    double cap = 0;    // the most that walls add [cells]
    double scale = 1;
    double weight = 1;       // at most so many times the straight line
    bool is_greedy = false;  // by the potential alone
};

class PotentialSearch {
  public:
    using Nodes = PagedNodes<Steps>;
    PotentialSearch(const maps::BitGrid& grid, const Clearance& clearance, const PotentialOrder& order,
                    Corners corners, maps::Cell goal, Nodes& nodes)
        : grid_(grid),
          clearance_(clearance),
          order_(order),
          allowed_(allowed_moves[std::size_t(corners)]),
          goal_(goal),
          goal_number_(grid.number(goal)),
          nodes_(nodes) {
        for (int d = 0; d < 8; ++d)
            offset_[d] = std::uint32_t(row_step[d]) * grid.stride() + std::uint32_t(column_step[d]);
        nodes_.begin(grid.numbers());
    }
    template <class Queue>
    void start(maps::Cell at, Queue& queue) {
        const std::uint32_t number = grid_.number(at);
        nodes_.reach(nodes_.at(number), Steps{}, number);
        queue.push(rank(Steps{}, at, number));
    }
    bool settle(std::uint32_t number) {
        auto& node = nodes_.at(number);
        if (nodes_.is_settled(node)) return false;
        nodes_.settle(node);
        return true;
    }
    bool is_goal(std::uint32_t number) const { return number == goal_number_; }
    template <class Queue>
    void expand(std::uint32_t number, Queue& queue) {
        const maps::Cell from = grid_.cell(number);
        const Steps g = nodes_.at(number).g;
        for (unsigned open = allowed_[grid_.around(from.row, from.column)]; open; open &= open - 1) {
            const int d = std::countr_zero(open);
            const std::uint32_t beside = number + offset_[d];
            auto& node = nodes_.at(beside);
            ++edges_;
            const Steps way = g + (is_diagonal(d) ? Steps{0, 1} : Steps{1, 0});
            if (nodes_.is_reached(node) && (order_.is_greedy || !(way < node.g))) continue;
            nodes_.reach(node, way, number);
            queue.push(rank(way, {from.row + row_step[d], from.column + column_step[d]}, beside));
        }
    }
    std::uint64_t edges() const { return edges_; }

    // The potential of a cell: the straight line to the goal, and what walls add. [cells]
    double potential(maps::Cell at, std::uint32_t number) const {
        const double rho = clearance_.of(number);
        const double near = rho < order_.rho_0 ? 1 / rho - 1 / order_.rho_0 : 0;
        return straight(at) + std::min(0.5 * order_.gain * near * near, order_.cap);
    }

  private:
    const maps::BitGrid& grid_;
    const Clearance& clearance_;
    PotentialOrder order_;
    const std::array<std::uint8_t, 512>& allowed_;
    maps::Cell goal_;
    std::uint32_t goal_number_;
    Nodes& nodes_;
    std::uint32_t offset_[8];
    std::uint64_t edges_ = 0;

    double straight(maps::Cell at) const {
        return straight_distance(goal_.row - at.row, goal_.column - at.column);
    }
    search::Waiting rank(Steps g, maps::Cell at, std::uint32_t number) const {
        const double pulled = order_.scale * potential(at, number);
        if (order_.is_greedy) return {number == goal_number_ ? 0 : pulled, 0, number};
        const double h = std::min(pulled, order_.weight * straight(at));
        return {g.value() + h, float(h), number};
    }
};

inline void find_by_potential(const maps::BitGrid& grid, const Clearance& clearance,
                              const PotentialOrder& order, Corners corners, maps::Cell start, maps::Cell goal,
                              GridAnswer& answer) {
    PotentialSearch::Nodes nodes;
    search::PriorityQueue queue;
    PotentialSearch space(grid, clearance, order, corners, goal, nodes);
    answer.effort.order = answer.settled ? &answer.order : nullptr;
    space.start(start, queue);
    answer.found = search::best_first(space, queue, answer.effort) != search::no_node;
    answer.effort.pushed = space.edges();
    grid_search::note_settled(answer, [&](std::uint32_t n) {
        const auto& node = nodes.at(n);
        return Settled{grid.cell(n), grid.cell(node.parent), space.potential(grid.cell(n), n)};
    });
    if (!answer.found) return;
    grid_search::follow_back(
        grid.number(goal), [&](std::uint32_t n) { return nodes.at(n).parent; },
        [&](std::uint32_t n) { return grid.cell(n); }, answer.cells);
}

}  // namespace cspace::navigation
