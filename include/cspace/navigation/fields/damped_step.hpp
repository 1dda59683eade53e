// The step down a slope that gives way least where the ground is stiff: −(λ I + H)⁻¹ g, of a given length.
#pragma once

#include <algorithm>
#include <cmath>

#include "cspace/navigation/fields/potential.hpp"

namespace cspace::navigation {

// Gradient flow by the linearly implicit Euler rule with the time step 1 / λ: across a valley it goes to the
// bottom and no farther, along it as far as it may. λ is found by Newton's rule for 1 / |step| (Moré &
// Sorensen 1983, "Computing a trust region step"). Shorter than `longest` where the bottom is nearer.
inline Point damped_step(const Stiffness& h, Point slope, double longest) {
    const double mean = 0.5 * (h.xx + h.yy), half = 0.5 * (h.xx - h.yy);
    const double spread = std::hypot(half, h.xy);
    const double h1 = mean + spread, h2 = std::max(0.0, mean - spread);
    // The direction in which it is stiffest.
    Point n{1, 0};
    if (spread > 0) n = half > 0 ? Point{spread + half, h.xy} : Point{h.xy, spread - half};
    if (const double size = norm(n); size > 0) n = (1 / size) * n;
    const double g1 = dot(n, slope), g2 = cross(n, slope);
    double damping = std::max({0.0, std::abs(g1) / longest - h1, std::abs(g2) / longest - h2});
    Point step;
    for (int round = 0; round < 8; ++round) {
        const double a = damping + h1, b = damping + h2;
        step = {a > 0 ? g1 / a : 0, b > 0 ? g2 / b : 0};
        const double size = norm(step);
        if (!(size > longest * (1 + 1e-3))) break;
        const double bent = (a > 0 ? step.x * step.x / a : 0) + (b > 0 ? step.y * step.y / b : 0);
        damping += (size / longest - 1) * size * size / bent;
    }
    if (const double size = norm(step); size > longest) step = (longest / size) * step;
    return Point{} - (step.x * n + step.y * Point{-n.y, n.x});
}

}  // namespace cspace::navigation
