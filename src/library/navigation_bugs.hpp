// Robots without a map in a polygon world: what the bindings call.
#pragma once

#include <utility>

#include "navigation_query.hpp"
#include "table.hpp"

namespace cspace::navigation {

// Where the line to an unreachable goal enters the walls that shut it off: the boundary loop, and the point.
using Shut = std::optional<std::pair<int, std::pair<double, double>>>;

struct WallQuery : Query<PolygonCore> {
    enum Kind { bug_1, bug_2, tangent_bug };
    enum Side { left, right, either };  // `either` for the tangent bug alone
    std::int64_t kind, side;
    double range;
    // The stretches along walls, one row of each table for each.
    Table<Point> hits, leaves;
    Table<double> walked;  // [m]
    Table<std::int64_t> rings;
    Shut shut;

    auto settings() { return std::tie(kind, side, range); }
    bool find(const PolygonCore& core, Point start, Point goal, Trace* trace);
    auto evidence() {
        return std::optional(
            std::tuple(std::move(hits), std::move(leaves), std::move(walked), std::move(rings), shut));
    }
};

// Voronoi Bug: the standard deviation of its sensor, 0 for one without noise.
struct VoronoiBugQuery : Query<PolygonCore> {
    double range, deviation;
    std::uint64_t seed;
    Table<Point> meets;  // where three walls or more are nearest
    std::int64_t branches, dead_ends, scans;
    double clearance;  // least on the curves that it followed [m]
    Shut shut;

    auto settings() { return std::tie(range, deviation, seed); }
    bool find(const PolygonCore& core, Point start, Point goal, Trace* trace);
    auto evidence() {
        return std::optional(std::tuple(std::move(meets), branches, dead_ends, clearance, scans, shut));
    }
};

}  // namespace cspace::navigation
