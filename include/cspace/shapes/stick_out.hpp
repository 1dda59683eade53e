// How far spheres stick out of a solid: the largest distance of a place in a sphere from the solid.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "cspace/shapes/cover_check.hpp"
#include "cspace/shapes/triangle_surface.hpp"
#include "cspace/shapes/watch.hpp"

namespace cspace::shapes {

// The signed distance from a solid, negative inside; from the surface alone where it is none.
inline double signed_distance(const TriangleSurface& surface, bool solid, const Vec3d& p) {
    const double distance = surface.distance(p);
    return solid && distance > 0 && surface.winding(p) >= 1 ? -distance : distance;
}

// A bound of it for one sphere: that at its centre and its radius.
inline double bound_stick_out(const TriangleSurface& surface, bool solid, const Ball& ball) {
    const double rounding = surface_rounding * surface.extent();
    return std::max(0.0, signed_distance(surface, solid, ball.center) + ball.radius + rounding);
}

// Divides the cubes around spheres into cells. The distance from the solid changes by no more than the way,
// so its value at one place bounds it on a cell.
class StickOut {
  public:
    // tolerance: how far the bounds may be apart; most: cells that are examined.
    StickOut(const TriangleSurface& surface, bool solid, double tolerance, std::size_t most, Watch& watch)
        : surface_(surface), solid_(solid), tolerance_(tolerance), most_(most), watch_(watch) {}

    Bounds measure(std::span<const Ball> balls) {
        std::vector<double> bound(balls.size());
        for (std::size_t k = 0; k < balls.size(); ++k) {
            bound[k] = bound_stick_out(surface_, solid_, balls[k]);
            watch_.step();
        }
        std::vector<std::size_t> order(balls.size());
        std::iota(order.begin(), order.end(), std::size_t(0));
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return bound[a] > bound[b]; });
        found_ = {0, 0};
        for (const std::size_t k : order) {
            const Ball& b = balls[k];
            const Vec3d half = {b.radius, b.radius, b.radius};
            if (!is_settled(bound[k])) measure_cell(b, {b.center - half, b.center + half}, bound[k]);
        }
        return found_;
    }

  private:
    const TriangleSurface& surface_;
    bool solid_;
    double tolerance_;
    std::size_t most_, cells_ = 0;
    Watch& watch_;
    Bounds found_ = {0, 0};

    bool is_settled(double bound) {
        if (bound > found_.lower + tolerance_ && cells_ < most_) return false;
        found_.upper = std::max(found_.upper, bound);
        return true;
    }
    void measure_cell(const Ball& ball, const Box& cell, double known) {
        watch_.step(), ++cells_;
        if (nearest_square(cell, ball.center) > ball.radius * ball.radius) return;
        const Vec3d middle = middle_of(cell), d = middle - ball.center;
        const double from_center = norm(d);
        const Vec3d place =
            from_center > ball.radius ? ball.center + (ball.radius / from_center) * d : middle;
        const double rounding = surface_rounding * surface_.extent();
        const double at_place = signed_distance(surface_, solid_, place);
        found_.lower = std::max(found_.lower, at_place - rounding);
        const double bound = std::min(known, at_place + std::sqrt(farthest_square(cell, place)) + rounding);
        if (bound <= 0 || is_settled(bound)) return;
        for (int k = 0; k < 8; ++k) measure_cell(ball, octant_of(cell, middle, k), bound);
    }
};

}  // namespace cspace::shapes
