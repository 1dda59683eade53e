// Two Newton steps on the true chain, on lanes. They remove the error of a closed form for an idealised or
// ill-conditioned geometry. The second step shows whether the first has converged.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/math/linear.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// One step of q (n = 6) to the goal, shortened if a joint would rotate by more than `stride` [rad]. Returns
// the largest joint change of the full step. Prismatic joints are divided by `length`.
template <class V>
CSPACE_NOINLINE V newton_step(const Chain& chain, const Pose<V>& goal, double length, V* q,
                              double stride = 1e300) {
    Vec3<V> axis[6], point[6];
    const auto keep_axis = [&](int i, const Vec3<V>& h, const Vec3<V>& p) { axis[i] = h, point[i] = p; };
    const Pose<V> T = move_joints(chain, 6, q, keep_axis) * fill_pose<V>(chain.tip);
    const Vec3<V> dp = (1 / length) * (goal.t - T.t);
    const Vec3<V> w = spatial::sine_between(T.R, goal.R);
    V A[6][6], b[6] = {dp.x, dp.y, dp.z, w.x, w.y, w.z};
    for (int i = 0; i < 6; ++i) {
        const bool slides = chain.prismatic[i];
        const Vec3<V> v = slides ? axis[i] : (1 / length) * cross(axis[i], T.t - point[i]);
        const double turns = slides ? 0.0 : 1.0;
        const V col[6] = {v.x, v.y, v.z, turns * axis[i].x, turns * axis[i].y, turns * axis[i].z};
        for (int k = 0; k < 6; ++k) A[k][i] = col[k];
    }
    solve_linear(A, b);
    V largest = fill<V>(0.0);
    for (int i = 0; i < 6; ++i) largest = max(largest, abs(b[i]));
    const V keep = select(largest > stride, stride / largest, fill<V>(1.0));
    for (int i = 0; i < 6; ++i) q[i] = mul_add(chain.prismatic[i] ? length * keep : keep, b[i], q[i]);
    // Half a turn off, the sum of cross products vanishes as at the goal: nothing beyond a right angle has
    // settled.
    return select(spatial::trace_between(T.R, goal.R) < 1.0, max(largest, fill<V>(1.0)), largest);
}

// True if q, a candidate near a solution, has converged to it.
template <class V>
CSPACE_INLINE mask_of<V> polish(const Chain& chain, const Pose<V>& goal, double length, V* q) {
    const V first = newton_step(chain, goal, length, q);
    const V second = newton_step(chain, goal, length, q);
    return (first < tolerance::polish_reach) && (second < tolerance::polished);
}

}  // namespace cspace::ik::inline CSPACE_ISA
