// Signed distances of a point from solids, in double, with the direction in which they grow.
#pragma once

#include <algorithm>
#include <cmath>

#include "cspace/shapes/plain.hpp"

namespace cspace::shapes {

// From the ball of this radius around the nearest place of something of no volume.
inline Distance from_place(const Vec3d& point, const Vec3d& place, double radius) {
    const Vec3d d = point - place;
    const double length = std::sqrt(dot(d, d));
    const Vec3d normal = length > 0 ? (1 / length) * d : Vec3d{0, 0, 1};
    return {length - radius, normal};
}

// A capsule from a to b; a sphere if they are equal.
inline Distance distance_from_capsule(const Vec3d& point, const Vec3d& a, const Vec3d& b, double radius) {
    const Vec3d along = b - a;
    const double square = dot(along, along);
    const double t = square > 0 ? std::clamp(dot(point - a, along) / square, 0.0, 1.0) : 0.0;
    return from_place(point, a + t * along, radius);
}

// Excesses over the faces, along unit directions: outside the norm of the positive ones, inside the largest.
template <int n>
Distance combine_excesses(const double (&excess)[n], const Vec3d (&direction)[n]) {
    Vec3d sum = {0, 0, 0};
    int largest = 0;
    for (int k = 0; k < n; ++k) {
        if (excess[k] > 0) sum = sum + excess[k] * direction[k];
        if (excess[k] > excess[largest]) largest = k;
    }
    if (excess[largest] <= 0) return {excess[largest], direction[largest]};
    const double length = std::sqrt(dot(sum, sum));
    return {length, (1 / length) * sum};
}

// A box around `center`; columns of R: its axes.
inline Distance distance_from_box(const Vec3d& point, const Vec3d& center, const Mat3d& R,
                                  const Vec3d& half) {
    const Vec3d y = transpose_times(R, point - center);
    const double excess[] = {std::fabs(y.x) - half.x, std::fabs(y.y) - half.y, std::fabs(y.z) - half.z};
    const Vec3d direction[] = {std::copysign(1.0, y.x) * matrix_column(R, 0),
                               std::copysign(1.0, y.y) * matrix_column(R, 1),
                               std::copysign(1.0, y.z) * matrix_column(R, 2)};
    return combine_excesses(excess, direction);
}

// A cylinder with flat ends at ± half along its unit axis.
inline Distance distance_from_cylinder(const Vec3d& point, const Vec3d& center, const Vec3d& axis,
                                       double half, double radius) {
    const Vec3d d = point - center;
    const double along = dot(d, axis);
    const Vec3d across = d - along * axis;
    const double far = std::sqrt(dot(across, across));
    const Vec3d outward = far > 0 ? (1 / far) * across : any_perpendicular(axis);
    const double excess[] = {far - radius, std::fabs(along) - half};
    const Vec3d direction[] = {outward, std::copysign(1.0, along) * axis};
    return combine_excesses(excess, direction);
}

// A half space: solid where n · x ≤ offset, n a unit vector.
inline Distance distance_from_half_space(const Vec3d& point, const Vec3d& normal, double offset) {
    return {dot(normal, point) - offset, normal};
}

}  // namespace cspace::shapes
