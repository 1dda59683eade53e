// Plain data of shapes: a distance with its gradient, and the corners of a triangle.
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

}  // namespace cspace::shapes
