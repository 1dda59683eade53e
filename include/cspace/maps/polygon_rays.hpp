// Rays among polygons: from triangle to triangle of free space until a wall is in the way, decided by exact
// orientations.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cspace/maps/polygon_world.hpp"

namespace cspace::maps {

namespace rays {

// How far along a unit direction the line through a and b lies; where it is parallel, its nearer end.
inline double distance_along(Point from, Point direction, Point a, Point b) {
    const double slant = cross(direction, b - a);
    if (slant != 0) return cross(a - from, b - a) / slant;
    return std::min(dot(a - from, direction), dot(b - from, direction));
}

// From a point in the closure of a free triangle.
inline double walk_triangles(const FreeSpace& space, Point from, Index t, Point direction, double most) {
    const Triangulation& mesh = space.mesh;
    const Point to = from + most * direction;
    double reached = 0;
    for (std::size_t steps = 0; steps <= mesh.triangles.size(); ++steps) {
        const Triangle& triangle = mesh[t];
        int out = -1;
        bool is_last = true;
        for (int e = 0; e < 3; ++e) {
            const Point a = mesh.point(triangle.begin(e)), b = mesh.point(triangle.end(e));
            if (orientation(a, b, to) >= 0) continue;
            is_last = false;
            if (orientation(from, to, a) <= 0 && orientation(from, to, b) >= 0) {
                out = e;
                if (!space.is_wall(t, e)) break;
            }
        }
        if (is_last) return most;
        if (out < 0) return reached;
        const Point a = mesh.point(triangle.begin(out)), b = mesh.point(triangle.end(out));
        reached = std::clamp(distance_along(from, direction, a, b), reached, most);
        if (space.is_wall(t, out)) return reached;
        t = triangle.across[std::size_t(out)];
        if (!space.is_free(t)) return reached;
    }
    return reached;
}

}  // namespace rays

// The free triangles whose closures contain a point: none inside obstacles and outside the bounds.
inline void find_triangles(const PolygonWorld& world, Point p, std::vector<Index>& triangles) {
    triangles.clear();
    if (world.is_inside_bounds(p)) world.space.triangles_at(p, world.locator.near(p), triangles);
}

// The distance [m] to the first wall from a point in free triangles, in the direction of a unit vector;
// `most` where it is farther, and 0 without triangles. A ray along a wall or through a corner may go past it
// or stop there.
inline double cast_ray(const PolygonWorld& world, Point from, const std::vector<Index>& triangles,
                       Point direction, double most) {
    const Point span = world.outlines.high - world.outlines.low;
    const double far = std::min(most, 2 * norm(span));  // no ray in the bounds is longer
    double reached = 0;
    for (const Index t : triangles)
        reached = std::max(reached, rays::walk_triangles(world.space, from, t, direction, far));
    return reached;
}

}  // namespace cspace::maps
