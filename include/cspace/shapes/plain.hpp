// Plain data of shapes: distances with their gradients, the corners of a triangle, convex solids.
#pragma once

#include "cspace/math/vec.hpp"

namespace cspace::shapes {

// Negative inside. normal: the unit gradient of the distance at the point.
struct Distance {
    double value;
    Vec3d normal;
};

// A triangle with corners a, b, c.
struct Corners {
    Vec3d a, b, c;
};

// All places within `radius` of a core: one to three points, a box, or a cylinder along the z axis of its
// pose. A sphere is a point with a radius, a capsule two points.
struct Convex {
    enum class Core { points, box, cylinder };
    Core core;
    double radius;
    Posed pose;  // of a box or cylinder
    Vec3d half;  // half sides of a box; of a cylinder its radius twice, and half its length
    Vec3d points[3];
    int n_points;
};

// normal: the unit gradient with respect to a translation of the first solid. first, second: the places that
// are nearest to each other or, inside, deepest; the distance along the normal is theirs.
struct ConvexDistance {
    double value;
    Vec3d normal, first, second;
};

}  // namespace cspace::shapes
