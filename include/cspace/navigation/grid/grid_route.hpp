// A way over a grid as a path in the plane, and the search as events.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/grid_frame.hpp"
#include "cspace/navigation/grid/order.hpp"
#include "cspace/navigation/route.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

// What a search over the cells of a grid answers.

// A cell that was settled: how far it is, and from which cell.
struct Settled {
    maps::Cell cell, parent;
    double g;
};

struct GridAnswer {
    bool is_traced = false;
    bool found = false;
    std::vector<maps::Cell> cells;  // from start to goal; between two that follow each other the way is a
                                    // row, a column or a diagonal, or, of any angle, a straight line
    double cost = 0;                // of the way, as the planner counts [cells, or cells · cost]
    double least = 0;               // no path costs less, if the planner proves that
    search::Effort effort;
    std::int64_t parts = 0;  // how many there are, if the ends lie in two of them, which proves the verdict
    std::vector<Settled> settled;      // of a traced search, in the order in which they were settled
    std::vector<std::uint32_t> order;  // the same as the search numbers them

    // Forgets what another search answered.
    void begin() {
        found = false;
        parts = 0;
        cells.clear(), settled.clear(), order.clear();
        effort = {};
        if (is_traced) effort.order = &order;
    }
};

// The length of a way whose pieces are rows, columns and diagonals, exact to a rounding; of one of any angle
// the sum of its pieces. [cells]
inline double length_of(const std::vector<maps::Cell>& cells) {
    Steps steps;
    double slanted = 0;
    for (std::size_t k = 1; k < cells.size(); ++k) {
        const int down = std::abs(cells[k].row - cells[k - 1].row);
        const int along = std::abs(cells[k].column - cells[k - 1].column);
        if (down == along || down == 0 || along == 0)
            steps = steps + octile_steps(down, along);
        else
            slanted += straight_distance(down, along);
    }
    return steps.value() + slanted;
}

// The route between two points in free cells, from what a search has found between the cells: start, the
// centres of the cells where the way turns, goal; no point twice in a row.
inline void draw_route(const maps::GridFrame& frame, Point start, Point goal, const GridAnswer& answer,
                       Route& route) {
    route.stats = {std::int64_t(answer.effort.settled), std::int64_t(answer.effort.pushed)};
    route.status = answer.found ? Status::found : Status::unreachable;
    route.path.clear();
    route.length = std::numeric_limits<double>::infinity();
    if (!answer.found) return;
    const auto& cells = answer.cells;
    route.path.reserve(cells.size() + 2);
    route.path.assign(1, start);
    const auto add = [&](Point p) {
        if (!(p == route.path.back())) route.path.push_back(p);
    };
    for (std::size_t k = 0; cells.size() > 1 && k < cells.size(); ++k) {
        if (k > 0 && k + 1 < cells.size()) {
            const int r0 = cells[k].row - cells[k - 1].row, c0 = cells[k].column - cells[k - 1].column;
            const int r1 = cells[k + 1].row - cells[k].row, c1 = cells[k + 1].column - cells[k].column;
            if (std::int64_t(r0) * c1 == std::int64_t(r1) * c0) continue;  // straight on
        }
        add(frame.center(cells[k]));
    }
    add(goal);
    route.length = cells.size() < 2
                       ? distance(start, goal)
                       : distance(start, frame.center(cells.front())) + frame.resolution * length_of(cells) +
                             distance(frame.center(cells.back()), goal);
}

// The cells that a search has settled as events.
inline void list_settled(const maps::GridFrame& frame, const std::vector<Settled>& settled, Trace& trace) {
    for (const auto& [cell, parent, g] : settled)
        trace.push_back({0, frame.center(parent), frame.center(cell), frame.resolution * g});
}

}  // namespace cspace::navigation
