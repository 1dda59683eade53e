// All feasible arcs of the self-motion of a redundant arm. An open arc ends at a joint limit, and all points
// at limits are computed first. Closed arcs are found from the solutions at sampled joint values.
#pragma once

#include "cspace/ik/redundancy/follow.hpp"

namespace cspace::ik::inline CSPACE_ISA {

inline const double* last_of_trail(const Tracer& tracer) { return tracer.trail->q[tracer.trail->count - 1]; }

inline void trace_from_limits(Tracer& tracer) {
    const int n = tracer.arm->chain.n;
    for (int k = 0; k < tracer.points->count; ++k) {
        if (tracer.trail->used[k]) continue;
        const LimitPoint& point = tracer.points->point[k];
        CurvePoint at;
        for (int i = 0; i < n; ++i) at.q[i] = point.q[i];
        put_on_curve(tracer, at);
        tracer.trail->used[k] = true;
        const double inwards = point.side ? -at.tangent[point.joint] : at.tangent[point.joint];
        if (std::fabs(inwards) < 1e-9) continue;  // the joint touches its limit and does not cross it
        for (int i = 0; inwards < 0 && i < n; ++i) at.tangent[i] = -at.tangent[i];
        use_points(tracer, at, 1);
        Turns turns;
        add_turn(tracer, turns, at.q[tracer.parameter], point.joint, point.side, at.q);
        const ArcEnd end = follow_arc(tracer, at, turns);
        // An arc has two ends of its own, or none where two limits meet in a corner that it only touches.
        const bool touches = joint_gap(tracer.arm->chain, at.q, last_of_trail(tracer)) < 1e-6;
        if (end != ArcEnd::limit && !touches) tracer.out->complete = false;
        add_pieces(tracer, turns);
    }
}

// Joins the turning points of two curves traced from one point in opposite directions.
inline Turns joined_turns(const Tracer& tracer, const Turns& back, const Turns& on) {
    Turns out;
    for (int k = back.count - 1; k >= 0; --k)
        add_turn(tracer, out, back.value[k], back.end[k], back.side[k],
                 back.q[k + 1 < back.count ? k + 1 : k]);
    for (int k = 0; k < on.count; ++k) add_turn(tracer, out, on.value[k], on.end[k], on.side[k], on.q[k]);
    return out;
}

// Traces one arc from a configuration: an arc that is closed within all limits, or one that is unbounded
// along a prismatic joint without limits.
inline void trace_loop(Tracer& tracer, const double* q) {
    const int n = tracer.arm->chain.n, first = tracer.trail->count;
    if (!is_within(*tracer.arm, q, -limit_slack) || is_far(tracer, q) || is_on_trail(tracer, q)) return;
    CurvePoint at;
    for (int i = 0; i < n; ++i) at.q[i] = q[i];
    put_on_curve(tracer, at);
    Turns turns;
    const ArcEnd end = follow_arc(tracer, at, turns);
    if (end == ArcEnd::known_limit) return;  // on a chord's other side
    if (end == ArcEnd::closed) {
        for (int k = 0; k < first; ++k)
            if (tracer.trail->first_of_arc[k] && is_on_trail(tracer, tracer.trail->q[k], first)) return;
        add_closed_pieces(tracer, turns, at.q[tracer.parameter], at.q);
        return;
    }
    for (int i = 0; i < n; ++i) at.tangent[i] = -at.tangent[i];
    Turns back;
    const ArcEnd other = follow_arc(tracer, at, back);
    add_pieces(tracer, joined_turns(tracer, back, turns));
    if (end != ArcEnd::open || other != ArcEnd::open) tracer.out->complete = false;
}
// Traces the arcs through the solutions at sampled values of a joint. A joint whose value the goal determines
// has no samples.
inline void trace_loops_at(Tracer& tracer, const LockedArm& locked, int joint, int looks) {
    if (!is_solvable(locked.arm)) return;
    const Domain domain = domain_of(*tracer.arm, joint, tracer.goal);
    double at[max_joints], q[max_joints];
    for (int look = 0; look < looks; ++look) {
        at[joint] = domain.lower + (look + 0.5) / looks * (domain.upper - domain.lower);
        const Solutions found = solve_locked(locked, tracer.goal, at, nullptr);
        for (int j = 0; j < found.count; ++j) {
            whole_row(locked, at, found.q[j], q);
            trace_loop(tracer, q);
        }
    }
}
// Number of intervals that contain a value modulo 2π; −1 where the value is too close to an end to decide.
inline int count_intervals(const Tracer& tracer, double value) {
    constexpr double near_end = 1e-4;
    int count = 0;
    for (int k = 0; k < tracer.out->count; ++k) {
        const Interval& interval = tracer.out->interval[k];
        const double middle = 0.5 * (interval.lower + interval.upper);
        const double off = std::fabs(joint_difference(tracer.arm->chain, tracer.parameter, value - middle)) -
                           0.5 * (interval.upper - interval.lower);
        if (std::fabs(off) < near_end && interval.end[0] != end_none) return -1;
        count += off < 0;
    }
    return count;
}
// Whether the number of intervals at a value equals the number of solutions there that satisfy their limits.
inline bool agrees_with_solutions(const Tracer& tracer, const SweptRows& rows, double value) {
    int within = 0;
    for (int j = 0; j < rows.count; ++j) {
        if (is_far(tracer, rows.q[j])) return true;  // where no arc is followed
        if (is_within(*tracer.arm, rows.q[j], -1e-6))
            ++within;
        else if (is_within(*tracer.arm, rows.q[j], 1e-6))
            return true;
    }
    const int count = count_intervals(tracer, value);
    return count < 0 || count == within;
}

// Configurations evenly distributed over all joints: multiples of the powers of 1/g with g^(n+1) = g + 1, the
// golden ratio of n dimensions (M. Roberts 2018).
inline void spread_evenly(int k, int n, double* q) {
    double g = 1.5;
    for (int step = 0; step < 12; ++step) g = std::pow(1 + g, 1.0 / (n + 1));
    double part = 1;
    for (int i = 0; i < n; ++i) {
        part /= g;
        const double turns = 0.5 + (k + 1) * part;
        q[i] = pi * (2 * (turns - std::floor(turns)) - 1);
    }
}

// Finds small loops by Newton's method. Sampled values may miss a small loop, but its basin of attraction is
// large.
inline void trace_loops_by_descent(Tracer& tracer) {
    constexpr int starts = 48, most_steps = 60;
    const Redundant& arm = *tracer.arm;
    for (int k = 0; k < starts; ++k) {
        CurvePoint at;
        spread_evenly(k, arm.chain.n, at.q);
        at.error = 1;
        for (int step = 0; step < most_steps && at.error > 1e-9; ++step)
            onto_curve(arm.chain, arm.rank, tracer.goal, arm.length, at);
        if (at.error <= 1e-9) trace_loop(tracer, at.q);
    }
}

// Traces the closed arcs from the solutions at sampled values of the parameter. Other joints are sampled too,
// because a loop that hardly moves one joint moves others. At the sampled values of the parameter the
// intervals are counted as a check.
inline void trace_loops(Tracer& tracer, const Sweep& sweep, const LimitArms& arms, SweptRows* swept) {
    constexpr int looks = loop_looks, other_looks = 4;
    const Domain domain = domain_of(*tracer.arm, tracer.parameter, tracer.goal);
    double values[looks];
    for (int k = 0; k < looks; ++k)
        values[k] = domain.lower + (k + 0.5) / looks * (domain.upper - domain.lower);
    sweep_values(sweep, values, looks, [&](int k, const SweptRows& rows) {
        swept[k] = rows;
        for (int j = 0; j < rows.count; ++j) trace_loop(tracer, rows.q[j]);
    });
    for (int joint = 0; joint < tracer.arm->chain.n; ++joint)
        if (joint != tracer.parameter)
            trace_loops_at(tracer, arms.locked[joint], joint, joint == arms.freest ? looks : other_looks);
    trace_loops_by_descent(tracer);
    for (int k = 0; k < looks && tracer.out->complete; ++k)
        tracer.out->complete = agrees_with_solutions(tracer, swept[k], values[k]);
}

// The intervals of joint `parameter`, which `locked` locks. trail: working memory.
inline void intervals_by_arcs(const Redundant& arm, const LockedArm& locked, int parameter,
                              const LimitArms& arms, const Posed& goal, Trail& trail, Intervals& out) {
    LimitPoints points;
    find_limit_points(arm, arms, goal, -1, points);
    out.count = 0;
    out.complete = points.complete;
    trail.count = 0;
    for (int k = 0; k < points.count; ++k) trail.used[k] = false;
    double far = 0;
    for (int i = 0; i < arm.chain.n; ++i)
        if (arm.chain.prismatic[i] && !(std::isfinite(arm.lower[i]) && std::isfinite(arm.upper[i])))
            far = far_away(arm, goal);
    Tracer tracer{&arm, &points, goal, parameter, &trail, &out, far};
    trace_from_limits(tracer);
    trace_loops(tracer, make_sweep(locked, parameter, goal, arm.middle), arms, trail.swept);
}

}  // namespace cspace::ik::inline CSPACE_ISA
