// Locking joints of an arm so that the other joints can be solved. Locked joints at either end of the chain
// only move the goal. A locked joint between moving joints changes a link.
#pragma once

#include "cspace/ik/arm.hpp"
#include "cspace/ik/fast_path.hpp"

namespace cspace::ik {

inline constexpr int max_moving = 6;

struct LockedArm {
    Chain whole;
    int locked_joint[max_joints], moving[max_joints];
    int n_locked = 0, n_moving = 0;
    bool at_ends = true;  // the joints that move follow one another
    Arm arm;              // of those that move; the held ones at zero, or at typical values if not at_ends
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline bool is_solvable(const Arm& arm) { return arm.has_plan || arm.has_few_joints || arm.is_general; }

// The chain of the moving joints. `at`: the value of every locked joint, by its number in the whole chain.
inline Chain locked_chain(const LockedArm& locked, const double* at) {
    const Chain& whole = locked.whole;
    Chain out;
    Posed before = identity_pose();
    int next = 0;
    for (int i = 0; i < whole.n; ++i) {
        if (next < locked.n_locked && locked.locked_joint[next] == i) {
            before = before * joint_motion(whole, i, at[i]);
            ++next;
            continue;
        }
        out.axis[out.n] = before.R * whole.axis[i];
        out.point[out.n] = before * whole.point[i];
        out.prismatic[out.n++] = whole.prismatic[i];
    }
    out.tip = before * whole.tip;
    return out;
}

// locked_joint: the numbers of the joints to lock, ascending. typical: a generic value for each joint of the
// chain.
CSPACE_ONCE LockedArm lock_joints(const Chain& whole, const int* locked_joint, int n_locked,
                                  const double* typical, bool with_general = true) {
    LockedArm out;
    out.whole = whole;
    out.n_locked = n_locked;
    for (int k = 0; k < n_locked; ++k) out.locked_joint[k] = locked_joint[k];
    for (int i = 0, k = 0; i < whole.n; ++i) {
        if (k < n_locked && locked_joint[k] == i)
            ++k;
        else
            out.moving[out.n_moving++] = i;
    }
    if (out.n_moving > max_moving || out.n_moving == 0) return out;
    out.at_ends = out.moving[out.n_moving - 1] - out.moving[0] == out.n_moving - 1;
    const double zero[max_joints] = {};
    out.arm = make_arm(locked_chain(out, out.at_ends ? zero : typical), with_general);
    return out;
}

// The goal of an arm whose locked joints are at its ends. Locked joints at the front move the base, those at
// the back move the tip.
template <class V>
CSPACE_INLINE Pose<V> goal_between_ends(const LockedArm& locked, const Pose<V>& goal, const V* at) {
    const Chain& whole = locked.whole;
    const Posed& tip = whole.tip;
    Pose<V> out = goal;
    int last = locked.n_locked;
    for (int k = 0; k < locked.n_locked && locked.locked_joint[k] < locked.moving[0]; ++k)
        out = joint_motion<V>(whole, locked.locked_joint[k], -at[locked.locked_joint[k]]) * out;
    if (last == 0 || locked.locked_joint[last - 1] < locked.moving[0]) return out;
    out = out * fill_pose<V>(inverse(tip));
    for (; last > 0 && locked.locked_joint[last - 1] > locked.moving[0]; --last)
        out = out * joint_motion<V>(whole, locked.locked_joint[last - 1], -at[locked.locked_joint[last - 1]]);
    return out * fill_pose<V>(tip);
}

// The arm with the inner locked joints at these values. A general arm keeps the order of formulations of its
// typical values, because ranking them takes a thousand times as long as using them.
inline Arm arm_at(const LockedArm& locked, const double* at) {
    const Chain chain = locked_chain(locked, at);
    if (!locked.arm.is_general) return make_arm(chain);
    Arm arm;
    arm.has_plan = make_plan(arm.plan, chain);
    if (arm.has_plan && !arm.plan.idealised) return arm;
    arm.plan.form.length = characteristic_length(chain);
    arm.is_general = renumber_general_arm(locked.arm.general, chain, arm.general);
    return arm;
}

// By the closed form alone where it certifies its result.
CSPACE_ONCE Solutions solve_arm_quickly(const Arm& arm, const Posed& goal) {
    Solutions out;
    if (arm.has_plan) {
        double T[16], q[max_branches * 6];
        kinematics::write_matrix(goal, T);
        if (solve_fast_path(arm.plan, T, q, out.branch, &out.count) == FastPath::settled) {
            out.status = out.count ? Status::exact : Status::unreachable;
            for (int k = 0; k < out.count; ++k) {
                for (int i = 0; i < 6; ++i) out.q[k][i] = q[6 * k + i];
                out.self_motion[k] = false;
            }
            return out;
        }
        out.count = 0;
    }
    return solve_pose(arm, goal, nullptr);
}

inline Solutions solve_arm(const Arm& arm, const Posed& goal, const double* unconstrained) {
    if (!unconstrained && arm.has_plan) return solve_arm_quickly(arm, goal);
    if (is_solvable(arm)) return solve_pose(arm, goal, unconstrained);
    // By descent from configurations over all joints. What it finds may be members of a self-motion.
    constexpr int starts = 48;
    const Chain& chain = arm.plan.chain;
    Solutions out;
    out.complete = false;
    search_by_descent(chain, goal, characteristic_length(chain), starts, out);
    return out;
}

// The same where a certified list is enough, empty or not: no second look at what is hard to see.
inline Solutions solve_arm_briefly(const Arm& arm, const Posed& goal) {
    if (!arm.is_general || arm.has_plan || arm.plan.chain.n != 6 || arm.general.plan.slides > 0)
        return solve_arm(arm, goal, nullptr);
    Solutions out;
    arm.general.solve(arm.general, {goal.R, (1 / arm.general.plan.length) * goal.t}, out);
    return out.complete && !out.crowded ? out : solve_arm(arm, goal, nullptr);
}

// Every solution of the moving joints, with the locked joints at their values `at`. unconstrained (null, or
// of the whole chain): the values of joints that the goal leaves free.
CSPACE_ONCE Solutions solve_locked(const LockedArm& locked, const Posed& goal, const double* at,
                                   const double* unconstrained) {
    double rest[max_joints] = {};
    for (int k = 0; unconstrained && k < locked.n_moving; ++k) rest[k] = unconstrained[locked.moving[k]];
    if (locked.at_ends)
        return solve_arm(locked.arm, goal_between_ends(locked, goal, at), unconstrained ? rest : nullptr);
    return solve_arm(arm_at(locked, at), goal, unconstrained ? rest : nullptr);
}

// A row of the whole chain from the moving joints and the locked joints.
inline void whole_row(const LockedArm& locked, const double* at, const double* row, double* q) {
    for (int k = 0; k < locked.n_locked; ++k) q[locked.locked_joint[k]] = at[locked.locked_joint[k]];
    for (int k = 0; k < locked.n_moving; ++k) q[locked.moving[k]] = row[k];
}

}  // namespace cspace::ik::inline CSPACE_ISA
