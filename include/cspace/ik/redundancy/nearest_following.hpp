// The nearest configuration of an arm with one redundant joint and no closed form on lanes. Solutions at a
// few values of that joint, and points that Newton's method reaches from around the seed, are starts. The
// arcs through them are followed around the seed, and Newton's method settles every local minimum along them.
#pragma once

#include <algorithm>

#include "cspace/ik/redundancy/nearest_arcs.hpp"
#include "cspace/ik/redundancy/nearest_starts.hpp"

namespace cspace::ik {

// Values of the parameter, or those up to 2π from them.
struct Window {
    double middle, half;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Beside a singular pose the last step of Newton's method may lead away from where it had arrived.
inline bool meets_pose(const Redundant& arm, const Posed& goal, const double* q) {
    TipMotion<double> motion;
    tip_motion<0>(arm.chain, goal, arm.length, q, motion);
    return largest_of(motion.error, 6) < tolerance::reached;
}

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

// The points of the curve where a joint is at a limit that is nearer to the seed than the best configuration.
// They include those where a joint that the limits do not stop would have to go on by a revolution. visit(q,
// distance): called for each.
template <class Visit>
inline void find_ends(const Redundant& arm, const LimitArms& arms, const Posed& goal, const Target& target,
                      Nearest& best, const Visit& visit) {
    LimitPoints points;
    find_limit_points(arm, arms, goal, points, [&](int joint, int side) {
        const double away = std::fabs(limit_of(arm, joint, side) - target.seed[joint]);
        if (!(arm.weight[joint] * away < best.distance)) return false;
        return has_limit(arm, joint, side) ||
               (target.shift[joint] != 0 && (target.shift[joint] < 0) == bool(side));
    });
    for (int k = 0; k < points.count; ++k) {
        LimitPoint at = points.point[k];
        at.q[at.joint] += at.side ? -limit_slack : limit_slack;  // on the side where it is measured
        const double distance = distance_from_seed(arm, target, at.q);
        at.q[at.joint] = limit_of(arm, at.joint, at.side);
        if (is_acceptable(arm, target, at.q) && meets_pose(arm, goal, at.q))
            keep_nearer(arm, at.q, distance, best);
        visit(at.q, distance);
    }
}

// The solutions at a few values of the parameter. Many arcs pass through several of them.
inline void add_solved_starts(const Redundant& arm, const Posed& goal, const Target& target,
                              const Nearest& best, ArcStarts& starts) {
    constexpr int looks = 8;
    const int p = arm.locked.locked_joint[0];
    const Window window = window_of(arm, target, p, goal, best);
    const Sweep sweep = make_sweep(arm.locked, p, goal, target.seed);
    double values[looks];
    for (int k = 0; k < looks; ++k) values[k] = window.middle + window.half * ((2 * k + 1.0) / looks - 1);
    sweep_values(sweep, values, looks, [&](int, const SweptRows& rows) {
        for (int k = 0; k < rows.count; ++k)
            add_arc_start(arm, rows.q[k], distance_from_seed(arm, target, rows.q[k]), starts);
    });
}

// What Newton's method reaches from `looks` configurations around the seed, more and more of them close to
// it. Small arcs that no value above meets have a large basin of attraction. first: number of the first one.
inline void add_reached_starts(const Redundant& arm, const Posed& goal, const Target& target, int first,
                               int looks, ArcStarts& starts) {
    constexpr int most = 96;
    constexpr DescentRule rule = {24, 0.8};
    double q[most][max_joints];
    bool reached[most];
    for (int k = 0; k < looks; ++k) {
        spread_configuration(first + k, arm.chain.n, q[k]);
        for (int i = 0; i < arm.chain.n; ++i) q[k][i] = target.seed[i] + k / (looks - 1.0) * q[k][i];
    }
    descend_to_manifold(arm.chain, arm.rank, goal, arm.length, q, looks, reached, rule);
    for (int k = 0; k < looks; ++k)
        if (reached[k]) add_arc_start(arm, q[k], distance_from_seed(arm, target, q[k]), starts);
}

// Starts on all arcs around the seed. Close to the end of the arm's reach, the arcs are small and there are
// few starts at first.
inline void find_arc_starts(const Redundant& arm, const Posed& goal, const Target& target,
                            const Nearest& best, ArcStarts& starts) {
    constexpr int looks = 48, more = 96, few = 32;
    add_solved_starts(arm, goal, target, best, starts);
    add_reached_starts(arm, goal, target, 0, looks, starts);
    if (starts.count < few) add_reached_starts(arm, goal, target, looks, more, starts);
}

// Settles the starts nearest to the seed. What they lead to says how far the arcs are followed.
inline void settle_nearest_starts(const Redundant& arm, const Posed& goal, const Target& target,
                                  const ArcStarts& starts, Nearest& best) {
    constexpr int most = 8;
    int order[ArcStarts::room];
    for (int k = 0; k < starts.count; ++k) order[k] = k;
    const int count = std::min(most, starts.count);
    std::partial_sort(order, order + count, order + starts.count,
                      [&](int a, int b) { return starts.distance[a] < starts.distance[b]; });
    const double* chosen[most];
    for (int k = 0; k < count; ++k) {
        chosen[k] = starts.q[order[k]];
        if (is_acceptable(arm, target, chosen[k]) && meets_pose(arm, goal, chosen[k]))
            keep_nearer(arm, chosen[k], starts.distance[order[k]], best);
    }
    settle_all(arm, goal, target, chosen, count, best);
}

// Settles the minima in the order of their distances, while they may be below the best one.
inline void settle_minima(const Redundant& arm, const Posed& goal, const Target& target,
                          const ArcMinima& minima, Nearest& best) {
    constexpr int abreast = 4;
    int order[ArcMinima::room];
    for (int k = 0; k < minima.count; ++k) order[k] = k;
    std::sort(order, order + minima.count,
              [&](int a, int b) { return minima.distance[a] < minima.distance[b]; });
    for (int next = 0; next < minima.count;) {
        const double* chosen[abreast];
        int count = 0;
        for (; next < minima.count && count < abreast; ++next)
            if (minima.bound[order[next]] < best.distance) chosen[count++] = minima.q[order[next]];
        settle_all(arm, goal, target, chosen, count, best);
    }
    for (int k = 0; k < minima.count; ++k)
        if (minima.distance[k] < best.distance && is_acceptable(arm, target, minima.q[k]))
            descend_along_curve(arm, goal, target, minima.q[k], best);
}

// arms: of the limits, where they count; null without.
inline void nearest_by_following(const Redundant& arm, const LimitArms* arms, const Posed& goal,
                                 const Target& target, Nearest& best) {
    constexpr ArcReach reach = {1.5, 0.5};
    ArcStarts starts;
    ArcMinima minima;
    settle_around(arm, goal, target, best);
    find_arc_starts(arm, goal, target, best, starts);
    settle_nearest_starts(arm, goal, target, starts, best);
    if (arms)
        find_ends(arm, *arms, goal, target, best,
                  [&](const double* q, double distance) { add_arc_start(arm, q, distance, starts); });
    const ArcSearch search = {&arm, &target, &starts, &minima, &best, reach};
    (arm.chain.n == 7 ? find_arc_minima<7, Pack<4>> : find_arc_minima<0, Pack<4>>)(search, goal);
    settle_minima(arm, goal, target, minima, best);
}

}  // namespace cspace::ik::inline CSPACE_ISA
