// Inverse kinematics of arms with one, two or three joints for a pose: every solution.
//
// The pose determines the motion G = T tip⁻¹ of the base frame. A revolute joint at the end of the chain
// leaves the points of its own axis fixed. The other joints alone must therefore move each of these points x
// to G x. This is a position goal with one joint less, and the last angle follows from the remaining
// rotation. Two points of the axis are tried, because one of them may lie on an adjacent axis. A revolute
// joint at the beginning is the end of the reversed arm. In arms with at most one revolute joint, its angle
// is that of G, and the prismatic joints follow linearly. All candidates are refined on position and rotation
// together, and kept if they satisfy both.
#pragma once

#include <initializer_list>

#include "cspace/ik/position/solve.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// The pose gap: the gap of the tip, and half the sum of g × r over the axes g of the goal and r of the tip,
// which is the rotation vector between them to first order.
template <int n>
struct PoseGap {
    static constexpr int angles = n, equations = 6;
    TipGap<n> tip;
    Mat3d R_tip, R_goal;
    bool prismatic[n];
    double reached;

    void operator()(const double* q, double* value, double (*slope)[n]) const {
        tip(q, value, slope);
        Mat3d R = R_tip;
        Vec3d axes[n];
        for (int i = n - 1; i >= 0; --i) {
            axes[i] = prismatic[i] ? Vec3d{0, 0, 0} : tip.axis[i];
            if (prismatic[i]) continue;
            const Turn<double> t = turn_by(q[i]);
            for (int j = i + 1; j < n; ++j) axes[j] = rotate_about(tip.axis[i], t, axes[j]);
            R = spatial::rotation_about(tip.axis[i], t.c, t.s) * R;
        }
        const Vec3d turn = spatial::sine_between(R_goal, R);
        value[3] = turn.x, value[4] = turn.y, value[5] = turn.z;
        for (int j = 0; j < n; ++j) slope[3][j] = axes[j].x, slope[4][j] = axes[j].y, slope[5][j] = axes[j].z;
    }
};

namespace few_joint_pose {

// The angle of R about h, if it is a rotation about h; otherwise the nearest one.
inline double angle_about(const Vec3d& h, const Mat3d& R) {
    const double trace = R.m[0][0] + R.m[1][1] + R.m[2][2];
    return std::atan2(2 * dot(h, spatial::sine_of(R)), trace - dot(h, R * h));
}

template <int n>
struct Search {
    const Chain& chain;
    const Posed& goal;
    PoseGap<n> gap;
    double size;
    PositionSolutions& found;

    // q in units of the chain; refined in units of its size. accurate: q is, if it is a solution.
    void add_candidate(const double* q, bool accurate = false) {
        double scaled[n];
        for (int i = 0; i < n; ++i) scaled[i] = chain.prismatic[i] ? q[i] / size : q[i];
        if (refine_angles(gap, scaled, 30, {accurate ? missed_by_far : any_miss, true}) > gap.reached) return;
        // Half a turn away from the goal the sum of g × r vanishes too.
        if (spatial::angle_between(forward_kinematics(chain, scaled).R, goal.R) <= 1)
            keep_distinct(gap, scaled, found);
    }
};

// Joint values for at most one revolute joint: its own from G, the prismatic joints by least squares.
template <int n>
void by_slides(Search<n>& search, const Posed& G) {
    double q[n] = {};
    for (int i = 0; i < n; ++i)
        if (!search.chain.prismatic[i]) q[i] = angle_about(search.chain.axis[i], G.R);
    for (int i = 0; i < n; ++i) q[i] = search.chain.prismatic[i] ? q[i] / search.size : q[i];
    nearest::slide(search.gap.tip, q);
    for (int i = 0; i < n; ++i) q[i] = search.chain.prismatic[i] ? q[i] * search.size : q[i];
    search.add_candidate(q);
}

// The last joint is revolute: the others move a point of its axis to its goal; a second one where they can
// move while the first rests.
template <int n>
void by_last_axis(const Chain& chain, const Posed& G, double size, bool backwards, Search<n>& search) {
    Chain others = chain;
    others.n = n - 1;
    const Vec3d h = chain.axis[n - 1];
    for (double along : {0.0, size}) {
        others.tip = {identity_pose().R, foot_of_tip(chain, n - 1) + along * h};
        const PositionSolutions placed = solve_position(others, G * others.tip.t, false);
        bool isolated = placed.count > 0;
        for (int k = 0; k < placed.count; ++k) {
            const bool accurate = !placed.self_motion[k] && !placed.close[k];
            isolated = isolated && accurate;
            double q[n];
            Posed rest = G;
            for (int i = 0; i < n - 1; ++i) {
                q[i] = placed.q[k][i];
                rest = joint_motion(chain, i, -q[i]) * rest;
            }
            q[n - 1] = angle_about(h, rest.R);
            double forwards[n];
            for (int i = 0; i < n; ++i) forwards[i] = q[backwards ? n - 1 - i : i];
            search.add_candidate(forwards, accurate);
        }
        if (isolated) return;
    }
}

template <int n>
void find_solutions(const Chain& chain, const Posed& T, PositionSolutions& found) {
    const PositionScale scale = position_scale(chain, T.t);
    PoseGap<n> gap{tip_gap<n>(chain, T.t, scale), chain.tip.R, T.R, {}, scale.reached};
    for (int i = 0; i < n; ++i) gap.prismatic[i] = chain.prismatic[i];
    Search<n> search{chain, T, gap, scale.size, found};
    int revolute = 0;
    for (int i = 0; i < n; ++i) revolute += !chain.prismatic[i];
    const Posed G = T * inverse(chain.tip);
    if (revolute < 2) by_slides(search, G);
    if constexpr (n > 1) {
        if (revolute > 1 && !chain.prismatic[n - 1]) {
            by_last_axis<n>(chain, G, scale.size, false, search);
        } else if (revolute > 1) {
            const Chain back = reverse_chain(chain);
            by_last_axis<n>(back, inverse(T) * inverse(back.tip), scale.size, true, search);
        }
    }
    for (int k = 0; k < found.count; ++k)
        for (int i = 0; i < n; ++i)
            if (chain.prismatic[i]) found.q[k][i] *= scale.size;
}

}  // namespace few_joint_pose

// Moves the tip of the chain (n ≤ 3) to T, in base coordinates.
inline Solutions solve_few_joint_pose(const Chain& chain, const Posed& T) {
    PositionSolutions found;
    if (chain.n == 1) few_joint_pose::find_solutions<1>(chain, T, found);
    if (chain.n == 2) few_joint_pose::find_solutions<2>(chain, T, found);
    if (chain.n == 3) few_joint_pose::find_solutions<3>(chain, T, found);
    return found;
}

}  // namespace cspace::ik::inline CSPACE_ISA
