// The outlines of obstacles.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "cspace/math/plane.hpp"

namespace cspace::maps {

using Index = std::int32_t;

// Edges between points, in either direction, each owned by an obstacle. A place belongs to an obstacle if a
// line from far away to it crosses the obstacle's outline an odd number of times: an outline inside an
// outline is a hole.
struct Outlines {
    struct Edge {
        Index from, to, owner;
    };
    std::vector<Point> points;
    std::vector<Edge> edges;
    Index obstacles = 0;  // owners are numbered from 0 to obstacles − 1
    Point low, high;      // the bounds: what lies outside them is no free space

    void add_ring(std::span<const Point> ring, Index owner) {
        const Index first = Index(points.size()), count = Index(ring.size());
        points.insert(points.end(), ring.begin(), ring.end());
        for (Index i = 0; i < count; ++i) edges.push_back({first + i, first + (i + 1) % count, owner});
        obstacles = std::max(obstacles, owner + 1);
    }
};

}  // namespace cspace::maps
