// Three joints that turn and three that slide, in any order: the turns alone make the orientation, in up to
// two ways, and the slides then follow from three linear equations.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/ik/general/three_revolutes.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::ik {

struct OrientationFirst {
    int turn[3], slide[3];
    ThreeTurns turns;
};

struct TwoOrientations {
    int count = 0;
    double q[2][6];
    double inside, volume;  // see TurnedTwice; of the slides' directions, the lesser of both
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline OrientationFirst orientation_first(const Chain& chain) {
    OrientationFirst out;
    int turns = 0, slides = 0;
    for (int i = 0; i < 6; ++i) {
        if (chain.prismatic[i])
            out.slide[slides++] = i;
        else
            out.turn[turns++] = i;
    }
    out.turns = three_turns(chain.axis[out.turn[0]], chain.axis[out.turn[1]], chain.axis[out.turn[2]]);
    return out;
}

// The slides that bring the tip to the goal, the turns being as in q.
inline bool solve_slides(const Chain& chain, const OrientationFirst& arm, const Posed& goal, double* q,
                         double& volume) {
    for (const int i : arm.slide) q[i] = 0;
    Vec3d D[3];
    int slides = 0;
    const auto keep_direction = [&](int i, const Vec3d& axis, const Vec3d&) {
        if (chain.prismatic[i]) D[slides++] = axis;
    };
    const Vec3d gap = goal.t - (move_joints(chain, 6, q, keep_direction) * chain.tip).t;
    volume = min(volume, std::fabs(dot(D[0], cross(D[1], D[2]))));
    double A[3][3], b[3] = {gap.x, gap.y, gap.z};
    for (int j = 0; j < 3; ++j) A[0][j] = D[j].x, A[1][j] = D[j].y, A[2][j] = D[j].z;
    const bool regular = solve_linear(A, b);
    for (int j = 0; j < 3; ++j) q[arm.slide[j]] = b[j];
    return regular;
}

inline TwoOrientations two_orientations(const Chain& chain, const OrientationFirst& arm, const Posed& goal) {
    const TurnedTwice turned = solve(arm.turns, goal.R * transpose(chain.tip.R));
    TwoOrientations out;
    out.inside = turned.inside;
    out.volume = 1;
    for (int k = 0; k < turned.count; ++k) {
        double* const q = out.q[out.count];
        for (int i = 0; i < 3; ++i) q[arm.turn[i]] = turned.q[k][i];
        out.count += solve_slides(chain, arm, goal, q, out.volume);
    }
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
