// The boundary of free space as closed rings of directed edges, the free space on the left of each.
//
// A ring is what a robot sees that walks along it: at a point where obstacles meet it turns back on its own
// side, and a wall without thickness is passed on both sides. So a ring belongs to one component of the open
// free space.
#pragma once

#include <cstdint>
#include <vector>

#include "cspace/math/plane.hpp"

namespace cspace::maps {

struct Boundary {
    std::vector<Point> points;       // where edge i begins; a point where rings touch is listed once for each
    std::vector<std::int32_t> next;  // the edge after edge i: i leads from points[i] to points[next[i]]
    std::vector<std::int32_t> ring;  // the ring of edge i
    std::vector<std::int32_t> component;  // the component of free space of each ring

    std::size_t size() const { return points.size(); }
    Point begin(std::int32_t edge) const { return points[std::size_t(edge)]; }
    Point end(std::int32_t edge) const { return points[std::size_t(next[std::size_t(edge)])]; }
};

}  // namespace cspace::maps
