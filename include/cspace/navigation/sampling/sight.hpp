// Straight ways through the triangles of free space, from one to the next and never through a wall: where
// such a row of triangles exists, the segment lies in free space and passes between no two obstacles that
// meet in a point. Decided by exact orientations alone.
#pragma once

#include "cspace/maps/free_space.hpp"

namespace cspace::navigation::sampling {

using maps::FreeSpace;
using maps::Index;
using maps::none;

// A point and a free triangle whose closure contains it.
struct Located {
    Point at;
    Index triangle = none;
};

// Whether p lies inside a triangle, on none of its edges.
inline bool is_within(const FreeSpace& space, Index t, Point p) {
    const maps::Triangle& tri = space.mesh[t];
    for (int e = 0; e < 3; ++e)
        if (orientation(space.mesh.point(tri.begin(e)), space.mesh.point(tri.end(e)), p) <= 0) return false;
    return true;
}

// The free triangle in which the segment from a point to q ends, or none where a wall is in its way. Of a
// segment along a wall or past a corner one side only is looked at: it may count as hidden.
inline Index end_of_sight(const FreeSpace& space, Located from, Point q) {
    const maps::Triangulation& mesh = space.mesh;
    Index t = from.triangle;
    for (std::size_t steps = 0; steps <= mesh.triangles.size(); ++steps) {
        const maps::Triangle& tri = mesh[t];
        int out = -1;
        bool is_last = true;
        for (int e = 0; e < 3; ++e) {
            const Point a = mesh.point(tri.begin(e)), b = mesh.point(tri.end(e));
            if (orientation(a, b, q) >= 0) continue;
            is_last = false;
            if (orientation(from.at, q, a) <= 0 && orientation(from.at, q, b) >= 0) {
                out = e;
                if (!space.is_wall(t, e)) break;
            }
        }
        if (is_last) return t;
        if (out < 0 || space.is_wall(t, out)) return none;
        t = tri.across[std::size_t(out)];
        if (!space.is_free(t)) return none;
    }
    return none;
}

// Whether a path that begins in the closure of a free triangle never meets a wall.
inline bool keeps_in_sight(const FreeSpace& space, const std::vector<Point>& path, Index triangle) {
    for (std::size_t leg = 1; leg < path.size() && triangle != none; ++leg)
        triangle = end_of_sight(space, {path[leg - 1], triangle}, path[leg]);
    return triangle != none;
}

}  // namespace cspace::navigation::sampling
