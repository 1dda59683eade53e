// A solver for one arm: its plan, and the functions that are independent of the instruction set.
#pragma once

#include "cspace/ik/general/singular.hpp"
#include "cspace/ik/near_singular.hpp"
#include "cspace/ik/nearest_pose.hpp"
#include "cspace/ik/position/pose.hpp"
#include "cspace/ik/position/solve.hpp"
#include "cspace/ik/reach_bounds.hpp"
#include "cspace/ik/self_motion/bifurcations.hpp"
#include "cspace/ik/virtual_joints.hpp"

namespace cspace::ik {

struct Arm {
    Plan plan;                    // plan.chain is the arm, plan or no plan
    GeneralArm general;           // of the others, and of arms whose closed form idealises them
    bool has_plan = false;        // four to six revolute joints with a closed form
    bool has_few_joints = false;  // up to three joints of any kind, solved directly
    bool is_general = false;      // up to six joints of any kind for which the closed form does not suffice
};

// Maximum number of solutions of a goal.
inline int room_for(const Arm& arm) { return arm.is_general ? max_solutions : max_branches; }

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// with_general: whether arms in general position are planned too, which takes milliseconds.
CSPACE_ONCE Arm make_arm(const Chain& chain, bool with_general = true) {
    Arm arm;
    arm.has_plan = make_plan(arm.plan, chain);
    arm.has_few_joints = chain.n <= max_position_joints;
    if (!arm.has_plan) arm.plan.form.length = characteristic_length(chain);
    if (!arm.has_plan && !arm.has_few_joints && chain.n <= 6)
        arm.is_general = with_general && make_general_arm(chain, arm.general);
    // Behind a form that idealises visibly stands the arm itself; neighbours would idealise it once more.
    if (arm.has_plan && arm.plan.form.deviation > tolerance::visible_deviation && chain.n == 6) {
        arm.general.alone = true;
        arm.is_general = with_general && make_general_arm(chain, arm.general) && arm.general.plan.regular > 0;
    }
    return arm;
}

// Refines the solutions of an arm with few joints to rounding.
inline void refine_few_joints(const Chain& chain, const Posed& goal, double length, Solutions& out) {
    for (int k = 0; k < out.count; ++k) {
        double q[max_joints];
        for (int i = 0; i < chain.n; ++i) q[i] = out.q[k][i];
        PoseError error;
        measure_error(chain, goal, length, q, error);
        if (size_of_error(error) <= tolerance::exact) continue;
        refine_solution(chain, goal, length, q, error, 10);
        for (int i = 0; i < chain.n; ++i) out.q[k][i] = wrap_joint(chain, i, q[i]);
    }
}

// Solves an arm whose closed form idealises it: by elimination, and by both methods where elimination or the
// closed form is uncertain. Closer to a fold than the idealisation moves it, both methods may miss the same
// pair. Elsewhere both lists agree if they are complete.
inline Solutions solve_both_ways(const Arm& arm, const Posed& goal, const double* unconstrained) {
    const Posed goal_form = goal_in_form(arm.plan, goal);
    Solutions out = solve_general_carefully(arm.general, goal, unconstrained);
    if (!out.complete || solve_closed_form(arm.plan, goal_form, closed_form_settings(arm.plan)).doubt) {
        const int alone = out.count;
        const Solutions form = solve_carefully(arm.plan, goal, unconstrained);
        for (int k = 0; k < form.count; ++k) {
            double q[max_joints];
            for (int i = 0; i < 6; ++i) q[i] = form.q[k][i];
            accept_solution(out, arm.plan.chain, goal, arm.plan.form.length, q, form.branch[k], 2);
        }
        ClosedFormSettings settings;
        settings.band = 2 * arm.plan.form.deviation;
        const bool agree = form.count == alone && alone % 2 == 0;
        const bool certain =
            out.complete || (agree && !solve_closed_form(arm.plan, goal_form, settings).doubt);
        out.complete = certain && out.count == alone;
    }
    number_by_branches(arm.plan, goal, out);
    return out;
}

// By the closed form at perturbed goals near this one, if they leave the virtual joints in place.
inline bool search_perturbed_goals_in_form(const Plan& plan, const Posed& goal, Solutions& out) {
    const auto list_solutions = [&](const Posed& beside, const auto& add_candidate) {
        const Branches<double> b =
            solve_closed_form(plan, goal_in_form(plan, beside), closed_form_settings(plan));
        for (int k = 0; k < max_branches; ++k) {
            if (!b.ok[k]) continue;
            double q[max_joints] = {};
            configuration_of(plan, b.t[k], q);
            add_candidate(q);
        }
    };
    return search_perturbed_goals(plan.chain, goal, plan.form.length, list_solutions, out);
}

// Arms that can place their tip in every orientation need no reach test.
inline bool is_limited(const Arm& arm) {
    return arm.plan.chain.n < 6 || (arm.is_general && arm.general.plan.slides > 0);
}

inline Solutions solutions_and_self_motions(const Arm& arm, const Posed& goal, const double* unconstrained) {
    constexpr int starts = 12;
    const Chain& chain = arm.plan.chain;
    const double length = arm.plan.form.length;
    if (is_limited(arm) && exceeds_reach(chain, measure_reach(chain, length), goal)) return {};
    if (arm.is_general)
        return arm.has_plan ? solve_both_ways(arm, goal, unconstrained)
                            : solve_general_carefully(arm.general, goal, unconstrained);
    if (arm.has_plan) {
        Solutions out = solve_carefully(arm.plan, goal, unconstrained);
        // Where the completed arm is singular the arm itself need not be, and where a wrist is almost free
        // rounding may put a goal on the border out of reach.
        if ((arm.plan.virtual_joints == 0 && out.count > 0) ||
            !solve_closed_form(arm.plan, goal_in_form(arm.plan, goal), closed_form_settings(arm.plan)).doubt)
            return out;
        if (search_perturbed_goals_in_form(arm.plan, goal, out)) out.complete = false;
        if (out.count == 0) search_by_descent(chain, goal, length, 4 * starts, out);
        out.complete = out.complete && out.count > 0;
        return out;
    }
    Solutions out = solve_few_joint_pose(chain, goal);
    if (out.count == 0) search_by_descent(chain, goal, length, starts, out);
    refine_few_joints(chain, goal, length, out);
    return out;
}

CSPACE_ONCE Solutions solve_pose(const Arm& arm, const Posed& goal, const double* unconstrained) {
    const Chain& chain = arm.plan.chain;
    Solutions out = solutions_and_self_motions(arm, goal, unconstrained);
    if (chain.n > max_position_joints)
        look_along(chain, goal, arm.plan.form.length, unconstrained, room_for(arm), out);
    return out;
}

// Minimises (‖Δp‖ / length)² + (weight · angle)². Weight 1 makes one radian equal to the size of the arm. A
// large weight keeps the orientation, and the result is the distance by which the goal is out of reach.
// Starts are the branches clipped at their boundaries, and configurations spread over the joints. A large
// weight is increased in steps, because the set of configurations with the required orientation is narrow.
inline NearestPose nearest_to_goal(const Arm& arm, const Posed& goal, double weight) {
    const Plan& plan = arm.plan;
    const int n = plan.chain.n;
    ClosedFormSettings settings;
    settings.band = std::numeric_limits<double>::infinity();
    Branches<double> b{};
    if (arm.has_plan) b = solve_closed_form(plan, goal_in_form(plan, goal), settings);
    NearestPose best;
    best.cost = std::numeric_limits<double>::infinity();
    constexpr int spread = 16;
    for (int k = 0; k < max_branches + spread; ++k) {
        double q[max_joints] = {};
        spread_configuration(k, n, q);
        for (int i = 0; arm.has_plan && i < 6 && k < max_branches; ++i)
            if (plan.joint[i] >= 0 && std::isfinite(b.t[k][i]))
                q[plan.joint[i]] = joint_angle(plan, i, b.t[k][i]);
        PoseError error;
        for (double w = min(weight, 1.0); w < weight; w *= 10)
            minimise_pose_error(plan.chain, goal, plan.form.length, w, q, error);
        const double cost = minimise_pose_error(plan.chain, goal, plan.form.length, weight, q, error);
        if (!(cost < best.cost)) continue;
        best.cost = cost;
        best.position = error.position;
        best.rotation = error.rotation;
        for (int i = 0; i < n; ++i) best.q[i] = wrap_joint(plan.chain, i, q[i]);
    }
    return best;
}

}  // namespace cspace::ik::inline CSPACE_ISA
