// Convex solids: points, boxes and cylinders, each with a radius around it.
#pragma once

#include <cmath>

#include "cspace/shapes/distance.hpp"

namespace cspace::shapes {

inline Convex make_points(const Vec3d* points, int count, double radius) {
    Convex solid = {Convex::Core::points, radius, identity_pose(), {0, 0, 0}, {}, count};
    for (int i = 0; i < count; ++i) solid.points[i] = points[i];
    return solid;
}
inline Convex make_ball(const Vec3d& center, double radius) { return make_points(&center, 1, radius); }
inline Convex make_box(const Posed& pose, const Vec3d& half) {
    return {Convex::Core::box, 0, pose, half, {}, 0};
}
inline Convex make_cylinder(const Posed& pose, double radius, double half) {
    return {Convex::Core::cylinder, 0, pose, {radius, radius, half}, {}, 0};
}

inline Convex move_solid(const Posed& T, const Convex& solid) {
    Convex moved = solid;
    moved.pose = T * solid.pose;
    for (int i = 0; i < solid.n_points; ++i) moved.points[i] = T * solid.points[i];
    return moved;
}

// The place of the core that is farthest in a direction.
inline Vec3d find_farthest(const Convex& solid, const Vec3d& direction) {
    if (solid.core == Convex::Core::points) {
        Vec3d farthest = solid.points[0];
        for (int i = 1; i < solid.n_points; ++i)
            if (dot(solid.points[i] - farthest, direction) > 0) farthest = solid.points[i];
        return farthest;
    }
    const Vec3d along = transpose_times(solid.pose.R, direction);
    Vec3d place = {0, 0, std::copysign(solid.half.z, along.z)};
    if (solid.core == Convex::Core::box) {
        place.x = std::copysign(solid.half.x, along.x);
        place.y = std::copysign(solid.half.y, along.y);
    } else if (const double across = std::sqrt(along.x * along.x + along.y * along.y); across > 0) {
        place.x = solid.half.x * (along.x / across), place.y = solid.half.y * (along.y / across);
    }
    return solid.pose * place;
}

inline Vec3d find_center(const Convex& solid) {
    if (solid.core != Convex::Core::points) return solid.pose.t;
    Vec3d sum = solid.points[0];
    for (int i = 1; i < solid.n_points; ++i) sum = sum + solid.points[i];
    return (1.0 / solid.n_points) * sum;
}
// How deep a place is inside a solid of one or two points, a box or a cylinder; below zero outside.
inline double find_depth(const Convex& solid, const Vec3d& place) {
    switch (solid.core) {
        case Convex::Core::box:
            return -distance_from_box(place, solid.pose.t, solid.pose.R, solid.half).value;
        case Convex::Core::cylinder:
            return -distance_from_cylinder(place, solid.pose.t, matrix_column(solid.pose.R, 2), solid.half.z,
                                           solid.half.x)
                        .value;
        default:
            return -distance_from_capsule(place, solid.points[0], solid.points[solid.n_points - 1],
                                          solid.radius)
                        .value;
    }
}
// How far places of the solid are from its centre.
inline double bound_size(const Convex& solid) {
    const Vec3d center = find_center(solid), &half = solid.half;
    double square = solid.core == Convex::Core::box        ? dot(half, half)
                    : solid.core == Convex::Core::cylinder ? half.x * half.x + half.z * half.z
                                                           : 0.0;
    for (int i = 0; i < solid.n_points; ++i)
        square = std::fmax(square, dot(solid.points[i] - center, solid.points[i] - center));
    return std::sqrt(square) + solid.radius;
}

}  // namespace cspace::shapes
