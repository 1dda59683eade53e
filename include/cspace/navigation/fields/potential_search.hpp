// A potential over the cells of a grid as what a best-first search counts on: min(s U, Euclid) is never more
// than what is left, so the way is a shortest one; min(s U, w Euclid) never more than w times that, so the
// way is at most w times as long; and U alone, greedy, finds some way.
#pragma once

#include <algorithm>
#include <cstdint>

#include "cspace/maps/clearance.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "cspace/navigation/grid/search.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

struct PotentialGains {
    double gain = 0;   // of ½ (1/ρ − 1/ρ₀)² [cells³]
    double rho_0 = 1;  // [cells]
    double cap = 0;    // the most that walls add [cells]
    double scale = 1;
    double weight = 1;       // at most so many times the straight line
    bool is_greedy = false;  // by the potential alone
};

// The order of the search.
struct PotentialOrder {
    const maps::Clearance& clearance;
    const PotentialGains& gains;
    maps::Cell goal;

    bool is_exact() const { return false; }
    search::Waiting rank(Steps g, maps::Cell at, std::uint32_t number) const {
        const double pulled = gains.scale * potential(at, number);
        if (gains.is_greedy) return {at == goal ? 0 : pulled, 0, number};
        const double h = std::min(pulled, gains.weight * straight(at));
        return {g.value() + h, float(h), number};
    }
    // The potential of a cell: the straight line to the goal, and what walls add. [cells]
    double potential(maps::Cell at, std::uint32_t number) const {
        const double rho = clearance.of(number);
        const double near = rho < gains.rho_0 ? 1 / rho - 1 / gains.rho_0 : 0;
        return straight(at) + std::min(0.5 * gains.gain * near * near, gains.cap);
    }
    double straight(maps::Cell at) const {
        return straight_distance(goal.row - at.row, goal.column - at.column);
    }
};

// A cell that a shorter way reaches is settled again; a greedy search looks at each cell once.
inline void find_by_potential(const maps::BitGrid& grid, const maps::Clearance& clearance,
                              const PotentialGains& gains, Corners corners, maps::Cell start, maps::Cell goal,
                              GridAnswer& answer) {
    PagedNodes<Steps> nodes;
    search::PriorityQueue queue;
    const PotentialOrder order{clearance, gains, goal};
    const grid_search::Division division{grid, nullptr, start, goal, false};
    answer.begin();
    const auto run = [&](auto length) {
        grid_search::by_cells(grid, corners, order, start, StepParents<decltype(length)>{length}, nodes,
                              queue, true, division, answer);
    };
    gains.is_greedy ? run(StepNothing{}) : run(StepLength{});
    for (Settled& one : answer.settled) one.g = order.potential(one.cell, grid.number(one.cell));
}

}  // namespace cspace::navigation
