// Three joints that turn, in any directions, make a rotation in up to two ways.
#pragma once

#include <initializer_list>

#include "cspace/math/turn.hpp"

namespace cspace::ik {

// R(h1, q1) R(h2, q2) R(h3, q3) = G; what h1 sees of h3 fixes q2:  a cos q2 + b sin q2 + constant = h1 G h3.
struct ThreeTurns {
    Vec3d h[3];
    double a, b, constant;
};

// `inside` is Δ = a² + b² − k² over a² + b²: negative without a solution, zero where two merge.
struct TurnedTwice {
    int count = 0;
    double q[2][3];
    double inside;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline ThreeTurns three_turns(const Vec3d& h1, const Vec3d& h2, const Vec3d& h3) {
    ThreeTurns out = {{h1, h2, h3}, 0, 0, dot(h1, h2) * dot(h2, h3)};
    out.a = dot(h1, h3) - out.constant;
    out.b = dot(h1, cross(h2, h3));
    return out;
}

// Whether they make more than a two-parameter set of rotations.
inline bool is_regular(const ThreeTurns& turns) { return turns.a * turns.a + turns.b * turns.b > 1e-12; }

// The angle about h that takes v to u, both at one angle from h.
inline double angle_between(const Vec3d& h, const Vec3d& v, const Vec3d& u) {
    return std::atan2(dot(h, cross(v, u)), dot(v, u) - dot(h, v) * dot(h, u));
}

inline TurnedTwice solve(const ThreeTurns& turns, const Mat3d& G) {
    constexpr double slack = 1e-9;  // a double solution may be lost by its square root
    TurnedTwice out;
    const Vec3d &h1 = turns.h[0], &h2 = turns.h[1], &h3 = turns.h[2], target = G * h3;
    const double square = turns.a * turns.a + turns.b * turns.b, k = dot(h1, target) - turns.constant;
    out.inside = (square - k * k) / square;
    if (!(out.inside > -slack)) return out;
    const double root = std::sqrt(max(out.inside, 0.0) / square), along = k / square;
    const Vec3d x = any_perpendicular(h3), moved_x = G * x;
    for (const double sign : {root, -root}) {
        const Turn<double> t2 = {turns.a * along - sign * turns.b, turns.b * along + sign * turns.a};
        double* const q = out.q[out.count++];
        q[0] = angle_between(h1, rotate(h2, t2, h3), target);
        q[1] = angle_of(t2);
        const Vec3d seen = rotate(h2, Turn<double>{t2.c, -t2.s}, rotate(h1, turn_by(-q[0]), moved_x));
        q[2] = angle_between(h3, x, seen);
        if (root == 0) break;
    }
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
