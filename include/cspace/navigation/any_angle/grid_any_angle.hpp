// The shortest path between points of a grid, without more memory than the bits of its cells and what the
// search comes to: Polyanya over runs of free cells. It works in cells, whose corners are whole numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "cspace/maps/grid_frame.hpp"
#include "cspace/maps/grid_parts.hpp"
#include "cspace/maps/run_mesh.hpp"
#include "cspace/navigation/any_angle/polyanya.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::navigation {

// A point of a query, in cells, and the runs of free cells whose closures contain it: none in a blocked cell.
struct SettledInRuns {
    Point at;
    std::vector<maps::RunMesh::Run> runs;
};

class GridAnyAngle {
  public:
    GridAnyAngle(const maps::BitGrid& grid, const maps::GridFrame& frame)
        : grid_(grid), frame_(frame), mesh_(grid), search_(mesh_) {}

    // A coordinate that only rounding keeps from a line between cells is on it, and so is one as near as a
    // grid allows where the point else lies in a blocked cell.
    SettledInRuns settle(Point p) const {
        const Point low = frame_.origin;
        SettledInRuns settled{{in_cells(p.x, low.x), in_cells(p.y, low.y)}, {}};
        find_runs(settled);
        if (!settled.runs.empty()) return settled;
        settled.at = {snapped(settled.at.x, tolerance::cell_border),
                      snapped(settled.at.y, tolerance::cell_border)};
        find_runs(settled);
        return settled;
    }

    // start, goal [m] as they were given, and as they were settled. parts: of this grid, or null for none.
    Route solve(Point start, const SettledInRuns& from, Point goal, const SettledInRuns& to,
                maps::LazyParts* parts = nullptr, Trace* trace = nullptr) {
        const auto is_divided = [&] { return divided(parts->of(grid_, false), from, to); };
        const std::uint64_t patience = parts ? maps::LazyParts::patience(grid_) : never;
        Route route;
        route.status = Status::unreachable;
        if (patience < grid_.numbers() && parts->is_made(false) && is_divided()) return route;
        // Nodes after which parts are looked at: each takes longer than to settle a cell.
        const std::uint64_t pause = parts ? patience >> 1 : never;
        const auto on_pause = [&] { return is_divided() ? 0 : never; };
        route = search_.solve(from.at, from.runs, to.at, to.runs, trace, pause, on_pause);
        for (Point& p : route.path) p = in_metres(p);
        if (!route.path.empty()) {
            route.path.front() = start, route.path.back() = goal;
            route.length = length_of(route.path);
        }
        if (!trace) return route;
        for (Event& event : *trace)
            event = {event.kind, in_metres(event.from), in_metres(event.to), event.value * frame_.resolution};
        return route;
    }
    std::size_t bytes() const { return search_.bytes(); }

  private:
    static constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();
    const maps::BitGrid& grid_;
    maps::GridFrame frame_;
    maps::RunMesh mesh_;
    IntervalSearch<maps::RunMesh> search_;

    static bool divided(const maps::GridParts& parts, const SettledInRuns& from, const SettledInRuns& to) {
        for (const auto& a : from.runs)
            for (const auto& b : to.runs)
                if (!parts.divide({a.row, a.begin}, {b.row, b.begin})) return false;
        return true;
    }

    double in_cells(double at, double origin) const {
        constexpr double roundings = 4.5e-16;
        return snapped((at - origin) / frame_.resolution,
                       roundings * (std::abs(at) + std::abs(origin)) / frame_.resolution);
    }
    Point in_metres(Point p) const { return frame_.origin + frame_.resolution * p; }
    static double snapped(double at, double tolerance) {
        const double whole = std::round(at);
        return std::abs(at - whole) <= tolerance ? whole : at;
    }

    // The free runs of the one or two rows, and one or two columns, that contain the point.
    void find_runs(SettledInRuns& settled) const {
        const Point p = settled.at;
        if (!(p.x >= 0 && p.x <= grid_.columns() && p.y >= 0 && p.y <= grid_.rows())) return;
        const int row = int(p.y), column = int(p.x);
        for (int r = row - (row == p.y); r <= row; ++r)
            for (int c = column; c >= column - (column == p.x); --c) {
                if (grid_.blocked(r, c)) continue;
                settled.runs.push_back(mesh_.run_at({r, c}));
                break;  // the cell beside it is of the same run, or blocked
            }
    }
};

}  // namespace cspace::navigation
