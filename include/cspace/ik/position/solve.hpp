// Inverse kinematics of arms with one, two or three joints for a position: every solution.
//
// Three joints: e^{ξ2 q2} (e^{ξ3 q3} tip) = e^{−ξ1 q1} goal. A revolute joint 2 can rotate one point into
// another exactly when both have the same height along its axis and the same distance from a point of it. A
// prismatic joint 2 can translate one into the other when both have the same two coordinates perpendicular to
// it. Either way two conditions remain for q1 and q3 (pair.hpp), and q2 follows. Two joints: the same with
// goal itself in place of e^{−ξ1 q1} goal. These are two conditions for one joint, and each gives candidates.
// Candidates are refined on the arm, and kept if they reach the goal.
#pragma once

#include <initializer_list>

#include "cspace/ik/position/pair.hpp"
#include "cspace/ik/position/solutions.hpp"
#include "cspace/ik/position/tip_gap.hpp"

namespace cspace::ik::inline CSPACE_ISA {

namespace position {

// The two functions of a point that a joint leaves invariant.
template <int n>
void invariants(const TipGap<n>& g, int joint, const Curve& curve, OnCurve f[2]) {
    const Vec3d &h = g.axis[joint], &o = g.point[joint];
    const Vec3d across = any_perpendicular(h);
    f[0] = height_along(curve, g.prismatic[joint] ? across : h, o);
    f[1] = g.prismatic[joint] ? height_along(curve, cross(h, across), o) : squared_distance(curve, o);
}
template <int n>
Curve tip_curve(const TipGap<n>& g, int joint, const Vec3d& x, double direction) {
    return curve_of(g.prismatic[joint], g.axis[joint], g.point[joint], x, direction);
}

// Refines a candidate and appends it if it reaches the goal. accurate: its joints are, if it does.
template <int n>
void keep_refined(const TipGap<n>& g, double* q, PositionSolutions& found, bool accurate = false) {
    if (refine_angles(g, q, 30, {accurate ? missed_by_far : any_miss, true}) <= g.reached)
        keep_distinct(g, q, found);
}

// Distance of a point from the axis of a revolute joint, over the size of the arm, below which rounding
// decides about the angle that moves it.
inline constexpr double close_to_axis = 1e-5;

inline void add_candidates(const TipGap<1>& g, PositionSolutions& found) {
    double q[1] = {joint_between(g, 0, g.tip, g.goal)};
    keep_refined(g, q, found);
}
inline void add_candidates(const TipGap<2>& g, PositionSolutions& found) {
    const Curve curve = tip_curve(g, 1, g.tip, 1);
    const Curve goal = {true, g.goal, {0, 0, 0}, {0, 0, 0}};
    constexpr double firm = 1e-3;  // of a condition: its values are accurate to ten digits
    OnCurve f[2], target[2];
    invariants(g, 0, curve, f);
    invariants(g, 0, goal, target);
    const auto complete = [&](double last, bool accurate) {
        const Vec3d x = point_at(curve, last);
        const double first = joint_between(g, 0, x, g.goal);
        double q[2] = {first, last};
        keep_refined(g, q, found, accurate);
        const bool free = found.count > 0 && found.self_motion[found.count - 1];
        if (g.prismatic[0] || free || norm(cross(g.axis[0], x - g.point[0])) > close_to_axis) return;
        for (const double turn : {0.5 * pi, pi, -0.5 * pi}) {
            double turned[2] = {first + turn, last};
            keep_refined(g, turned, found);
        }
    };
    bool unconstrained = true;
    for (int i = 0; i < 2; ++i) {
        double last[2];
        const double weight = pair::weight_of(f[i]);
        const int n = weight > tolerance::rounding ? pair::values_on_curve(f[i], target[i].k, last) : 0;
        for (int j = 0; j < n; ++j) complete(last[j], weight > firm);
        unconstrained = unconstrained && n == 0;
    }
    if (unconstrained) complete(0, false);
}
// Joints 0 and 2 bring both points to the axis of joint 1, which is then unconstrained. It is rotated away
// from values at which the other two can move as well. False where they cannot.
inline bool free_the_middle(const TipGap<3>& g, const Vec3d& behind, const Vec3d& before, double* q) {
    const auto is_on_axis = [&](const Vec3d& x) {
        return norm(cross(g.axis[1], x - g.point[1])) <= tolerance::same_turns;
    };
    if (g.prismatic[1] || !is_on_axis(behind) || !is_on_axis(before)) return false;
    double best = -1;
    const double first = q[0], last = q[2];
    for (const double middle : {0.0, 0.5 * pi}) {
        const double there[3] = {first, middle, last};
        Linearised<TipGap<3>> at;
        linearise(g, there, at);
        const auto column = [&](int j) { return Vec3d{at.slope[0][j], at.slope[1][j], at.slope[2][j]}; };
        const double apart = norm(cross(column(0), column(2)));
        if (apart > best) best = apart, q[1] = middle;
    }
    return true;
}
inline void add_candidates(const TipGap<3>& g, PositionSolutions& found) {
    const Curve behind = tip_curve(g, 2, g.tip, 1), before = tip_curve(g, 0, g.goal, -1);
    OnCurve f[2], h[2];
    invariants(g, 1, before, f);
    invariants(g, 1, behind, h);
    const PairCandidates pairs = solve_pair(f, h);
    // Sure candidates first; the doubtful ones (false pairings of the two conditions, or true ones spoilt
    // where the elimination degenerates) and those that represent self-motions only while nothing is found.
    for (int stage = 0; stage < 5; ++stage) {
        if (found.count > 0) return;
        for (int i = 0; i < pairs.count; ++i) {
            if (pairs.stage[i] != (stage < 2 ? 0 : stage - 1)) continue;
            const double first = pairs.first[i], last = pairs.last[i];
            const Vec3d from = point_at(behind, last), to = point_at(before, first);
            double q[3] = {first, joint_between(g, 1, from, to), last};
            if (i == pairs.on_axis && !free_the_middle(g, from, to, q)) continue;
            Linearised<TipGap<3>> start;
            const bool sure = linearise(g, q, start) < tolerance::sure_candidate;
            if (stage >= 2 || sure == (stage == 0)) keep_refined(g, q, found);
        }
    }
}

template <int n>
void find_solutions(const Chain& chain, const Vec3d& goal, bool measure_miss, PositionSolutions& found) {
    const PositionScale scale = position_scale(chain, goal);
    const double size = scale.size;
    const TipGap<n> g = tip_gap<n>(chain, goal, scale);
    add_candidates(g, found);
    if (found.count == 0 && measure_miss) found.out_of_reach = size * minimize_tip_gap(g, found.nearest);
    for (int i = 0; i < n; ++i) {
        if (!g.prismatic[i]) continue;
        found.nearest[i] *= size;
        for (int k = 0; k < found.count; ++k) found.q[k][i] *= size;
    }
}

}  // namespace position

// Moves the tip of the chain (n ≤ 3) to p, in base coordinates. Without a solution, the nearest configuration
// is computed on request only, because that search costs fifty times the solution.
CSPACE_ONCE PositionSolutions solve_position(const Chain& chain, const Vec3d& p, bool measure_miss = true) {
    PositionSolutions found;
    if (chain.n == 1) position::find_solutions<1>(chain, p, measure_miss, found);
    if (chain.n == 2) position::find_solutions<2>(chain, p, measure_miss, found);
    if (chain.n == 3) position::find_solutions<3>(chain, p, measure_miss, found);
    return found;
}

}  // namespace cspace::ik::inline CSPACE_ISA
