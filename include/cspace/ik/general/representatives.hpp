// One solution for each self-motion: those found on one curve are one, and stand where its leading joint is
// at an agreed value.
#pragma once

#include <algorithm>

#include "cspace/ik/near_singular.hpp"
#include "cspace/ik/self_motion/continuation.hpp"

namespace cspace::ik {

// The member of a self-motion at which its leading joint, the first that moves clearly, comes nearest to a
// value.
struct Representative {
    int joint = -1;
    double value = 0;
    double gap = 1e300;
    double q[max_joints] = {}, direction[max_joints] = {};
    double before[max_joints] = {};  // the member visited before, on the way `way`
    int way = -1;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline int leading_joint(const double* direction, int n) {
    constexpr double clearly = 0.1;
    for (int i = 0; i < n; ++i)
        if (std::fabs(direction[i]) > clearly) return i;
    return 0;
}

inline double from_value(const Chain& chain, const Representative& r, const double* q) {
    return joint_difference(chain, r.joint, q[r.joint] - r.value);
}

inline void offer_member(const Chain& chain, Representative& r, const double* q, const double* t) {
    const double gap = std::fabs(from_value(chain, r, q));
    if (!(gap < r.gap)) return;
    r.gap = gap;
    for (int i = 0; i < chain.n; ++i) {
        r.q[i] = q[i];
        r.direction[i] = t[i];
    }
}

// Between two members beside each other the leading joint passes its value: the member that has it, by the
// secant.
inline void offer_between(const Chain& chain, const TipConstraint& constraint, Representative& r,
                          const double* a, const double* b, const double* t) {
    double low = from_value(chain, r, a), high = from_value(chain, r, b), q[max_joints], left[max_joints];
    if (!(low * high < 0) || std::fabs(high - low) > 1) return;
    double right[max_joints];
    for (int i = 0; i < chain.n; ++i) left[i] = a[i], right[i] = b[i];
    for (int step = 0; step < 30; ++step) {
        const double part = low / (low - high);
        PoseError at;
        for (int i = 0; i < chain.n; ++i) q[i] = left[i] + part * (right[i] - left[i]);
        if (!onto_curve(chain, constraint, q, at)) return;
        const double here = from_value(chain, r, q);
        offer_member(chain, r, q, t);
        if (std::fabs(here) < tolerance::last_digits) return;
        const bool below = (here < 0) == (low < 0);
        (below ? low : high) = here;
        for (int i = 0; i < chain.n; ++i) (below ? left : right)[i] = q[i];
    }
}

// The next member on a way along the self-motion.
inline void offer_next(const Chain& chain, const TipConstraint& constraint, Representative& r, int way,
                       const double* q, const double* t) {
    offer_member(chain, r, q, t);
    if (way == r.way) offer_between(chain, constraint, r, r.before, q, t);
    r.way = way;
    for (int i = 0; i < chain.n; ++i) r.before[i] = q[i];
}

// Whether a solution lies on the curve within a step of its point q: the point of the curve beside it is the
// solution.
inline bool lies_near(const Chain& chain, const TipConstraint& constraint, const double* q, const double* t,
                      const double* other) {
    constexpr double reach = 1.2 * longest_step, narrow = 0.05;
    constexpr double rounding2 = 1e-12;  // square of what a solution itself may be off [rad]
    double at[max_joints], tangent[max_joints], next[max_joints];
    for (int i = 0; i < chain.n; ++i) at[i] = q[i], tangent[i] = t[i];
    for (int step = 0;; ++step) {
        double gap[max_joints];
        for (int i = 0; i < chain.n; ++i)
            gap[i] = joint_difference(chain, i, other[i] - at[i]) / unit_of(chain, i, constraint.length);
        const double along = dot_n(gap, tangent, chain.n), size2 = dot_n(gap, gap, chain.n);
        const double aside2 = size2 - along * along;
        if (!(size2 < reach * reach && aside2 < narrow * narrow * size2 + rounding2)) return false;
        if (step > 0 && aside2 < rounding2) return true;
        if (step == 4) return false;
        PoseError there;
        for (int i = 0; i < chain.n; ++i)
            next[i] = at[i] + along * unit_of(chain, i, constraint.length) * tangent[i];
        if (!onto_curve(chain, constraint, next, there) || !tangent_at(chain, there.jacobian, t, tangent))
            return false;
        for (int i = 0; i < chain.n; ++i) at[i] = next[i];
    }
}

// Marks the listed self-motions from row `first` on whose solution lies near the point q of a curve.
inline void mark_passed(const Chain& chain, const TipConstraint& constraint, const double* q, const double* t,
                        const Solutions& list, int first, bool* passed) {
    for (int m = first; m < list.count; ++m)
        passed[m] = passed[m] || (list.self_motion[m] && lies_near(chain, constraint, q, t, list.q[m]));
}

// Whether self-motions cross at q: there it has more directions than one.
inline bool is_crossing(const Chain& chain, const TipConstraint& constraint, const double* q) {
    constexpr double close = 1e-6;
    PoseError at;
    measure_constrained(chain, constraint, q, at);
    int free = 0;
    for (int i = 0; i < chain.n; ++i) free += at.jacobian.sigma[i] < close;
    return free > 1;
}

// Second derivatives of the pose are at most 6 [1/rad]: other solutions are a third of the smallest singular
// value across the curve away (as of listed_beside).
inline void note_followed(const Chain& chain, const double* q, const double* t, double margin,
                          FollowedCurves& followed) {
    constexpr double alone = 0.05;
    if (followed.count == FollowedCurves::room) return;
    const int n = followed.count++;
    std::copy(q, q + chain.n, followed.q[n]);
    std::copy(t, t + chain.n, followed.tangent[n]);
    followed.tube[n] = alone * margin;
}

// `unconstrained`: the values that leading joints take, zero if null; but where self-motions cross none is
// taken to the crossing, which would not tell which of them is meant. Lengths are over the arm's.
inline void keep_one_per_self_motion(const Chain& chain, const Posed& goal, const double* unconstrained,
                                     Solutions& out, FollowedCurves* followed = nullptr) {
    const TipConstraint constraint = {goal, true, 1};
    int steps_left = 4000;  // of all curves together
    bool dropped[max_solutions] = {};
    for (int k = 0; k < out.count; ++k) {
        if (!out.self_motion[k] || dropped[k] || steps_left <= 0) continue;
        Representative r;
        r.joint = leading_joint(out.direction[k], chain.n);
        r.value = unconstrained ? unconstrained[r.joint] : 0;
        double start[max_joints], along[max_joints];
        for (int i = 0; i < chain.n; ++i) start[i] = out.q[k][i], along[i] = out.direction[k][i];
        const auto visit = [&](int way, const double* q, const double* t, double margin) {
            if (followed) note_followed(chain, q, t, margin, *followed);
            offer_next(chain, constraint, r, way, q, t);
            mark_passed(chain, constraint, q, t, out, k + 1, dropped);
        };
        follow_self_motion(chain, constraint, start, along, steps_left, visit);
        if (is_crossing(chain, constraint, r.q) && !is_crossing(chain, constraint, start)) continue;
        for (int i = 0; i < chain.n; ++i) {
            out.q[k][i] = wrap_joint(chain, i, r.q[i]);
            out.direction[k][i] = r.direction[i];
        }
    }
    int kept = 0;
    for (int k = 0; k < out.count; ++k) {
        if (dropped[k]) continue;
        for (int i = 0; i < chain.n; ++i) {
            out.q[kept][i] = out.q[k][i];
            out.direction[kept][i] = out.direction[k][i];
        }
        out.conditioning[kept] = out.conditioning[k];
        out.branch[kept] = static_cast<signed char>(kept);
        out.self_motion[kept++] = out.self_motion[k];
    }
    out.count = kept;
}

}  // namespace cspace::ik::inline CSPACE_ISA
