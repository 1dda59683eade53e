// Intersections of the self-motion with the joint limits. Each joint is locked at each of its limits in turn,
// and the remaining six joints are solved. Every solution is an exact point of the boundary.
#pragma once

#include "cspace/ik/redundancy/redundant_arm.hpp"

namespace cspace::ik {

// Values of a joint at which closed arcs are looked for: of the parameter and of the freest joint, and of any
// other.
inline constexpr int loop_looks = 24, other_looks = 4;

// The arms with one joint locked, for arms with one redundant joint. They are built when intervals are first
// requested.
struct LimitArms {
    LockedArm locked[max_joints];
    // Where the joint stands between others: its arm at lower and upper limit, and where closed arcs are
    // looked for.
    Arm at_limit[max_joints][2];
    Arm at_look[max_joints][other_looks], at_freest[loop_looks];
    bool has_looks[max_joints] = {};
    bool rests[max_joints] = {};  // whether self-motions hardly move it
    int freest = -1;              // of the joints that nothing stops the one that self-motions move most
};

// A configuration with one joint at a limit and the others within theirs.
struct LimitPoint {
    int joint, side;  // 0 lower, 1 upper
    double q[max_joints];
};
struct LimitPoints {
    static constexpr int room = 192;
    int count = 0;
    bool complete = true;
    LimitPoint point[room];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline double limit_of(const Redundant& arm, int joint, int side) {
    return side ? arm.upper[joint] : arm.lower[joint];
}
inline bool has_limit(const Redundant& arm, int joint, int side) {
    return is_stopped(arm, joint) && std::isfinite(limit_of(arm, joint, side));
}

// Which joints the self-motion hardly moves, and of those without a stop the one that it moves most.
inline void find_freest_joint(const Redundant& arm, LimitArms& out) {
    constexpr int looks = 8;
    constexpr double hardly = 0.05;  // of the motion of the joint that moves most
    double moves[max_joints] = {}, most = 0;
    for (int look = 0; look < looks; ++look) {
        double q[max_joints];
        spread_configuration(look, arm.chain.n, q);
        PoseError at;
        measure_error(arm.chain, arm.chain.tip, arm.length, q, at);
        decompose_matrix(at.jacobian);
        const double* const along = at.jacobian.v[weakest_direction(at.jacobian)];
        for (int i = 0; i < arm.chain.n; ++i) moves[i] += std::fabs(along[i]);
    }
    for (int i = 0; i < arm.chain.n; ++i) {
        most = max(most, moves[i]);
        if (!is_stopped(arm, i) && (out.freest < 0 || moves[i] > moves[out.freest])) out.freest = i;
    }
    for (int i = 0; i < arm.chain.n; ++i) out.rests[i] = moves[i] < hardly * most;
}

inline int looks_at(const LimitArms& arms, int joint) {
    return joint == arms.freest ? loop_looks : other_looks;
}
inline const Arm& arm_of_look(const LimitArms& arms, int joint, int look) {
    return joint == arms.freest ? arms.at_freest[look] : arms.at_look[joint][look];
}
// The middle of a part of so many equal parts.
inline double middle_of_part(const Domain& domain, int part, int parts) {
    return domain.lower + (part + 0.5) / parts * (domain.upper - domain.lower);
}

// The arms with an inner revolute joint where closed arcs are looked for.
inline void make_look_arms(const Redundant& arm, int joint, LimitArms& out) {
    const int looks = looks_at(out, joint);
    const Domain domain = domain_of(arm, joint, arm.chain.tip);
    double at[max_joints];
    Arm* const made = joint == out.freest ? out.at_freest : out.at_look[joint];
    for (int look = 0; look < looks; ++look) {
        at[joint] = middle_of_part(domain, look, looks);
        made[look] = arm_at(out.locked[joint], at);
    }
    out.has_looks[joint] = true;
}

// out: as LimitArms{}. It is large, so the caller provides the memory.
inline void make_limit_arms(const Redundant& arm, LimitArms& out) {
    double at[max_joints];
    typical_values(arm, at);
    find_freest_joint(arm, out);
    for (int i = 0; i < arm.chain.n; ++i) {
        out.locked[i] = arm.locked.n_locked == 1 && arm.locked.locked_joint[0] == i
                            ? arm.locked
                            : lock_joints(arm.chain, &i, 1, at);
        for (int side = 0; side < 2 && !out.locked[i].at_ends; ++side) {
            if (!std::isfinite(limit_of(arm, i, side))) continue;
            double there[max_joints];
            there[i] = limit_of(arm, i, side);
            out.at_limit[i][side] = arm_at(out.locked[i], there);
        }
        const bool is_looked_at = !out.locked[i].at_ends && is_solvable(out.locked[i].arm) && !out.rests[i];
        if (is_looked_at && !arm.chain.prismatic[i]) make_look_arms(arm, i, out);
    }
}

// Adds the points with one joint at one of its limits.
inline void add_limit_points(const Redundant& arm, const LimitArms& arms, const Posed& goal, int joint,
                             int side, LimitPoints& out) {
    double at[max_joints] = {};
    at[joint] = limit_of(arm, joint, side);
    const LockedArm& locked = arms.locked[joint];
    const Arm& rest = locked.at_ends ? locked.arm : arms.at_limit[joint][side];
    // Six joints with one to spare among them: the joint rests there along every self-motion, and no branch
    // crosses its limit.
    if (!is_solvable(rest)) return;
    const Solutions found =
        solve_arm_quickly(rest, locked.at_ends ? goal_between_ends(locked, goal, at) : goal);
    out.complete = out.complete && found.complete;
    for (int j = 0; j < found.count; ++j) {
        LimitPoint point{joint, side, {}};
        whole_row(locked, at, found.q[j], point.q);
        if (!is_within(arm, point.q, limit_slack, joint)) continue;
        if (out.count == LimitPoints::room)
            out.complete = false;
        else
            out.point[out.count++] = point;
    }
}

// counts(joint, side): which limits.
template <class Counts>
inline void find_limit_points(const Redundant& arm, const LimitArms& arms, const Posed& goal,
                              LimitPoints& out, const Counts& counts) {
    for (int joint = 0; joint < arm.chain.n; ++joint)
        for (int side = 0; side < 2; ++side)
            if (counts(joint, side)) add_limit_points(arm, arms, goal, joint, side, out);
}
// All limits that stop a joint. Joint `except` is left out (−1: none).
inline void find_limit_points(const Redundant& arm, const LimitArms& arms, const Posed& goal, int except,
                              LimitPoints& out) {
    find_limit_points(arm, arms, goal, out,
                      [&](int joint, int side) { return joint != except && has_limit(arm, joint, side); });
}

}  // namespace cspace::ik::inline CSPACE_ISA
