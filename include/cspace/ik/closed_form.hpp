// Evaluation of a closed form: from the goal T_base_tip to the joint angles of every branch, on lanes.
#pragma once

#include "cspace/ik/goal.hpp"
#include "cspace/ik/parallel_general.hpp"
#include "cspace/ik/plan.hpp"
#include "cspace/ik/refine.hpp"
#include "cspace/ik/solution.hpp"
#include "cspace/math/rows.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// The goal in the frames of the closed form.
template <class V>
CSPACE_INLINE Pose<V> goal_in_form(const Plan& plan, const Pose<V>& T_base_tip) {
    const Pose<V> goal = plan.reversed ? inverse(T_base_tip) : T_base_tip;
    return fill_pose<V>(plan.to_form_left) * goal * fill_pose<V>(plan.to_form_right);
}

template <class V>
CSPACE_INLINE Branches<V> closed_form(const Plan& plan, const Pose<V>& goal, const Care& care) {
    using Kind = FirstThree;
    if (plan.family == Family::three_parallel) return solve(plan.parallel, goal, care);
    if constexpr (Lanes<V>::count == 1) {
        if (plan.family == Family::middle_parallel) return solve_middle_parallel(plan.form, goal, care);
        if (plan.family == Family::first_parallel) return solve_first_parallel(plan.form, goal, care);
    }
    switch (plan.wrist.first.kind) {
        case Kind::last_parallel:
            return solve<Kind::last_parallel>(plan.wrist, goal, care);
        case Kind::first_meet:
            return solve<Kind::first_meet>(plan.wrist, goal, care);
        case Kind::last_meet:
            return solve<Kind::last_meet>(plan.wrist, goal, care);
        case Kind::first_parallel:
            return solve<Kind::first_parallel>(plan.wrist, goal, care);
        default:
            return solve<Kind::general>(plan.wrist, goal, care);
    }
}

// One goal on one lane, for the careful solvers.
CSPACE_ONCE Branches<double> solve_closed_form(const Plan& plan, const Posed& goal, const Care& care) {
    return closed_form(plan, goal, care);
}

// The distance from a fold at which the closed form is reliable: an idealised geometry shifts the folds.
inline Care care_of(const Plan& plan) {
    Care care;
    care.band = max(tolerance::fold_band, 4 * plan.form.deviation);
    return care;
}

// One goal, for the types of arm that have a kernel.
CSPACE_INLINE Abreast closed_form_abreast(const Plan& plan, const Posed& goal, const Care& care) {
    using Kind = FirstThree;
    if (plan.family == Family::three_parallel) return solve_abreast(plan.parallel, goal, care);
    switch (plan.wrist.first.kind) {
        case Kind::last_parallel:
            return solve_abreast<Kind::last_parallel>(plan.wrist, goal, care);
        case Kind::first_meet:
            return solve_abreast<Kind::first_meet>(plan.wrist, goal, care);
        case Kind::last_meet:
            return solve_abreast<Kind::last_meet>(plan.wrist, goal, care);
        case Kind::first_parallel:
            return solve_abreast<Kind::first_parallel>(plan.wrist, goal, care);
        default:
            return solve_abreast<Kind::general>(plan.wrist, goal, care);
    }
}

// Converts an angle of the form to that of the joint, in (−π, π].
template <class V>
CSPACE_INLINE V joint_angle(const Plan& plan, int i, V t) {
    return wrap_once(plan.sign[i] * t - plan.sign[i] * plan.form.offset[i]);
}

// Fast path for one goal: the closed form alone, with its branches on lanes. It solves most goals, and
// reports those that need the careful solver.

// Refines angles on the true chain; false if this did not converge.
template <class W>
CSPACE_INLINE mask_of<W> polished_angles(const Plan& plan, const Pose<W>& goal, W* q) {
    const mask_of<W> settled = polish(plan.chain, goal, plan.form.length, q);
    for (int i = 0; i < 6; ++i) q[i] = wrap_once(q[i]);
    return settled;
}

// T: 16 numbers, row-major. q receives up to max_branches rows of 6, and branch their numbers.
CSPACE_ONCE FastPath solve_quickly(const Plan& plan, const double* T, double* q, signed char* branch,
                                   int* count) {
    const ReadGoal<double> goal = read_goal(T);
    *count = 0;
    if (!goal.is_pose) return FastPath::refused;
    if (plan.virtual_joints || !plan.on_lanes) return FastPath::doubtful;
    const Abreast found = closed_form_abreast(plan, goal_in_form(plan, goal.T), care_of(plan));
    if (found.doubt) return FastPath::doubtful;
    Pack<4> angles[2][6];
    for (int e = 0; e < 2; ++e)
        for (int i = 0; i < 6; ++i) angles[e][plan.joint[i]] = joint_angle(plan, i, found.t[e][i]);
    if (plan.polish)
        for (int e = 0; e < 2; ++e)
            if (any(found.ok[e] && !polished_angles(plan, fill_pose<Pack<4>>(goal.T), angles[e])))
                return FastPath::doubtful;
    // Branch 2 l + e is lane l of angles[e].
    for (int e = 0; e < 2; ++e) store_rows(angles[e], 6, q + 6 * e, 12, 4);
    const unsigned ok[2] = {bits_of(found.ok[0]), bits_of(found.ok[1])};
    if ((ok[0] & ok[1]) == 15) {
        for (int k = 0; k < max_branches; ++k) branch[k] = static_cast<signed char>(k);
        *count = max_branches;
        return FastPath::settled;
    }
    int n = 0;
    for (int k = 0; k < max_branches; ++k) {
        if (!(ok[k & 1] >> (k >> 1) & 1)) continue;
        if (n != k)
            for (int i = 0; i < 6; ++i) q[6 * n + i] = q[6 * k + i];
        branch[n++] = static_cast<signed char>(k);
    }
    *count = n;
    return FastPath::settled;
}

}  // namespace cspace::ik::inline CSPACE_ISA
