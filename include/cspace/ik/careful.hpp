// The second look at a pose that the closed form alone cannot settle: two solutions about to merge, a joint
// that the pose leaves free, or an arm whose geometry the form idealises. Every candidate is refined on the
// true chain, judged by its residual, told from its twins by the conditioning, and tested for self-motion.
#pragma once

#include <initializer_list>

#include "cspace/ik/evaluate.hpp"
#include "cspace/ik/refine.hpp"
#include "cspace/ik/solution.hpp"

namespace cspace::inline CSPACE_ISA {

inline double wrapped_distance(const double* a, const double* b, int n) {
    double worst = 0;
    for (int i = 0; i < n; ++i) worst = max(worst, std::fabs(std::remainder(a[i] - b[i], 2 * pi)));
    return worst;
}

// Whether the arm can move along `direction` with its tip at rest: it goes a stride that way and comes back
// to the goal. In a family it has moved by about the stride, whatever the stride; at a fold it slides back,
// or over to a neighbouring solution, whose distance is one and the same.
inline bool moves_freely(const ik::Chain& chain, const Posed& goal, double length, const double* q,
                         const double* direction) {
    for (const double stride : {0.02, 0.05}) {
        bool moved_on = false;
        for (const double way : {stride, -stride}) {
            double moved[ik::max_joints], along = 0;
            for (int i = 0; i < chain.n; ++i) moved[i] = q[i] + way * direction[i];
            PoseError error;
            if (refine(chain, goal, length, moved, error) > 1e-12) continue;
            for (int i = 0; i < chain.n; ++i) along += (moved[i] - q[i]) * direction[i];
            moved_on = moved_on || along / way > 0.8;
        }
        if (!moved_on) return false;
    }
    return true;
}

// Adds q to the solutions unless it is no solution or already there.
inline void admit(ik::Solutions& out, const ik::Chain& chain, const Posed& goal, double length, double* q,
                  int branch) {
    PoseError error;
    const double size = refine(chain, goal, length, q, error);
    if (!(size <= tolerance::reached) || out.count == ik::max_solutions) return;
    const int weak = weakest(error.jacobian);
    const double conditioning = max(error.jacobian.sigma[weak], 1e-9);
    const double same = max(tolerance::same_solution, 10 * max(size, 1e-15) / conditioning);
    for (int k = 0; k < out.count; ++k)
        if (wrapped_distance(out.q[k], q, chain.n) < same) return;
    const int n = out.count++;
    for (int i = 0; i < chain.n; ++i) {
        out.q[n][i] = chain.prismatic[i] ? q[i] : wrap_once(std::remainder(q[i], 2 * pi));
        out.direction[n][i] = error.jacobian.v[weak][i];
    }
    out.branch[n] = static_cast<signed char>(branch);
    out.family[n] = error.jacobian.sigma[weak] < 1e-7 &&
                    moves_freely(chain, goal, length, out.q[n], error.jacobian.v[weak]);
}

// The plan's branches for one choice of idle joints, as configurations of the chain.
inline int candidates(const ik::Plan& plan, const Posed& goal_form, const Care& care, ik::Solutions& out,
                      const Posed& goal) {
    const Branches<double> b = closed_form(plan, goal_form, care);
    int tried = 0;
    for (int k = 0; k < max_branches; ++k) {
        if (!b.ok[k]) continue;
        double q[ik::max_joints] = {};
        bool real = true;
        for (int i = 0; i < 6; ++i) {
            const double angle = joint_angle(plan, i, b.t[k][i]);
            if (plan.joint[i] >= 0)
                q[plan.joint[i]] = angle;
            else
                real = real && std::fabs(angle) < 1e-3;
        }
        if (!real) continue;
        ++tried;
        admit(out, plan.chain, goal, plan.form.length, q, k);
    }
    return tried;
}

// `idle`: the angles of the chain's joints that free joints take.
inline ik::Solutions solve_carefully(const ik::Plan& plan, const Posed& goal, const double* idle) {
    ik::Solutions out;
    Care care;
    const double slack = 4 * plan.form.deviation;
    care.band = max(tolerance::fold_band, slack);
    double t[6];
    for (int i = 0; i < 6; ++i) {
        const double q = plan.joint[i] >= 0 && idle ? idle[plan.joint[i]] : 0.0;
        t[i] = plan.sign[i] * q + plan.form.offset[i];
        care.idle[i] = {std::cos(t[i]), std::sin(t[i])};
    }
    const Posed goal_form = goal_in_form(plan, goal);
    candidates(plan, goal_form, care, out, goal);
    if (plan.polish) {
        care.spread = slack;
        candidates(plan, goal_form, care, out, goal);
    }
    // A free wrist of the three-parallel class turns the planar arm's target: look for a turn that it can
    // reach.
    constexpr int turns = 128;
    for (int k = 1; plan.family == ik::Family::three_parallel && out.count == 0 && k <= turns; ++k) {
        const double turn = (k % 2 ? 1 : -1) * ((k + 1) / 2) * (2 * pi / turns);
        care.idle[3] = {std::cos(t[3] + turn), std::sin(t[3] + turn)};
        candidates(plan, goal_form, care, out, goal);
    }
    out.status = out.count == 0 ? ik::Status::unreachable : ik::Status::exact;
    for (int k = 0; k < out.count; ++k)
        if (out.family[k]) out.status = ik::Status::singular;
    return out;
}

}  // namespace cspace::inline CSPACE_ISA
