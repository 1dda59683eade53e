// The result of every planner: a path or the reason why there is none, and statistics of the search.
#pragma once

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

inline double length_of(const std::vector<Point>& path) {
    double sum = 0;
    for (std::size_t i = 1; i < path.size(); ++i) sum += distance(path[i - 1], path[i]);
    return sum;
}

// One thing that a planner did, in the order in which it did them: enough to draw its search again.
struct Event {
    std::int8_t kind;  // an index into the planner's list of words
    Point from, to;
    double value;
};
using Trace = std::vector<Event>;

}  // namespace cspace::navigation
