// Candidates for a cover: balls around places deep inside a surface, near its medial axis.
#pragma once

#include <cmath>
#include <vector>

#include "cspace/shapes/cover_items.hpp"
#include "cspace/shapes/smallest_ball.hpp"
#include "cspace/shapes/triangle_surface.hpp"

namespace cspace::shapes {

// The largest empty ball that touches the surface at p, on the side of the unit vector n: shrinks until no
// place of the surface lies inside (Ma, Bae & Choi 2012). radius: not the distance from the surface yet.
inline Ball touching_ball(const TriangleSurface& surface, const Vec3d& p, const Vec3d& n, double radius) {
    constexpr int most_steps = 30;
    constexpr double shrunk = 0.99;  // a ball that shrinks by less touches already
    for (int step = 0; step < most_steps; ++step) {
        const Vec3d center = p + radius * n;
        const auto near = surface.nearest(center);
        if (near.square >= shrunk * shrunk * radius * radius) break;
        const Vec3d d = near.place - p;
        const double ahead = dot(d, n);
        if (!(ahead > 0)) break;
        radius = std::min(square_of(d) / (2 * ahead), shrunk * radius);
    }
    return {p + radius * n, radius};
}

// Walks away from the nearest place by ever shorter steps; returns the deepest place seen.
inline Ball grow_ball(const TriangleSurface& surface, const Vec3d& start, double step, int steps) {
    constexpr double shorter = 0.75;
    Ball best = {start, -1};
    Vec3d at = start;
    for (int i = 0; i <= steps; ++i, step *= shorter) {
        const auto near = surface.nearest(at);
        const double depth = std::sqrt(near.square);
        if (depth > best.radius) best = {at, depth};
        if (!(depth > 0)) break;
        at = at + (step / depth) * (at - near.place);
    }
    return best;
}

}  // namespace cspace::shapes
