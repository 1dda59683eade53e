// General arms at poses that leave them freedom: which of the solutions stand for a family.
#pragma once

#include "cspace/ik/general/plan.hpp"
#include "cspace/ik/self_motion.hpp"

namespace cspace::inline CSPACE_ISA {

// A family needs a direction in which the arm hardly moves its tip; only then is it worth a closer look.
inline void mark_families(const ik::GeneralPlan& plan, const Posed& goal, ik::Solutions& out) {
    constexpr double hardly = 1e-6;
    const double length = plan.frames.length;
    for (int k = 0; k < out.count; ++k) {
        PoseError error;
        measure(plan.chain, goal, length, out.q[k], error);
        if (weak_direction(&error.jacobian.us[0]).sigma > hardly) continue;
        decompose(error.jacobian);
        out.family[k] =
            find_self_motion(plan.chain, goal, length, out.q[k], error.jacobian, out.direction[k]);
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
        if (refine(plan.chain, goal, plan.frames.length, q, error) <= tolerance::reached)
            admit_polished(out, plan, goal, q);
    }
}

inline ik::Solutions solve_general_carefully(const ik::GeneralPlan& plan, const Posed& goal) {
    ik::Solutions out;
    plan.solve(plan, goal, out);
    if (!out.crowded && out.complete) return out;
    if (!out.complete && out.count == 0) search_family(plan, goal, out);
    out.status = out.count ? ik::Status::exact : ik::Status::unreachable;
    mark_families(plan, goal, out);
    return out;
}

}  // namespace cspace::inline CSPACE_ISA
