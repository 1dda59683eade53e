// The path of a point moved by one joint: a circle, or a line.
//
// A revolute joint moves x to C + cos q A + sin q B with C on its axis, A perpendicular to it, and B = h × A.
// A prismatic joint moves x to x + q h. On such a path a height n·x is linear, and a squared distance ‖x −
// o‖² is linear for the circle and quadratic for the line.
#pragma once

#include "cspace/math/turn.hpp"

namespace cspace::ik {

struct Curve {
    bool line;
    Vec3d c, a, b;
};
// f(q) = k + a cos q + b sin q on a circle, k + a q + square q² on a line.
struct OnCurve {
    bool line;
    double k, a, b, square;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// direction +1: x is moved by the joint, −1: by its inverse.
inline Curve curve_of(bool prismatic, const Vec3d& axis, const Vec3d& point, const Vec3d& x,
                      double direction) {
    if (prismatic) return {true, x, direction * axis, {0, 0, 0}};
    const Vec3d r = x - point, turned = cross(axis, r);
    return {false, point + dot(axis, r) * axis, -cross(axis, turned), direction * turned};
}
inline Vec3d at(const Curve& f, double q) {
    if (f.line) return f.c + q * f.a;
    double s, c;
    sincos(q, s, c);
    return f.c + c * f.a + s * f.b;
}
inline OnCurve height(const Curve& f, const Vec3d& n, const Vec3d& origin) {
    return {f.line, dot(n, f.c - origin), dot(n, f.a), dot(n, f.b), 0};
}
inline OnCurve squared_distance(const Curve& f, const Vec3d& origin) {
    const Vec3d r = f.c - origin;
    const double k = dot(r, r), a = 2 * dot(r, f.a), b = 2 * dot(r, f.b), own = dot(f.a, f.a);
    return f.line ? OnCurve{true, k, a, 0, own} : OnCurve{false, k + own, a, b, 0};
}

}  // namespace cspace::ik::inline CSPACE_ISA
