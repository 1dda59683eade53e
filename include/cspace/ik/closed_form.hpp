// Evaluation of a closed form: from the goal T_base_tip to the joint angles of every branch, on lanes.
#pragma once

#include "cspace/ik/parallel_general.hpp"
#include "cspace/ik/plan.hpp"

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

}  // namespace cspace::ik::inline CSPACE_ISA
