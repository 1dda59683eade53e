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
    const Chain& chain = plan.virtual_joints ? plan.completed : plan.chain;
    const mask_of<W> settled = polish_solution(chain, goal, plan.form.length, q);
    for (int i = 0; i < 6; ++i) q[i] = wrap_once(q[i]);
    return settled;
}

// Removes the virtual joints from the angles of eight branches of the completed arm. `ok`: those with them at
// zero, of those that were ok. False if a virtual joint is neither at zero nor clearly off it.
inline bool remove_virtual_joints(const Plan& plan, Pack<4> (&angles)[2][6], Mask<4> (&ok)[2]) {
    constexpr double zero = 3e-14, off = 1e-3;  // [rad]
    int column[6] = {};                         // of the completed arm, for each joint of the arm
    Pack<4> stray[2] = {fill_lanes<Pack<4>>(0), fill_lanes<Pack<4>>(0)};
    for (int i = 0; i < 6; ++i) {
        const int place = plan.reversed ? 5 - i : i;
        if (plan.joint[i] >= 0)
            column[plan.joint[i]] = place;
        else
            for (int e = 0; e < 2; ++e) stray[e] = max(stray[e], abs(angles[e][place]));
    }
    for (int e = 0; e < 2; ++e) {
        if (any(ok[e] && stray[e] > zero && stray[e] < off)) return false;
        ok[e] = ok[e] && stray[e] < off;
        for (int i = 0; i < plan.chain.n; ++i) angles[e][i] = angles[e][column[i]];
    }
    return true;
}

// T: 16 numbers, row-major. q receives up to max_branches rows of 6, and branch their numbers.
CSPACE_ONCE FastPath solve_fast_path(const Plan& plan, const double* T, double* q, signed char* branch,
                                     int* count) {
    const ReadGoal<double> goal = read_goal(T);
    *count = 0;
    if (!goal.is_pose) return FastPath::refused;
    if (!plan.on_lanes) return FastPath::doubtful;
    const Abreast found = closed_form_abreast(plan, goal_in_form(plan, goal.T), closed_form_settings(plan));
    if (found.doubt) return FastPath::doubtful;
    Pack<4> angles[2][6];
    for (int e = 0; e < 2; ++e)
        for (int i = 0; i < 6; ++i) {
            const int place = !plan.virtual_joints ? plan.joint[i] : plan.reversed ? 5 - i : i;
            angles[e][place] = joint_angle(plan, i, found.t[e][i]);
        }
    if (plan.polish)
        for (auto& row : angles)
            if (any(found.ok && !polished_angles(plan, fill_pose<Pack<4>>(goal.T), row)))
                return FastPath::doubtful;
    Mask<4> ok[2] = {found.ok, found.ok};
    if (plan.virtual_joints && !remove_virtual_joints(plan, angles, ok)) return FastPath::doubtful;
    // Branch 2 l + e is lane l of angles[e].
    for (int e = 0; e < 2; ++e) store_rows(angles[e], 6, q + 6 * e, 12, 4);
    const unsigned listed[2] = {bits_of(ok[0]), bits_of(ok[1])};
    if ((listed[0] & listed[1]) == 15) {
        for (int k = 0; k < max_branches; ++k) branch[k] = static_cast<signed char>(k);
        *count = max_branches;
        return FastPath::settled;
    }
    int n = 0;
    for (int k = 0; k < max_branches; ++k) {
        if (!(listed[k & 1] >> (k >> 1) & 1)) continue;
        if (n != k)
            for (int i = 0; i < 6; ++i) q[6 * n + i] = q[6 * k + i];
        branch[n++] = static_cast<signed char>(k);
    }
    *count = n;
    // Why an arm with fewer joints does not reach a goal is the careful solver's to say.
    return n == 0 && plan.virtual_joints ? FastPath::doubtful : FastPath::settled;
}

}  // namespace cspace::ik::inline CSPACE_ISA
