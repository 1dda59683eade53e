// Robots without a map in a polygon world: what the bindings call.
#pragma once

#include <cstdint>
#include <vector>

#include "cspace/navigation/route.hpp"
#include "maps_polygon_world.hpp"

namespace cspace::navigation {

using maps::PolygonCore;

// What every robot tells: its walk, and where the line to an unreachable goal enters the walls that shut it
// off.
struct Walk {
    Route route;
    int shut_ring = -1;
    Point shut_at;
};

struct WallFollower {
    enum Kind { bug_1, bug_2, tangent_bug };
    enum Side { left, right, either };  // `either` for the tangent bug alone
    std::int64_t kind, side;
    double range;
};
// The stretches along walls, one entry of each list for each.
struct WallWalk : Walk {
    std::vector<Point> hits, leaves;
    std::vector<double> walked;  // [m]
    std::vector<std::int64_t> rings;
};
// False where an end lies in an obstacle, here and below.
bool follow_walls(const PolygonCore& core, const WallFollower& robot, Point start, Point goal, WallWalk& walk,
                  Trace* trace);

// Voronoi Bug: the standard deviation of its sensor, 0 for one without noise.
struct DiagramTracer {
    double range, deviation;
    unsigned long long seed;
};
struct DiagramWalk : Walk {
    std::vector<Point> meets;  // where three walls or more are nearest
    std::int64_t branches = 0, dead_ends = 0, scans = 0;
    double clearance = 0;  // least on the curves that it followed [m]
};
bool trace_diagram(const PolygonCore& core, const DiagramTracer& robot, Point start, Point goal,
                   DiagramWalk& walk, Trace* trace);

}  // namespace cspace::navigation
