// The result of every planner: a path or the reason why there is none, statistics of the search, and what
// some planners add to it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "cspace/math/plane.hpp"

namespace cspace::navigation {

enum class Status : std::int8_t {
    found,
    unreachable,    // proven: start and goal lie in different components of free space
    undetermined,   // the search ended without a proof: its resolution, range or budget was too small
    local_minimum,  // the robot came to rest away from the goal
};

struct Stats {
    std::int64_t nodes = 0;  // states expanded, or steps taken
    std::int64_t edges = 0;  // edges looked at
};

struct Route {
    Status status = Status::undetermined;
    std::vector<Point> path;  // from start to goal; empty unless found, or as far as the robot came
    double length = std::numeric_limits<double>::infinity();
    Stats stats;
};

// Of approximate cells.
struct CellRoute {
    Route route;
    std::array<std::int64_t, 3> leaves{};  // free, mixed, full
    int depth = 0;                         // of the deepest leaf
};

// Of planners that draw samples.
struct SampledRoute {
    Route route;
    std::int64_t samples = 0;  // points drawn
};

// Of ways along the Voronoi diagram: least distances from walls [m].
struct DiagramRoute {
    Route route;
    double clearance = 0;  // on the whole way
    double on_diagram = 0;
    double at_start = 0, at_goal = 0;
};

// Of a descent in a potential, and where it ended.
enum class Rest : std::int8_t {
    goal,
    minimum,  // no force, and the potential rises in every direction
    saddle,   // no force, and it is too flat to tell which way is down
    crease,   // forces from several places of one boundary loop balance each other
    wall,     // on a wall from which no descent was found
    budget,   // no rest in so many steps
};
struct DescentRoute {
    Route route;
    Rest rest = Rest::budget;
    double force = 0;            // that is left
    int saddles = 0;             // places without force that were left again
    std::vector<double> values;  // of the potential along the path
};

inline double length_of(const std::vector<Point>& path) {
    double sum = 0;
    for (std::size_t i = 1; i < path.size(); ++i) sum += distance(path[i - 1], path[i]);
    return sum;
}

// A path was found, and written from the goal to the start.
inline void finish_reversed(Route& route) {
    route.status = Status::found;
    std::reverse(route.path.begin(), route.path.end());
    route.length = length_of(route.path);
}

// One thing that a planner did, in the order in which it did them: enough to draw its search again.
struct Event {
    std::int8_t kind;  // an index into the planner's list of words
    Point from, to;
    double value;
};
using Trace = std::vector<Event>;

}  // namespace cspace::navigation
