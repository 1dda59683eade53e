// A ball around balls, close to the smallest one.
#pragma once

#include <cmath>
#include <span>

#include "cspace/math/vec.hpp"

namespace cspace::shapes {

struct Ball {
    Vec3d center;
    double radius;
};

// Walks towards the farthest ball by ever shorter steps (Bădoiu & Clarkson 2003, "Smaller core-sets for
// balls"); keeps the best centre seen, which lies in the convex hull of the given centres. The radius is that
// of the farthest point from it. The balls given: at least one.
inline Ball smallest_ball(std::span<const Ball> balls) {
    constexpr int steps = 2000;
    const auto minus = [](const Vec3d& a, const Vec3d& b) { return Vec3d{a.x - b.x, a.y - b.y, a.z - b.z}; };
    const double share = 1 / double(balls.size());
    Vec3d at = {0, 0, 0};
    for (const Ball& b : balls)
        at.x += share * b.center.x, at.y += share * b.center.y, at.z += share * b.center.z;
    Ball best = {at, -1};
    for (int i = 0; i < steps; ++i) {
        double farthest = -1;
        Vec3d towards = {0, 0, 0};
        double distance = 0;
        for (const Ball& b : balls) {
            const Vec3d d = minus(b.center, at);
            const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
            if (length + b.radius > farthest) farthest = length + b.radius, towards = d, distance = length;
        }
        if (best.radius < 0 || farthest < best.radius) best = {at, farthest};
        if (distance == 0) break;
        // The point of the ball that is farthest away lies `farthest` ahead; never beyond the centre of it.
        const double step = std::fmin(farthest / double(i + 2) / distance, 1);
        at.x += step * towards.x, at.y += step * towards.y, at.z += step * towards.z;
    }
    return best;
}

}  // namespace cspace::shapes
