// The nearest point of a triangle, in double.
#pragma once

#include <iterator>

#include "cspace/shapes/distance.hpp"

namespace cspace::shapes {

// Twice the area of a triangle over the square of its longest side, up to which its plane is unknown: its
// sides alone count then.
inline constexpr double flat_triangle = 1e-12;

inline Vec3d nearest_on_segment(const Vec3d& point, const Vec3d& a, const Vec3d& b) {
    const Vec3d along = b - a;
    const double square = dot(along, along);
    return square > 0 ? a + std::clamp(dot(point - a, along) / square, 0.0, 1.0) * along : a;
}

// The foot on the plane where it is inside the triangle, else the nearest of the feet on the three sides.
inline Vec3d nearest_on_triangle(const Vec3d& point, const Corners& t) {
    const Vec3d ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c;
    const Vec3d normal = cross(ab, bc);
    const double area = dot(normal, normal);
    const double longest = std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)});
    if (area > flat_triangle * flat_triangle * longest * longest) {
        const Vec3d foot = point - (dot(point - t.a, normal) / area) * normal;
        const auto is_inside = [&](const Vec3d& from, const Vec3d& side) {
            return dot(cross(side, foot - from), normal) >= 0;
        };
        if (is_inside(t.a, ab) && is_inside(t.b, bc) && is_inside(t.c, ca)) return foot;
    }
    const Vec3d feet[] = {nearest_on_segment(point, t.a, t.b), nearest_on_segment(point, t.b, t.c),
                          nearest_on_segment(point, t.c, t.a)};
    const auto square = [&](const Vec3d& foot) { return dot(point - foot, point - foot); };
    return *std::min_element(std::begin(feet), std::end(feet),
                             [&](const Vec3d& x, const Vec3d& y) { return square(x) < square(y); });
}

}  // namespace cspace::shapes
