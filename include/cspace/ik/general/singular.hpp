// General arms at poses that leave them freedom: which of the solutions stand for a family.
#pragma once

#include "cspace/ik/general/plan.hpp"
#include "cspace/ik/self_motion.hpp"

namespace cspace::inline CSPACE_ISA {

// A family needs a direction in which the arm hardly moves its tip; only then is it worth a closer look.
inline void mark_families(const ik::GeneralPlan& plan, const Posed& goal, ik::Solutions& out) {
    constexpr double hardly = 1e-6;
    for (int k = 0; k < out.count; ++k) {
        PoseError error;
        measure(plan.chain, goal, 1, out.q[k], error);
        if (weak_direction(&error.jacobian.us[0]).sigma > hardly) continue;
        decompose(error.jacobian);
        out.family[k] =
            find_self_motion(plan.chain, goal, 1, out.q[k], error.jacobian, out.direction[k]);
        if (out.family[k]) out.status = ik::Status::singular;
    }
}

// Where the determinant vanishes all round the circle, a family runs through every hidden angle: its members
// are found by descent from configurations all over the joints.
inline void search_family(const ik::GeneralPlan& plan, const Posed& goal, ik::Solutions& out) {
    constexpr int starts = 48;
    for (int k = 0; k < starts && out.count < ik::max_solutions; ++k) {
        double q[ik::max_joints];
        spread_configuration(k, 6, q);
        PoseError error;
        if (refine(plan.chain, goal, 1, q, error) <= tolerance::reached)
            admit_polished(out, plan, goal, q);
    }
}

// Slides in metres again, and directions of length one.
inline void in_metres(const ik::GeneralPlan& plan, ik::Solutions& out) {
    if (plan.slides == 0) return;
    for (int k = 0; k < out.count; ++k) {
        double size = 0;
        for (int i = 0; i < 6; ++i) {
            if (plan.chain.prismatic[i]) {
                out.q[k][i] *= plan.length;
                out.direction[k][i] *= plan.length;
            }
            size += out.direction[k][i] * out.direction[k][i];
        }
        for (int i = 0; out.family[k] && i < 6; ++i) out.direction[k][i] /= std::sqrt(size);
    }
}

// goal: in metres, as is the answer.
inline ik::Solutions solve_general_carefully(const ik::GeneralPlan& plan, const Posed& goal_in_metres) {
    const Posed goal = {goal_in_metres.R, (1 / plan.length) * goal_in_metres.t};
    ik::Solutions out;
    plan.solve(plan, goal, out);
    if (out.crowded || !out.complete) {
        if (!out.complete && out.count == 0) search_family(plan, goal, out);
        out.status = out.count ? ik::Status::exact : ik::Status::unreachable;
        mark_families(plan, goal, out);
    }
    in_metres(plan, out);
    return out;
}

}  // namespace cspace::inline CSPACE_ISA
