// The order of a search: g, the length so far, and h, a lower bound on the rest, each with its weight.
// Weights (1, 0) make it Dijkstra's (1959), (1, 1) A* (Hart, Nilsson & Raphael 1968), (1, w) weighted A*,
// whose ways are at most w times the shortest (Pohl 1970), (0, 1) greedy best-first search.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

// The length of a path over a grid, exact: how many steps along rows and columns, and how many diagonal ones.

inline constexpr double sqrt_two = 1.4142135623730951;

struct Steps {
    std::int32_t straight = 0, diagonal = 0;
    // In cells. Ways of less than 2²⁴ steps of each kind get different numbers unless they are equally long.
    double value() const { return straight + sqrt_two * diagonal; }
    friend Steps operator+(Steps x, Steps y) { return {x.straight + y.straight, x.diagonal + y.diagonal}; }
    friend bool operator==(Steps, Steps) = default;
    // Whether a + b √2 < 0 for the differences a, b, that is a |a| + 2 b |b| < 0. For less than 2³⁰ steps.
    friend bool operator<(Steps x, Steps y) {
        const std::int64_t a = std::int64_t(x.straight) - y.straight,
                           b = std::int64_t(x.diagonal) - y.diagonal;
        return a * std::abs(a) + 2 * b * std::abs(b) < 0;
    }
};

inline double value_of(Steps g) { return g.value(); }
inline double value_of(double g) { return g; }

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

    // Whether cells are settled in the order of the length of the way over them.
    bool is_exact() const { return g_weight == 1 && (h_weight == 0 || h_weight == 1); }
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
