// The nearest configuration of the whole self-motion manifold. Coarse samples over the locked joints give the
// starts, and Newton's method on the distance refines them. A weighted joint cannot be farther away than the
// best distance found so far. This bound reduces the search from a nearby seed to a few samples.
#pragma once

#include <algorithm>

#include "cspace/ik/redundancy/active_set.hpp"
#include "cspace/ik/redundancy/arcs.hpp"
#include "cspace/ik/redundancy/narrow_valleys.hpp"
#include "cspace/ik/redundancy/nearest_proof.hpp"
#include "cspace/ik/redundancy/nearest_step.hpp"
#include "cspace/ik/redundancy/turning_points.hpp"
#include "cspace/math/turn.hpp"

namespace cspace::ik {

// The best starts so far, by distance from the seed.
struct Starts {
    static constexpr int room = 32;
    int count = 0;
    double q[room][max_joints];
    double distance[room];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Adds a start. If there is no room, it replaces the worst one.
inline void add_start(const Redundant& arm, Starts& starts, const double* q, double distance) {
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

// Refines the starts whose valley may contain a point below the best one. `also`: an additional start, on the
// manifold or off it. Within limits the bound is a limit's, and several redundant joints may end at limits.
inline void settle_starts(const Redundant& arm, const Posed& goal, const Target& target, const Starts& starts,
                          const double* also, Nearest& best) {
    const double* chosen[Starts::room + 1];
    int count = 0;
    double nearest = best.distance;
    if (also) chosen[count++] = also;
    for (int k = 0; k < starts.count && !target.within_limits; ++k)
        nearest = min(nearest, starts.distance[k]);
    for (int k = 0; k < starts.count; ++k)
        if (starts.distance[k] <= 1.5 * nearest + 0.2) chosen[count++] = starts.q[k];
    if (target.within_limits && arm.redundancy_degree != 1) {
        for (int k = 0; k < count; ++k) settle_within_limits(arm, goal, target, chosen[k], best);
        return;
    }
    settle_all(arm, goal, target, chosen, count, best);
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

// Values of the parameter, or those up to 2π from them.
struct Window {
    double middle, half;
};

// The values around the seed that the bound of the best solution and the limits leave.
inline Window window_of(const Redundant& arm, const Target& target, int p, const Posed& goal,
                        const Nearest& best) {
    const Domain domain = domain_of(arm, p, goal);
    const double seed = target.seed[p],
                 bound = arm.weight[p] > 0 ? best.distance : domain.upper - domain.lower;
    if (target.within_limits && !domain.is_circle) {
        const double from = max(domain.lower, seed - bound), to = min(domain.upper, seed + bound);
        return {0.5 * (from + to), 0.5 * max(to - from, 0.0)};
    }
    const double far = arm.chain.prismatic[p] ? max(domain.upper - seed, seed - domain.lower) : pi;
    return {seed, arm.weight[p] > 0 ? min(bound, far) : far};
}

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
    lowest_samples(arm.chain, samples, is_minimum ? best.q : nullptr,
                   [&](const double* q, double d) { add_start(arm, starts, q, d); });
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
        if (arm.redundancy_degree == 1)
            nearest_of_curve(arm, goal, target, best);
        else
            nearest_of_surface(arm, goal, target, best);
    }
    if (!std::isfinite(best.distance)) nearest_by_descent(arm, goal, target, best);
    return copy_wrapped(arm, best, q);
}

// The nearest of all configurations, limits aside.
inline bool nearest_configuration(const Redundant& arm, const Posed& goal, const double* seed, double* q) {
    if (arm.halves.exist && nearest_by_proof(arm.halves, goal, arm.length, seed, q)) {
        for (int i = 0; i < arm.chain.n; ++i) q[i] = wrap_joint(arm.chain, i, q[i]);
        return true;
    }
    Nearest best;
    return search_nearest(arm, goal, make_target(arm, seed, false), best, q);
}

// The points of the curve where a joint is at a limit. They include those where a joint that the limits do
// not stop would have to go on by a revolution.
inline void find_ends(const Redundant& arm, const LimitArms& arms, const Posed& goal, const Target& target,
                      Nearest& best) {
    LimitPoints points;
    find_limit_points(arm, arms, goal, points, [&](int joint, int side) {
        return has_limit(arm, joint, side) ||
               (target.shift[joint] != 0 && (target.shift[joint] < 0) == bool(side));
    });
    for (int k = 0; k < points.count; ++k) {
        LimitPoint at = points.point[k];
        at.q[at.joint] += at.side ? -limit_slack : limit_slack;  // on the side where it is measured
        const double distance = distance_from_seed(arm, target, at.q);
        at.q[at.joint] = limit_of(arm, at.joint, at.side);
        if (is_acceptable(arm, target, at.q)) keep_nearer(arm, at.q, distance, best);
    }
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

// The nearest of all configurations within limits. arms, trail: null unless one joint is redundant.
inline bool nearest_within_limits(const Redundant& arm, const LimitArms* arms, const Posed& goal,
                                  const double* seed, Trail* trail, double* q) {
    const Target target = make_target(arm, seed, true);
    Nearest best;
    if (arms) find_ends(arm, *arms, goal, target, best);
    const bool is_complete = trail && nearest_of_arcs(arm, *arms, goal, target, *trail, best);
    return is_complete && std::isfinite(best.distance) ? copy_wrapped(arm, best, q)
                                                       : search_nearest(arm, goal, target, best, q);
}

}  // namespace cspace::ik::inline CSPACE_ISA
