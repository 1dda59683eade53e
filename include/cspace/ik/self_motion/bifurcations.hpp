// Bifurcations of self-motions: other self-motions that cross those already found. On a curve of
// configurations with fixed tip the arm may reach a configuration from which a second curve starts (for
// example, a wrist that becomes straight while the shoulder turns).
#pragma once

#include "cspace/ik/general/representatives.hpp"
#include "cspace/ik/near_singular.hpp"
#include "cspace/ik/self_motion/continuation.hpp"
#include "cspace/ik/self_motion/self_motion.hpp"
#include "cspace/ik/self_motion/valleys.hpp"

namespace cspace::ik {

// The singular values other than that of the self-motion, observed while one curve was followed.
struct CurveMargin {
    static constexpr int most = 6;
    int crossings = 0;
    double crossing[most][max_joints] = {}, along[most][max_joints] = {};
    bool wide = false;   // more than one freedom all along
    bool whole = false;  // followed to its ends, with room for all crossings
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Whether the self-motion only rolls a spherical wrist or shoulder whose centre is fixed by the other three
// joints. Then no other curve crosses it.
inline bool only_rolls(const Chain& chain, const TipConstraint& constraint, const double* q,
                       const double* direction) {
    constexpr double firm = 1e-3, together = 1e-9;
    if (chain.n != 6) return false;
    int first = 6, last = -1;
    for (int i = 0; i < 6; ++i)
        if (std::fabs(direction[i]) > tolerance::resting) first = last < 0 ? i : first, last = i;
    if (last - first != 2 || std::fabs(direction[first + 1]) > tolerance::resting ||
        (first != 0 && first != 3))
        return false;
    Vec3d axis[6], point[6];
    for (int i = 0; i < 6; ++i)
        if (chain.prismatic[i]) return false;
    move_joints(chain, 6, q, [&](int i, const Vec3d& h, const Vec3d& p) { axis[i] = h, point[i] = p; });
    const Vec3d &a = axis[first], &b = axis[first + 1];
    const CommonNormal normal = common_normal(a, point[first], b, point[first + 1], false, point[first]);
    const Vec3d centre = normal.from;
    for (int i = first; i <= last; ++i)
        if (norm(cross(axis[i], centre - point[i])) > together * constraint.length) return false;
    const int other = 3 - first;
    const auto lever = [&](int i) { return cross(axis[i], centre - point[i]); };
    const double volume = dot(lever(other), cross(lever(other + 1), lever(other + 2)));
    return norm(cross(a, b)) > firm &&
           std::fabs(volume) > firm * constraint.length * constraint.length * constraint.length;
}

// Whether such a roll meets the goal all the way round: it is worst after quarter turns.
inline bool rolls_round(const Chain& chain, const TipConstraint& constraint, const double* q,
                        const double* direction) {
    for (const double way : {0.5 * pi, -0.5 * pi}) {
        double turned[max_joints];
        for (int i = 0; i < chain.n; ++i) turned[i] = q[i] + std::sqrt(2.0) * way * direction[i];
        if (miss_of(chain, constraint.goal, constraint.length, turned) > constraint.most) return false;
    }
    return true;
}

// Follows the self-motion of solution k, records where other curves cross it, and marks in `passed` the
// later solutions that it passes.
inline CurveMargin follow_margin(const Chain& chain, const TipConstraint& constraint, const Solutions& list,
                                 int k, const double* direction, int& steps_left, bool* passed) {
    constexpr double crossed = 1e-3, free = 1e-6, far_enough = 0.3;
    CurveMargin out;
    double before[max_joints] = {}, along[max_joints] = {}, margin[2] = {0, 0};
    double loose = 0;  // how far it ran with more than one freedom
    int seen = 0, last_way = 0;
    bool fits = true;
    const auto visit = [&](int way, const double* at, const double* t, double here) {
        if (way != last_way) seen = 0;
        const bool least = seen > 1 && margin[1] < crossed && margin[1] <= margin[0] && margin[1] < here;
        fits = fits && !(least && out.crossings == CurveMargin::most);
        if (least && fits) {
            for (int i = 0; i < chain.n; ++i) {
                out.crossing[out.crossings][i] = before[i];
                out.along[out.crossings][i] = along[i];
            }
            ++out.crossings;
        }
        if (seen > 0 && here < free && margin[1] < free) loose += joint_distance(chain, at, before);
        for (int i = 0; i < chain.n; ++i) before[i] = at[i], along[i] = t[i];
        margin[0] = margin[1], margin[1] = here;
        last_way = way;
        ++seen;
        mark_passed(chain, constraint, at, t, list, k + 1, passed);
    };
    out.whole = follow_self_motion(chain, constraint, list.q[k], direction, steps_left, visit) && fits;
    out.wide = loose > far_enough;
    return out;
}

// Adds the self-motion through q unless it passes a listed one. It is represented by the member whose leading
// joint has its value in `unconstrained` (null: zero). A curve that was not followed to its ends, or for
// which no row is free, leaves the list without a certificate.
inline void add_self_motion(const Chain& chain, const TipConstraint& constraint, const double* q,
                            const double* direction, const double* unconstrained, int room, int& steps_left,
                            Solutions& out) {
    bool passed[max_solutions] = {};
    Representative r;
    r.joint = leading_joint(direction, chain.n);
    r.value = unconstrained ? unconstrained[r.joint] : 0;
    const auto visit = [&](int way, const double* at, const double* t, double) {
        offer_next(chain, constraint, r, way, at, t);
        mark_passed(chain, constraint, at, t, out, 0, passed);
    };
    const bool whole = follow_self_motion(chain, constraint, q, direction, steps_left, visit);
    const bool met = std::any_of(passed, passed + out.count, [](bool is) { return is; });
    out.complete = out.complete && (met || (whole && out.count < room));
    if (met || out.count >= room) return;
    const bool crosses = is_crossing(chain, constraint, r.q);
    const int n = append_solution(chain, crosses ? q : r.q, max_branches + out.count, out);
    in_lengths(chain, 1 / constraint.length, crosses ? direction : r.direction, out.direction[n]);
    out.self_motion[n] = true;
}

// The unconstrained direction at a crossing, perpendicular to `along`; false if there is none. Of several,
// the one in which the null vector farthest from `along` points.
inline bool direction_across(const Chain& chain, const PoseSvd& J, const double* along, double* across) {
    constexpr double hardly_constrained = 2e-3, clear = 1e-3;
    double farthest = clear;
    for (int j = 0; j < J.columns; ++j) {
        if (J.sigma[j] > hardly_constrained) continue;
        const double part = dot_n(J.v[j], along, chain.n);
        double rest[max_joints], size2 = 0;
        for (int i = 0; i < chain.n; ++i) {
            rest[i] = J.v[j][i] - part * along[i];
            size2 += rest[i] * rest[i];
        }
        if (!(std::sqrt(size2) > farthest)) continue;
        farthest = std::sqrt(size2);
        for (int i = 0; i < chain.n; ++i) across[i] = rest[i] / farthest;
    }
    return farthest > clear;
}

// Adds the curves that leave a crossing in a direction other than `along`, found at a stride from it.
inline void leave_crossing(const Chain& chain, const TipConstraint& constraint, const double* crossing,
                           const double* along, const double* unconstrained, int room, int& steps_left,
                           Solutions& out) {
    constexpr double stride = 0.1, same_line = 0.95, led_back = 0.5 * stride;
    constexpr int around = 24, most_ways = 4;
    PoseError at;
    measure_constrained(chain, constraint, crossing, at);
    double across[max_joints], gone[most_ways][max_joints];
    if (!direction_across(chain, at.jacobian, along, across)) return;
    int ways = 1;
    for (int i = 0; i < chain.n; ++i) gone[0][i] = along[i];
    for (int m = 1; m < around && ways < most_ways; ++m) {
        const double c = std::cos(pi * m / around), s = std::sin(pi * m / around);
        double q[max_joints], t[max_joints], *const way = gone[ways];
        for (int i = 0; i < chain.n; ++i)
            q[i] =
                crossing[i] + stride * unit_of(chain, i, constraint.length) * (c * along[i] + s * across[i]);
        PoseError there;
        if (!onto_curve(chain, constraint, q, there)) continue;
        for (int i = 0; i < chain.n; ++i)
            way[i] = (q[i] - crossing[i]) / unit_of(chain, i, constraint.length);
        const double went = std::sqrt(dot_n(way, way, chain.n));
        if (!(went > led_back)) continue;
        bool known = false;
        for (int i = 0; i < chain.n; ++i) way[i] /= went;
        for (int k = 0; k < ways; ++k) known = known || std::fabs(dot_n(way, gone[k], chain.n)) > same_line;
        if (known || !tangent_at(chain, there.jacobian, way, t)) continue;
        ++ways;
        add_self_motion(chain, constraint, q, t, unconstrained, room, steps_left, out);
    }
}

// Adds the self-motions that cross those listed, while rows are free. If a self-motion has more than one
// dimension throughout, a curve does not cover it, and the list is not certified.
inline void add_bifurcations(const Chain& chain, const Posed& goal, double length,
                             const double* unconstrained, int room, bool* listed, Solutions& out) {
    const TipConstraint constraint = {goal, true, length};
    int steps_left = 8000;  // of all curves together: some 50 ms
    bool passed[max_solutions] = {};
    for (int k = 0; k < out.count; ++k) {
        if (!out.self_motion[k] || out.settled[k] || passed[k]) continue;
        if (only_rolls(chain, constraint, out.q[k], out.direction[k])) {
            out.complete = out.complete && (rolls_round(chain, constraint, out.q[k], out.direction[k]) ||
                                            turn_into_valley(chain, goal, length, k, room, listed, out));
            continue;
        }
        double q[max_joints], direction[max_joints];
        for (int i = 0; i < chain.n; ++i) q[i] = out.q[k][i];
        in_lengths(chain, length, out.direction[k], direction);
        const CurveMargin seen = follow_margin(chain, constraint, out, k, direction, steps_left, passed);
        if (!seen.whole) std::fill(passed + k, passed + max_solutions, false);
        if (!seen.whole && turn_into_valley(chain, goal, length, k, room, listed, out)) continue;
        out.complete = out.complete && seen.whole && !seen.wide;
        if (seen.wide) continue;
        if (is_crossing(chain, constraint, q))
            leave_crossing(chain, constraint, q, direction, unconstrained, room, steps_left, out);
        for (int c = 0; c < seen.crossings; ++c)
            leave_crossing(chain, constraint, seen.crossing[c], seen.along[c], unconstrained, room,
                           steps_left, out);
    }
}

// Completes the solutions of a goal: self-motions that cross, and valleys caused by rounding.
inline void look_along(const Chain& chain, const Posed& goal, double length, const double* unconstrained,
                       int room, Solutions& out) {
    bool listed[max_solutions] = {};  // by the search of a valley
    if (out.status == Status::singular)
        add_bifurcations(chain, goal, length, unconstrained, room, listed, out);
    double direction[max_joints];
    for (int k = 0; k < out.count && out.crowded && out.complete; ++k)
        if (!out.self_motion[k] && !out.settled[k] && !listed[k] &&
            lies_in_valley(chain, goal, length, out.q[k], direction))
            out.complete = search_valley(chain, goal, length, out.q[k], direction, room, listed, out).whole;
}

}  // namespace cspace::ik::inline CSPACE_ISA
