// The nearest configuration of the whole self-motion manifold. Coarse samples over the locked joints give the
// starts, and Newton's method on the distance refines them. A weighted joint cannot be farther away than the
// best distance found so far. This bound reduces the search from a nearby seed to a few samples.
#pragma once

#include <algorithm>

#include "cspace/ik/redundancy/arcs.hpp"
#include "cspace/ik/redundancy/narrow_valleys.hpp"
#include "cspace/ik/redundancy/nearest_following.hpp"
#include "cspace/ik/redundancy/nearest_proof.hpp"
#include "cspace/ik/redundancy/nearest_starts.hpp"
#include "cspace/ik/redundancy/turning_points.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// The lowest samples of a curve within a window of the parameter, by a closed form on lanes.
inline void sample_window(const Redundant& arm, const Sweep& sweep, const Target& target,
                          const double* values, int count, const Window& window, const Nearest& best,
                          Starts& starts) {
    CurveSamples samples;
    add_samples(arm, sweep, values, nullptr, count, target, samples);
    if (has_changes(samples)) {
        const FoldValues folds = fold_values(arm, sweep);
        const Plan& plan = sweep.locked->arm.plan;
        const double closest = plan.idealised ? fuzz_of(plan) : limit_slack;
        double between[CurveSamples::room];
        const int n = values_between_folds(folds, closest, window.middle, window.half, between,
                                           CurveSamples::room - 64);
        if (n > 0) {
            samples.count = 0;
            add_samples(arm, sweep, between, nullptr, n, target, samples);
        }
    }
    divide_samples(arm, sweep, best.distance, target, samples);
    // Beside a limit there may be a nearer point.
    const bool is_minimum = std::isfinite(best.distance) && !target.within_limits;
    lowest_samples(arm, samples, is_minimum ? best.q : nullptr,
                   [&](const double* q, double d, double bound) { add_start(arm, starts, q, d, bound); });
}

// One redundant joint: starts at the seed, then at parameter values around the seed within the bound of the
// best solution.
inline void nearest_of_curve(const Redundant& arm, const Posed& goal, const Target& target, Nearest& best) {
    constexpr double spacing = 0.1;
    constexpr int most = 64;
    const int p = arm.locked.locked_joint[0];
    const bool slides = arm.chain.prismatic[p];
    const double off = settle_around(arm, goal, target, best);
    const Window window = window_of(arm, target, p, goal, best);
    const Sweep sweep = make_sweep(arm.locked, p, goal, target.seed);
    const double unit = slides ? 2 * window.half / most : spacing;
    const int count = int(max(4.0, min(double(most), std::ceil(2 * window.half / unit))));
    double values[most];
    for (int k = 0; k < count; ++k) values[k] = window.middle + window.half * ((2 * k + 1.0) / count - 1);
    Starts starts;
    if (sweep.on_lanes && !slides) {
        sample_window(arm, sweep, target, values, count, window, best, starts);
    } else {
        sweep_values(sweep, values, count, [&](int, const SweptRows& rows) {
            for (int k = 0; k < rows.count; ++k)
                keep_start(arm, starts, rows.q[k], distance_from_seed(arm, target, rows.q[k]));
        });
    }
    settle_starts(arm, goal, target, starts, nullptr, best);
    // Close by there is more than a curve where the tip cannot move as it should: axes in line, say.
    const double* const seed = target.seed;
    if (best.distance > 3 * off) settle_abreast<0, double>(arm, arm.rank - 1, goal, target, &seed, 1, best);
}

// Several redundant joints: the locked joints start at the seed, then at samples farther and farther from it.
inline void nearest_of_surface(const Redundant& arm, const Posed& goal, const Target& target, Nearest& best) {
    constexpr int most = 48;
    const LockedArm& locked = arm.locked;
    Starts starts;
    double at[max_joints], row[max_joints], spread[max_joints];
    for (int k = 0; k < most; ++k) {
        spread_configuration(k, arm.chain.n, spread);
        for (int i = 0; i < arm.chain.n; ++i) {
            const double reach = arm.chain.prismatic[i] ? arm.length / pi : 1;
            const double part = arm.weight[i] > 0 ? k / (most - 1.0) : (k > 0);
            at[i] = target.seed[i] + part * reach * spread[i];
        }
        const Solutions found = solve_locked(locked, goal, at, target.seed);
        for (int j = 0; j < found.count; ++j) {
            whole_row(locked, at, found.q[j], row);
            keep_start(arm, starts, row, distance_from_seed(arm, target, row));
        }
        if (k >= 12 && starts.count >= 12) break;
    }
    settle_starts(arm, goal, target, starts, target.seed, best);
}

// By descent from configurations around the seed, if no sample of the locked joints gave a solution.
inline void nearest_by_descent(const Redundant& arm, const Posed& goal, const Target& target, Nearest& best) {
    constexpr int most = 32;
    constexpr double on_floor = 1e-5;
    Starts starts;
    double q[max_joints];
    for (int k = 0; k < most; ++k) {
        spread_configuration(k, arm.chain.n, q);
        for (int i = 0; i < arm.chain.n; ++i)
            q[i] = target.seed[i] + (arm.chain.prismatic[i] ? arm.length / pi : k / (most - 1.0)) * q[i];
        PoseError error;
        double left = refine_solution(arm.chain, goal, arm.length, q, error);
        // On the floor of a valley that rounded axes have made: from there Newton's method goes along it.
        if (left > tolerance::reached && left < on_floor)
            left = refine_solution(arm.chain, goal, arm.length, q, error);
        if (left <= tolerance::reached) keep_start(arm, starts, q, distance_from_seed(arm, target, q));
    }
    settle_starts(arm, goal, target, starts, nullptr, best);
    for (int k = 0; k < starts.count; ++k)  // at least a solution, where Newton's method did not settle
        if (is_acceptable(arm, target, starts.q[k])) keep_nearer(arm, starts.q[k], starts.distance[k], best);
}

