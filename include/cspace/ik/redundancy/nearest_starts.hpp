// Starts of the search for the nearest configuration, and what they lead to: Newton's method on the distance
// and the pose, several starts at a time, or a descent along the curve.
#pragma once

#include <algorithm>

#include "cspace/ik/redundancy/active_set.hpp"
#include "cspace/ik/redundancy/nearest_step.hpp"
#include "cspace/math/turn.hpp"

namespace cspace::ik {

// The best starts so far, by distance from the seed. What a start leads to is hardly nearer than its bound.
struct Starts {
    static constexpr int room = 32;
    int count = 0;
    double q[room][max_joints];
    double distance[room], bound[room];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Whether the valley of a start may contain a point nearer than `nearest`, by its distance alone.
inline bool is_low_enough(double distance, double nearest) { return distance <= 1.5 * nearest + 0.2; }

// Adds a start. If there is no room, it replaces the worst one.
inline void add_start(const Redundant& arm, Starts& starts, const double* q, double distance,
                      double bound = 0) {
    int at = starts.count;
    if (at == Starts::room) {
        at = 0;
        for (int k = 1; k < Starts::room; ++k)
            if (starts.distance[k] > starts.distance[at]) at = k;
        if (distance >= starts.distance[at]) return;
    } else {
        ++starts.count;
    }
    for (int i = 0; i < arm.chain.n; ++i) starts.q[at][i] = q[i];
    starts.distance[at] = distance;
    starts.bound[at] = bound;
}

// Keeps a start unless it is worse than all others, or lies in the valley of a better one.
inline void keep_start(const Redundant& arm, Starts& starts, const double* q, double distance) {
    constexpr double valley = 0.4;
    if (!is_allowed(arm, q)) return;
    for (int k = 0; k < starts.count; ++k) {
        if (joint_gap(arm.chain, starts.q[k], q) > valley) continue;
        if (distance >= starts.distance[k]) return;
        for (int i = 0; i < arm.chain.n; ++i) starts.q[k][i] = q[i];
        starts.distance[k] = distance;
        starts.bound[k] = 0;
        return;
    }
    add_start(arm, starts, q, distance);
}

// Newton's method on as many starts as V has lanes; keeps the best result that converges. rank: of the
// Jacobian along the iterates.
template <int N, class V>
inline void settle_abreast(const Redundant& arm, int rank, const Posed& goal, const Target& target,
                           const double* const* starts, int count, Nearest& best) {
    V q[max_joints], step = fill_lanes<V>(1.0);
    for (int i = 0; i < arm.chain.n; ++i)
        for (int l = 0; l < Lanes<V>::count; ++l) set_lane(q[i], l, starts[l < count ? l : 0][i]);
    const Pose<V> goals = fill_pose<V>(goal);
    TipMotion<V> motion;
    V lambda[6];
    for (int k = 0; k < most_nearest_steps && any(step > settled_step); ++k)
        step = step_to_nearest<N>(arm.chain, rank, goals, arm.length, target, arm.weight, q, motion, lambda);
    tip_motion<N>(arm.chain, goals, arm.length, q, motion);
    double row[max_joints];
    for (int l = 0; l < count; ++l) {
        double error = 0;
        for (const V& e : motion.error) error = max(error, std::fabs(get_lane(e, l)));
        if (!(get_lane(step, l) <= settled_step) || !(error < tolerance::reached) ||
            !(get_lane(motion.aligned, l) > 2))
            continue;
        for (int i = 0; i < arm.chain.n; ++i) row[i] = get_lane(q[i], l);
        if (is_acceptable(arm, target, row))
            keep_nearer(arm, row, distance_from_seed(arm, target, row), best);
    }
}

// On lanes where the rank is full. Otherwise the selected pose coordinates differ from start to start.
inline void settle_all(const Redundant& arm, const Posed& goal, const Target& target,
                       const double* const* starts, int count, Nearest& best) {
    const bool full = arm.rank == 6;
    const int lanes = full ? 4 : 1;
    const auto settle = !full              ? settle_abreast<0, double>
                        : arm.chain.n == 7 ? settle_abreast<7, Pack<4>>
                                           : settle_abreast<0, Pack<4>>;
    for (int first = 0; first < count; first += lanes)
        settle(arm, arm.rank, goal, target, starts + first, std::min(lanes, count - first), best);
}

// Descends along the curve from a start, where Newton's method on the distance and the pose does not settle:
// in a valley that is narrow beside a singularity. Each step shortens the distance.
inline void descend_along_curve(const Redundant& arm, const Posed& goal, const Target& target,
                                const double* start, Nearest& best) {
    constexpr int most_steps = 60;
    constexpr double longest = 0.1, shortest = 1e-9, curved = 0.05;  // [rad, arm's lengths], curvature
    const int n = arm.chain.n;
    const auto onto = [&](CurvePoint& at) {
        for (int k = 0; k < 3; ++k) onto_curve(arm.chain, arm.rank, goal, arm.length, at);
    };
    CurvePoint at;
    for (int i = 0; i < n; ++i) at.q[i] = start[i];
    onto(at);
    double here = distance_from_seed(arm, target, at.q), stride = longest;
    for (int k = 0; k < most_steps && stride > shortest; ++k) {
        double gap[max_joints], along2 = 0;
        from_seed(arm.chain, target, arm.weight, at.q, gap);
        for (int i = 0; i < n; ++i) along2 += arm.weight[i] * at.tangent[i] * at.tangent[i];
        const double slope = dot_n(gap, at.tangent, n), curve = along2 + dot_n(gap, at.bend, n);
        const double newton = curve > curved ? -slope / curve : -std::copysign(stride, slope);
        const double step = max(-stride, min(stride, newton));
        if (std::fabs(step) < shortest) break;
        CurvePoint next;
        predict_along(at.q, at.tangent, at.bend, step, n, next.q);
        onto(next);
        const double there = distance_from_seed(arm, target, next.q);
        const bool shorter = next.error < tolerance::reached && there < here;
        stride = shorter ? min(2 * stride, longest) : 0.5 * std::fabs(step);
        if (!shorter) continue;
        at = next;
        here = there;
    }
    if (at.error < tolerance::reached && is_acceptable(arm, target, at.q)) keep_nearer(arm, at.q, here, best);
}

// Settles starts in the order of their distances, unless their bounds are above the best one.
inline void settle_in_order(const Redundant& arm, const Posed& goal, const Target& target,
                            const Starts& starts, double nearest, Nearest& best) {
    constexpr int abreast = 4;
    int order[Starts::room];
    for (int k = 0; k < starts.count; ++k) order[k] = k;
    std::sort(order, order + starts.count,
              [&](int a, int b) { return starts.distance[a] < starts.distance[b]; });
    for (int next = 0; next < starts.count;) {
        const double* chosen[abreast];
        int count = 0;
        for (; next < starts.count && count < abreast; ++next)
            if (is_low_enough(starts.distance[order[next]], nearest) &&
                starts.bound[order[next]] < best.distance)
                chosen[count++] = starts.q[order[next]];
        settle_all(arm, goal, target, chosen, count, best);
    }
}

// Refines the starts whose valley may contain a point below the best one. `also`: an additional start, on the
// manifold or off it. Within limits the bound is a limit's, and several redundant joints may end at limits.
inline void settle_starts(const Redundant& arm, const Posed& goal, const Target& target, const Starts& starts,
                          const double* also, Nearest& best) {
    double nearest = best.distance;
    for (int k = 0; k < starts.count && !target.within_limits; ++k)
        nearest = min(nearest, starts.distance[k]);
    if (target.within_limits && arm.redundancy_degree != 1) {
        if (also) settle_within_limits(arm, goal, target, also, best);
        for (int k = 0; k < starts.count; ++k)
            if (is_low_enough(starts.distance[k], nearest))
                settle_within_limits(arm, goal, target, starts.q[k], best);
        return;
    }
    if (also) settle_all(arm, goal, target, &also, 1, best);
    settle_in_order(arm, goal, target, starts, nearest, best);
    for (int k = 0; k < starts.count && arm.redundancy_degree == 1; ++k)
        if (starts.distance[k] < best.distance && is_acceptable(arm, target, starts.q[k]))
            descend_along_curve(arm, goal, target, starts.q[k], best);
}

// Starts at the seed and at two points along the curve on either side of it. Their distance from the seed is
// about that of the curve, because near a singularity the curve doubles back. Returns that distance.
inline double settle_around(const Redundant& arm, const Posed& goal, const Target& target, Nearest& best) {
    const int n = arm.chain.n;
    const double* const seed = target.seed;
    TipMotion<double> motion;
    SplitJacobian<double> split;
    double step[max_joints], along[max_joints], beside[3][max_joints];
    tip_motion<0>(arm.chain, goal, arm.length, seed, motion);
    split_jacobian<0>(motion, n, arm.rank, split);
    shortest_step<0>(split, n, motion.error, step);
    free_direction<0>(split, n, 0, along);
    const double off = std::sqrt(dot_n(step, step, n)), far = min(0.5, 1.5 * off);
    const double* starts[4] = {seed, beside[0], beside[1], beside[2]};
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < n; ++i)
            beside[k][i] = seed[i] + (k == 0 ? far : k == 1 ? -far : 2 * far) * along[i];
    settle_all(arm, goal, target, starts, 4, best);
    return off;
}

}  // namespace cspace::ik::inline CSPACE_ISA
