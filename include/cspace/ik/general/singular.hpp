// General arms at poses that leave them freedom: which of the solutions stand for a self-motion.
#pragma once

#include "cspace/ik/general/representatives.hpp"
#include "cspace/ik/general/virtual_joints.hpp"
#include "cspace/ik/near_singular.hpp"
#include "cspace/ik/self_motion/self_motion.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// A self-motion needs a direction in which the arm hardly moves its tip; only then is it worth a closer look.
inline void mark_self_motions(const GeneralPlan& plan, const Posed& goal, Solutions& out) {
    constexpr double hardly = 1e-6;
    for (int k = 0; k < out.count; ++k) {
        PoseError error;
        measure_error(plan.chain, goal, 1, out.q[k], error);
        if (weak_direction(error.jacobian, hardly).sigma > hardly) continue;
        decompose_matrix(error.jacobian);
        out.self_motion[k] =
            find_self_motion(plan.chain, goal, 1, out.q[k], error.jacobian, out.direction[k]);
        if (out.self_motion[k]) out.status = Status::singular;
    }
}

// Slides in metres again, and directions of length one.
inline void in_metres(const Chain& chain, double length, Solutions& out) {
    for (int k = 0; k < out.count; ++k) {
        for (int i = 0; i < chain.n; ++i)
            if (chain.prismatic[i]) out.q[k][i] *= length;
        if (!out.self_motion[k]) continue;
        double* const d = out.direction[k];
        for (int i = 0; i < chain.n; ++i)
            if (chain.prismatic[i]) d[i] *= length;
        const double size = std::sqrt(dot_n(d, d, chain.n));
        for (int i = 0; i < chain.n; ++i) d[i] /= size;
    }
}

// Of the completed arm's solutions those with virtual joints at zero, on the arm itself.
inline Solutions without_virtual_joints(const Chain& chain, const Posed& goal, const Solutions& six) {
    constexpr double stray = 1e-3;  // rounding beside singularities of the completed arm
    Solutions out;
    out.complete = six.complete;
    out.crowded = six.crowded;
    for (int k = 0; k < six.count; ++k) {
        double q[max_joints], off = 0;
        for (int i = 0; i < 6; ++i) q[i] = six.q[k][i];
        for (int i = chain.n; i < 6; ++i) off = max(off, std::fabs(q[i]));
        if (off < stray) accept_solution(out, chain, goal, 1, q, out.count, 20);
    }
    return out;
}

// What a second look may still find where the solver did not certify its list, or where slides, wrists and
// virtual joints may hide a singular pose: from goals beside this one, and by descent. Lengths are over the
// arm's.
inline void look_at_perturbed_goals(const GeneralArm& arm, const Chain& chain, const Posed& goal,
                                    bool certain, Met& met, Solutions& out) {
    constexpr double hardly_off = 0.2;
    int there = 0;
    for (int k = 0; k < out.count; ++k) {
        PoseError error;
        measure_error(chain, goal, 1, out.q[k], error);
        if (out.conditioning[k] == 0 && chain.n == 6)
            out.conditioning[k] = weak_direction(error.jacobian).sigma;
    }
    const auto propose = [&](const Posed& beside, const auto& add_candidate) {
        Solutions six;
        arm.propose(arm, beside, six);
        for (int k = 0; k < six.count; ++k) {
            double off = 0, q[max_joints], turned[max_joints];
            for (int i = chain.n; i < 6; ++i) off = max(off, std::fabs(six.q[k][i]));
            there += off < hardly_off;
            for (int i = 0; i < chain.n; ++i) {
                q[i] = six.q[k][i];
                turned[i] = chain.prismatic[i] ? 0 : q[i];
            }
            add_candidate(q);
            // Slides that have become parallel run far away beside the goal.
            if (arm.plan.slides > 0) add_candidate(turned);
        }
    };
    if (search_perturbed_goals(chain, goal, 1, propose, out, &met, certain && out.count == 0))
        out.complete = false;
    // A wrist's list is complete but where solutions merge or joints are free, which goals nearby show.
    if (certain && there == 0 && arm.position_first.applies) return;
    // Self-motions attract whatever comes down near them.
    const int starts = out.count || certain ? 16 : 48;
    if (out.count == 0 || !certain) search_by_descent(chain, goal, 1, starts, out, max_solutions, &met);
    // Nothing here and something close by: the goal may lie just on the border.
    if (out.count == 0 && there > 0) out.complete = false;
}

// goal and `unconstrained`, the values that leading joints of self-motions take (null: zero): in metres, as
// is the answer.
inline Solutions solve_general_carefully(const GeneralArm& arm, const Posed& goal_in_metres,
                                         const double* unconstrained = nullptr) {
    const double length = arm.plan.length;
    const Posed goal = {goal_in_metres.R, (1 / length) * goal_in_metres.t};
    Chain chain = arm.plan.chain;
    chain.n = arm.chain.n;
    Solutions out;
    arm.solve(arm, goal, out);
    const bool certain = out.complete && !out.crowded, completed = chain.n < 6;
    if (completed) out = without_virtual_joints(chain, goal, out);
    // For six revolute joints a certified empty list is accepted, unless goals beside this one had to say so.
    const bool may_hide = completed || arm.plan.slides > 0;
    const bool empty = out.count == 0 && (may_hide || arm.has_perturbed || out.crowded);
    if (!certain && !completed) mark_self_motions(arm.plan, goal, out);
    double rest[max_joints];
    for (int i = 0; i < chain.n; ++i)
        rest[i] = unconstrained ? unconstrained[i] / (chain.prismatic[i] ? length : 1) : 0;
    Met met;
    if (out.status == Status::singular) keep_one_per_self_motion(chain, goal, rest, out, &met.curves);
    if (!out.complete || empty || (!certain && may_hide)) {
        const int before = out.count;
        look_at_perturbed_goals(arm, chain, goal, certain, met, out);
        if (out.count > before && out.status == Status::singular)
            keep_one_per_self_motion(chain, goal, rest, out);
    }
    if (arm.plan.slides > 0) in_metres(chain, length, out);
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
