// The closed forms of arms of six revolute joints: which one applies to an arm, and its evaluation, from the
// goal T_base_tip to the joint angles of every branch, on lanes.
#pragma once

#include <initializer_list>

#include "cspace/ik/dh_form.hpp"
#include "cspace/ik/parallel_general.hpp"
#include "cspace/ik/solution.hpp"
#include "cspace/ik/spherical_wrist.hpp"
#include "cspace/ik/three_parallel.hpp"

namespace cspace::ik {

enum class Family {
    none,
    spherical_wrist,  // the last three axes meet
    three_parallel,   // axes 2, 3, 4 are parallel, 5 and 6 meet
    middle_parallel,  // axes 2, 3, 4 are parallel, 5 and 6 do not meet
    first_parallel,   // axes 1, 2, 3 are parallel
};

// The solver's joints are those of the chain, possibly from tip to base. Some axes may be reversed so that
// parallel axes have the same direction, and virtual joints may be inserted to complete the arm to six.
struct Plan {
    Family family = Family::none;
    bool reversed = false;
    int joint[6];    // the chain's joint behind each of the solver's, or −1 for a virtual one
    double sign[6];  // +1, or −1 where the axis was turned round
    Chain chain;     // the arm as given, the truth for residuals
    DhForm form;
    SphericalWrist wrist;
    ThreeParallel parallel;
    Posed to_form_left, to_form_right;  // goal in the form: left · T (or T⁻¹) · right
    int virtual_joints = 0;
    bool on_lanes = false;   // the family has a kernel; the others are solved one goal at a time
    bool idealised = false;  // the form differs from the true geometry
    bool polish = false;     // its angles are corrected on the true chain
    Chain completed = {};    // the arm with its virtual joints; empty without
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Selects the closed form for an arm of six revolute joints, from its axes alone.

// Reverses axes so that adjacent parallel axes have the same direction.
inline Chain with_agreeing_axes(Chain chain, double* sign) {
    sign[0] = 1;
    for (int i = 1; i < chain.n; ++i) {
        const Vec3d across = cross(chain.axis[i - 1], chain.axis[i]);
        const bool opposed =
            norm(across) < tolerance::axis_relation && dot(chain.axis[i - 1], chain.axis[i]) < 0;
        sign[i] = opposed ? -1 : 1;
        if (opposed) chain.axis[i] = -chain.axis[i];
    }
    return chain;
}

inline Family recognise_family(const DhForm& f) {
    if (f.degenerate) return Family::none;
    const bool last_three_meet = f.meeting[3] && f.meeting[4] && f.d[4] == 0;
    if (last_three_meet && !(f.parallel[0] && f.parallel[1])) return Family::spherical_wrist;
    const bool middle_parallel = f.parallel[1] && f.parallel[2] && !f.parallel[0] && !f.parallel[3];
    if (middle_parallel && f.meeting[4]) return Family::three_parallel;
    if (middle_parallel && !f.parallel[4]) return Family::middle_parallel;
    const bool first_parallel = f.parallel[0] && f.parallel[1] && !f.parallel[2];
    if (first_parallel && !f.parallel[3] && !f.parallel[4]) return Family::first_parallel;
    return Family::none;
}

// Tries the six joints of `arm` in one direction; `plan.joint` must already contain their sources.
inline bool plan_in_direction(Plan& plan, const Chain& arm, bool backwards) {
    const Chain agreeing = with_agreeing_axes(backwards ? reverse_chain(arm) : arm, plan.sign);
    plan.form = dh_form(agreeing);
    plan.family = recognise_family(plan.form);
    if (plan.family == Family::none) return false;
    plan.reversed = backwards;
    if (plan.family == Family::spherical_wrist) plan.wrist = make_spherical_wrist(plan.form);
    if (plan.family == Family::three_parallel) plan.parallel = make_three_parallel(plan.form);
    plan.on_lanes = plan.family == Family::spherical_wrist || plan.family == Family::three_parallel;
    plan.to_form_left = inverse(plan.form.base);
    plan.to_form_right = inverse(plan.form.tool);
    const bool quartic =
        plan.family == Family::spherical_wrist && plan.wrist.first.kind == PieperCase::general;
    plan.idealised = plan.form.deviation > tolerance::geometry_exact;
    plan.polish = quartic || plan.idealised;
    return true;
}

// A plan for exactly six revolute joints.
inline bool plan_six(Plan& plan, const Chain& six, const int* source) {
    // A family with a kernel in either direction, before one without.
    for (const bool any_family : {false, true})
        for (const bool backwards : {false, true}) {
            for (int i = 0; i < 6; ++i) plan.joint[i] = source[backwards ? 5 - i : i];
            if (plan_in_direction(plan, six, backwards) && (any_family || plan.on_lanes)) return true;
        }
    plan.family = Family::none;
    return false;
}

// The goal in the frames of the closed form.
template <class V>
CSPACE_INLINE Pose<V> goal_in_form(const Plan& plan, const Pose<V>& T_base_tip) {
    const Pose<V> goal = plan.reversed ? inverse(T_base_tip) : T_base_tip;
    return fill_pose<V>(plan.to_form_left) * goal * fill_pose<V>(plan.to_form_right);
}

template <class V>
CSPACE_INLINE Branches<V> closed_form(const Plan& plan, const Pose<V>& goal,
                                      const ClosedFormSettings& settings) {
    if (plan.family == Family::three_parallel) return solve_three_parallel(plan.parallel, goal, settings);
    if constexpr (Lanes<V>::count == 1) {
        if (plan.family == Family::middle_parallel) return solve_middle_parallel(plan.form, goal, settings);
        if (plan.family == Family::first_parallel) return solve_first_parallel(plan.form, goal, settings);
    }
    return solve_spherical_wrist(plan.wrist, goal, settings);
}

// One goal on one lane, for the careful solvers.
CSPACE_ONCE Branches<double> solve_closed_form(const Plan& plan, const Posed& goal,
                                               const ClosedFormSettings& settings) {
    return closed_form(plan, goal, settings);
}

// The distance from a fold at which the closed form is reliable: an idealised geometry shifts the folds.
inline ClosedFormSettings closed_form_settings(const Plan& plan) {
    ClosedFormSettings settings;
    settings.band = max(tolerance::fold_band, 4 * plan.form.deviation);
    return settings;
}

// One goal, for the types of arm that have a kernel.
CSPACE_INLINE Abreast closed_form_abreast(const Plan& plan, const Posed& goal,
                                          const ClosedFormSettings& settings) {
    if (plan.family == Family::three_parallel) return solve_abreast(plan.parallel, goal, settings);
    return solve_abreast(plan.wrist, goal, settings);
}

// Converts an angle of the form to that of the joint, in (−π, π].
template <class V>
CSPACE_INLINE V joint_angle(const Plan& plan, int i, V t) {
    return wrap_once(plan.sign[i] * t - plan.sign[i] * plan.form.offset[i]);
}

}  // namespace cspace::ik::inline CSPACE_ISA