// Returns false if there is none. q: revolute joints in (−π, π].
inline bool copy_wrapped(const Redundant& arm, const Nearest& best, double* q) {
    if (!std::isfinite(best.distance)) return false;
    for (int i = 0; i < arm.chain.n; ++i) q[i] = wrap_joint(arm.chain, i, best.q[i]);
    return true;
}

// Returns false if no configuration was found.
inline bool search_nearest(const Redundant& arm, const Posed& goal, const Target& target, Nearest& best,
                           double* q) {
    if (rank_of(arm.locked.arm) > 0 && arm.redundancy_degree > 0) {
        const bool follows = has_arcs_to_follow(arm) && !target.within_limits;
        if (follows) nearest_by_following(arm, nullptr, goal, target, best);
        if (follows && std::isfinite(best.distance)) return copy_wrapped(arm, best, q);
        if (arm.redundancy_degree == 1)
            nearest_of_curve(arm, goal, target, best);
        else
            nearest_of_surface(arm, goal, target, best);
    }
    if (!std::isfinite(best.distance)) nearest_by_descent(arm, goal, target, best);
    return copy_wrapped(arm, best, q);
}

// The nearest of all configurations, limits aside, where one close to the seed is proven to be it.
inline bool nearest_proven(const Redundant& arm, const Posed& goal, const double* seed, double* q) {
    if (!arm.split_chain.exist || !nearest_by_proof(arm.split_chain, goal, arm.length, seed, q)) return false;
    for (int i = 0; i < arm.chain.n; ++i) q[i] = wrap_joint(arm.chain, i, q[i]);
    return true;
}

// The nearest of all configurations, limits aside.
inline bool nearest_configuration(const Redundant& arm, const Posed& goal, const double* seed, double* q) {
    if (nearest_proven(arm, goal, seed, q)) return true;
    Nearest best;
    return search_nearest(arm, goal, make_target(arm, seed, false), best, q);
}

// The lowest points of all arcs within limits. Samples of the parameter may miss a short arc. Returns false
// if arcs may be missing.
inline bool nearest_of_arcs(const Redundant& arm, const LimitArms& arms, const Posed& goal,
                            const Target& target, Trail& trail, Nearest& best) {
    Intervals unused;
    intervals_by_arcs(arm, arm.locked, arm.locked.locked_joint[0], arms, goal, trail, unused);
    Starts starts;
    double before = 0, here = 0;
    for (int k = 0; k < trail.count; ++k) {
        const bool first = trail.first_of_arc[k], last = k + 1 == trail.count || trail.first_of_arc[k + 1];
        if (first) here = distance_from_seed(arm, target, trail.q[k]);
        const double next = last ? here : distance_from_seed(arm, target, trail.q[k + 1]);
        if ((first || here <= before) && here <= next) add_start(arm, starts, trail.q[k], here);
        before = here;
        here = next;
    }
    settle_starts(arm, goal, target, starts, nullptr, best);
    return unused.complete;
}

// The nearest that a configuration within limits leads to.
inline bool nearest_from(const Redundant& arm, const Posed& goal, const double* seed, const double* start,
                         double* q) {
    const Target target = make_target(arm, seed, true);
    Starts starts;
    Nearest best;
    keep_nearer(arm, start, distance_from_seed(arm, target, start), best);
    add_start(arm, starts, start, best.distance);
    settle_starts(arm, goal, target, starts, nullptr, best);
    return copy_wrapped(arm, best, q);
}

// From a configuration with a joint at a limit the curve may lead nearer to the seed inside the limits: where
// the arm is almost singular, no sample of the parameter may lie on that part of it.
inline void leave_limit(const Redundant& arm, const Posed& goal, const Target& target, Nearest& best) {
    constexpr double inwards = 1e-3;
    const int n = arm.chain.n;
    CurvePoint at;
    double gap[max_joints], next[max_joints];
    for (int i = 0; i < n; ++i) at.q[i] = best.q[i];
    onto_curve(arm.chain, arm.rank, goal, arm.length, at);
    from_seed(arm.chain, target, arm.weight, at.q, gap);
    const double step = -std::copysign(inwards, dot_n(gap, at.tangent, n));
    predict_along(at.q, at.tangent, at.bend, step, n, next);
    if (!is_acceptable(arm, target, next)) return;
    const Nearest end = best;
    descend_along_curve(arm, goal, target, end.q, best);
}

// The nearest of all configurations within limits. arms, trail: null unless one joint is redundant.
inline bool nearest_within_limits(const Redundant& arm, const LimitArms* arms, const Posed& goal,
                                  const double* seed, Trail* trail, double* q) {
    const Target target = make_target(arm, seed, true);
    Nearest best;
    if (arms && !trail && has_arcs_to_follow(arm)) {
        nearest_by_following(arm, arms, goal, target, best);
        return copy_wrapped(arm, best, q);
    }
    const auto ignore = [](const double*, double) {};
    if (arms) find_ends(arm, *arms, goal, target, best, ignore);
    const double end = best.distance;
    const bool is_complete = trail && nearest_of_arcs(arm, *arms, goal, target, *trail, best);
    if (is_complete && std::isfinite(best.distance)) return copy_wrapped(arm, best, q);
    if (!search_nearest(arm, goal, target, best, q)) return false;
    if (!(best.distance < end)) leave_limit(arm, goal, target, best);
    return copy_wrapped(arm, best, q);
}

}  // namespace cspace::ik::inline CSPACE_ISA
