// The order of a search: g, the length so far, and h, a lower bound on the rest, each with its weight.
// Weights (1, 0) make it Dijkstra's (1959), (1, 1) A* (Hart, Nilsson & Raphael 1968), (1, w) weighted A*,
// whose ways are at most w times the shortest (Pohl 1970), (0, 1) greedy best-first search.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/navigation/grid/steps.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

// What is left at least, between cells dr rows and dc columns apart: by eight moves, by four, straight on.
enum class Metric : std::uint8_t { octile, manhattan, euclidean };

inline Steps octile_steps(int dr, int dc) {
    dr = std::abs(dr), dc = std::abs(dc);
    return {std::abs(dr - dc), std::min(dr, dc)};
}
inline double straight_distance(int dr, int dc) { return std::sqrt(double(dr) * dr + double(dc) * dc); }

struct Order {
    maps::Cell goal;
    Metric metric = Metric::octile;
    double g_weight = 1, h_weight = 1;
    double least_cost = 1;  // of a step of length 1

    Steps steps_left(maps::Cell at) const {
        const int dr = goal.row - at.row, dc = goal.column - at.column;
        return metric == Metric::manhattan ? Steps{std::abs(dr) + std::abs(dc), 0} : octile_steps(dr, dc);
    }
    double left(maps::Cell at) const {
        if (metric == Metric::euclidean) return straight_distance(goal.row - at.row, goal.column - at.column);
        return steps_left(at).value();
    }
    search::Waiting rank(Steps g, maps::Cell at, std::uint32_t node) const {
        if (metric != Metric::euclidean && g_weight == 1 && h_weight == 1) {
            const Steps h = steps_left(at);  // summed in integers, so that equal sums are equal numbers
            return {(g + h).value(), float(h.value()), node};
        }
        return rank(g.value(), at, node);
    }
    search::Waiting rank(double g, maps::Cell at, std::uint32_t node) const {
        if (h_weight == 0) return {g, 0, node};
        const double h = least_cost * left(at);
        return {g_weight * g + h_weight * h, float(h), node};
    }
};

}  // namespace cspace::navigation
