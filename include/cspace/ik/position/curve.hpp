// The path of a point moved by one joint: a circle, or a line.
//
// A revolute joint moves x to C + cos q A + sin q B with C on its axis, A perpendicular to it, and B = h × A.
// A prismatic joint moves x to x + q h. On such a path a height n·x is linear, and a squared distance ‖x −
// o‖² is linear for the circle and quadratic for the line.
#pragma once

#include "cspace/ik/subproblems/two_angles.hpp"
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

struct PairCandidates {
    int count = 0;
    double first[48], last[48];
    int stage[48];  // 0: from the conditions; later ones represent self-motions
    int now = 0;
    int on_axis = -1;  // the one where both points may lie on the axis between
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
inline Vec3d point_at(const Curve& f, double q) {
    if (f.line) return f.c + q * f.a;
    double s, c;
    sincos(q, s, c);
    return f.c + c * f.a + s * f.b;
}
inline OnCurve height_along(const Curve& f, const Vec3d& n, const Vec3d& origin) {
    return {f.line, dot(n, f.c - origin), dot(n, f.a), dot(n, f.b), 0};
}
inline OnCurve squared_distance(const Curve& f, const Vec3d& origin) {
    const Vec3d r = f.c - origin;
    const double k = dot(r, r), a = 2 * dot(r, f.a), b = 2 * dot(r, f.b), own = dot(f.a, f.a);
    return f.line ? OnCurve{true, k, a, 0, own} : OnCurve{false, k + own, a, b, 0};
}

// Values of the first and the last of three joints that satisfy one condition on both.

inline void add_pair(PairCandidates& found, double first, double last) {
    if (found.count == 48 || !std::isfinite(first) || !std::isfinite(last)) return;
    found.first[found.count] = first;
    found.stage[found.count] = found.now;
    found.last[found.count++] = last;
}

namespace pair {

// The q with f(q) = target on a line: at most two. If a parabola does not reach the target, its vertex is
// returned.
inline int values_on_line(const OnCurve& f, double target, double* q) {
    const double k = f.k - target;
    if (std::fabs(f.square) <= tolerance::rounding) {
        if (std::fabs(f.a) <= tolerance::rounding) return 0;
        q[0] = -k / f.a;
        return 1;
    }
    const QuadraticRoots<double> r = quadratic_roots(f.square, f.a, k, 1.0);
    q[0] = r.x[0], q[1] = r.x[1];
    return r.two ? 2 : 1;
}
inline int values_on_circle(const OnCurve& f, double target, double* q) {
    const CosSinRoots<double> r = cos_sin_roots(f.a, f.b, target - f.k, 1.0);
    q[0] = angle_of(r.theta[0]), q[1] = angle_of(r.theta[1]);
    return r.two ? 2 : 1;
}
inline int values_on_curve(const OnCurve& f, double target, double* q) {
    return f.line ? values_on_line(f, target, q) : values_on_circle(f, target, q);
}
inline double value_at(const OnCurve& f, double q) {
    if (f.line) return f.k + q * (f.a + q * f.square);
    double s, c;
    sincos(q, s, c);
    return f.k + c * f.a + s * f.b;
}
inline double weight_of(const OnCurve& f) { return std::fabs(f.a) + std::fabs(f.b) + std::fabs(f.square); }

// The lowest point of a parabola, or zero.
inline double vertex_of(const OnCurve& f) { return f.line && f.square > 0 ? -f.a / (2 * f.square) : 0; }

}  // namespace pair

}  // namespace cspace::ik::inline CSPACE_ISA
