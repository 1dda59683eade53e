// The nearest configuration within limits where several joints are redundant: Newton's method with an active
// set (Nocedal & Wright 2006, chapter 16). A joint that leaves its limits is frozen at the limit. It is freed
// again where the multiplier of its limit has the wrong sign.
#pragma once

#include "cspace/ik/redundancy/limits.hpp"
#include "cspace/ik/redundancy/nearest_step.hpp"

namespace cspace::ik {

// q and its gaps from the seed count on without multiples of 2π, so that a joint meets its limits as it is.
struct ActiveSet {
    double q[max_joints], weight[max_joints];
    unsigned frozen = 0;
    int count = 0;  // of frozen joints
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Runs Newton's method with the frozen joints where they are; false where it does not converge.
inline bool settle_free_joints(const Redundant& arm, const Posed& goal, const Target& target, ActiveSet& at,
                               TipMotion<double>& motion, double (&lambda)[6]) {
    const int n = arm.chain.n;
    Target here = target;
    for (int i = 0; i < n; ++i) {
        here.at[i] = at.q[i];
        here.shift[i] = at.frozen >> i & 1 ? 0 : at.q[i] - target.seed[i];
    }
    double step = 1;
    for (int k = 0; k < most_nearest_steps && step > settled_step; ++k)
        step = step_to_nearest<0>(arm.chain, arm.rank, goal, arm.length, here, at.weight, at.q, motion,
                                  lambda, at.frozen);
    tip_motion<0>(arm.chain, goal, arm.length, at.q, motion);
    return step <= settled_step && largest_of(motion.error, 6) < tolerance::reached && motion.aligned > 2;
}

// Freezes the free joint that is farthest outside its limits; false if all are within.
inline bool freeze_farthest(const Redundant& arm, ActiveSet& at) {
    int worst = -1;
    double most = limit_slack;
    for (int i = 0; i < arm.chain.n; ++i) {
        const double over = max(arm.lower[i] - at.q[i], at.q[i] - arm.upper[i]);
        if (at.frozen >> i & 1 || !(over > most)) continue;
        most = over;
        worst = i;
    }
    if (worst < 0) return false;
    at.q[worst] = limit_of(arm, worst, at.q[worst] > arm.upper[worst]);
    at.weight[worst] = 1;
    at.frozen |= 1u << worst;
    ++at.count;
    return true;
}

// Frees the frozen joint whose way inwards leads nearest to the seed; false if no such way does.
inline bool free_joint(const Redundant& arm, const Target& target, const TipMotion<double>& motion,
                       const double (&lambda)[6], ActiveSet& at) {
    constexpr double level = 1e-9;  // a multiplier that is zero up to rounding
    int best = -1;
    double most = level;
    for (int i = 0; i < arm.chain.n; ++i) {
        if (!(at.frozen >> i & 1)) continue;
        const double slope = arm.weight[i] * (at.q[i] - target.seed[i]) - dot_n(lambda, motion.column[i], 6);
        const double gain = at.q[i] < arm.upper[i] ? -slope : slope;
        if (!(gain > most)) continue;
        most = gain;
        best = i;
    }
    if (best < 0) return false;
    at.weight[best] = arm.weight[best];
    at.frozen &= ~(1u << best);
    --at.count;
    return true;
}

// Keeps the minimum that a start leads to, if it is nearer than the best one.
inline void settle_within_limits(const Redundant& arm, const Posed& goal, const Target& target,
                                 const double* start, Nearest& best) {
    constexpr int most_changes = 3 * max_joints;
    ActiveSet at;
    TipMotion<double> motion;
    double lambda[6];
    for (int i = 0; i < arm.chain.n; ++i) {
        at.q[i] = target.seed[i] + gap_from_seed(arm.chain, target, i, start[i]);
        at.weight[i] = arm.weight[i];
    }
    for (int change = 0; change < most_changes; ++change) {
        if (!settle_free_joints(arm, goal, target, at, motion, lambda)) return;
        if (freeze_farthest(arm, at)) {
            if (at.count > arm.redundancy_degree) return;
            continue;
        }
        double square = 0;
        for (int i = 0; i < arm.chain.n; ++i) {
            const double gap = at.q[i] - target.seed[i];
            square += arm.weight[i] * gap * gap;
        }
        keep_nearer(arm, at.q, std::sqrt(square), best);
        if (!free_joint(arm, target, motion, lambda, at)) return;
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
