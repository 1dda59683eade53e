// Three joints that turn and three that slide, in any order: the turns alone make the orientation, in up to
// two ways, and the slides then follow from three linear equations.
#pragma once

#include "cspace/ik/general/loop.hpp"
#include "cspace/ik/refine.hpp"
#include "cspace/math/linear.hpp"

namespace cspace {

// The joints that turn make R(h1, q1) R(h2, q2) R(h3, q3) = G; what h1 sees of h3 fixes q2:
//   a cos q2 + b sin q2 = k.
struct OrientationFirst {
    int turn[3], slide[3];
    Vec3d h[3];
    double a, b, constant;
};

// Up to two configurations; `inside` is Δ = a² + b² − k² over a² + b², negative without a solution.
struct TwoOrientations {
    int count = 0;
    double q[2][6];
    double inside, volume;  // volume: of the slides' directions, the least of both
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

inline OrientationFirst orientation_first(const ik::Chain& chain) {
    OrientationFirst out;
    int turns = 0, slides = 0;
    for (int i = 0; i < 6; ++i) {
        if (chain.prismatic[i])
            out.slide[slides++] = i;
        else
            out.turn[turns++] = i;
    }
    for (int i = 0; i < 3; ++i) out.h[i] = chain.axis[out.turn[i]];
    const Vec3d &h1 = out.h[0], &h2 = out.h[1], &h3 = out.h[2];
    out.constant = dot(h1, h2) * dot(h2, h3);
    out.a = dot(h1, h3) - out.constant;
    out.b = dot(h1, cross(h2, h3));
    return out;
}

// The angle about h that takes v to u, both at one angle from h.
inline double angle_between(const Vec3d& h, const Vec3d& v, const Vec3d& u) {
    return std::atan2(dot(h, cross(v, u)), dot(v, u) - dot(h, v) * dot(h, u));
}

// The slides that bring the tip to the goal, the turns being as in q.
inline bool solve_slides(const ik::Chain& chain, const OrientationFirst& arm, const Posed& goal, double* q,
                         double& volume) {
    double A[3][3], b[3];
    for (const int i : arm.slide) q[i] = 0;
    Posed T = identity_pose();
    Vec3d D[3];
    for (int i = 0, slides = 0; i < 6; ++i) {
        if (chain.prismatic[i]) D[slides++] = T.R * chain.axis[i];
        T = T * joint_motion(chain, i, q[i]);
    }
    const Vec3d gap = goal.t - (T * chain.tip).t;
    volume = min(volume, std::fabs(dot(D[0], cross(D[1], D[2]))));
    for (int j = 0; j < 3; ++j) A[0][j] = D[j].x, A[1][j] = D[j].y, A[2][j] = D[j].z;
    b[0] = gap.x, b[1] = gap.y, b[2] = gap.z;
    const bool regular = solve(A, b);
    for (int j = 0; j < 3; ++j) q[arm.slide[j]] = b[j];
    return regular;
}

inline TwoOrientations two_orientations(const ik::Chain& chain, const OrientationFirst& arm,
                                        const Posed& goal) {
    TwoOrientations out;
    out.volume = 1;
    const Mat3d G = goal.R * transpose(chain.tip.R);
    const Vec3d &h1 = arm.h[0], &h2 = arm.h[1], &h3 = arm.h[2], target = G * h3;
    const double square = arm.a * arm.a + arm.b * arm.b, k = dot(h1, target) - arm.constant;
    out.inside = (square - k * k) / square;
    if (!(out.inside > -1e-9)) return out;
    const double root = std::sqrt(max(out.inside, 0.0) / square), along = k / square;
    for (const double sign : {1.0, -1.0}) {
        const Turn<double> t2 = {arm.a * along - sign * arm.b * root, arm.b * along + sign * arm.a * root};
        const Vec3d seen = rotate(h2, t2, h3);
        double* const q = out.q[out.count];
        q[arm.turn[0]] = angle_between(h1, seen, target);
        q[arm.turn[1]] = angle_of(t2);
        const Vec3d x = any_perpendicular(h3);
        Vec3d moved = rotate(h1, turn_by(-q[arm.turn[0]]), G * x);
        moved = rotate(h2, Turn<double>{t2.c, -t2.s}, moved);
        q[arm.turn[2]] = angle_between(h3, x, moved);
        out.count += solve_slides(chain, arm, goal, q, out.volume);
        if (root == 0) break;
    }
    return out;
}

}  // namespace cspace::inline CSPACE_ISA
