// Fast path for one goal: the closed form alone, with its branches on lanes. It solves most goals, and
// reports those that need the careful solver.
#pragma once

#include "cspace/ik/closed_form.hpp"
#include "cspace/ik/goal.hpp"
#include "cspace/ik/refine.hpp"
#include "cspace/math/rows.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// Refines angles on the true chain; false if this did not converge.
template <class W>
CSPACE_INLINE mask_of<W> polished_angles(const Plan& plan, const Pose<W>& goal, W* q) {
    const mask_of<W> settled = polish_solution(plan.chain, goal, plan.form.length, q);
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
        for (auto& row : angles)
            if (any(found.ok && !polished_angles(plan, fill_pose<Pack<4>>(goal.T), row)))
                return FastPath::doubtful;
    // Branch 2 l + e is lane l of angles[e].
    for (int e = 0; e < 2; ++e) store_rows(angles[e], 6, q + 6 * e, 12, 4);
    const unsigned ok = bits_of(found.ok);
    if (ok == 15) {
        for (int k = 0; k < max_branches; ++k) branch[k] = static_cast<signed char>(k);
        *count = max_branches;
        return FastPath::settled;
    }
    int n = 0;
    for (int k = 0; k < max_branches; ++k) {
        if (!(ok >> (k >> 1) & 1)) continue;
        if (n != k)
            for (int i = 0; i < 6; ++i) q[6 * n + i] = q[6 * k + i];
        branch[n++] = static_cast<signed char>(k);
    }
    *count = n;
    return FastPath::settled;
}

}  // namespace cspace::ik::inline CSPACE_ISA
