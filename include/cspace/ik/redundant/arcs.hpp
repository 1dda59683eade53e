// All feasible arcs of the self-motion. Every arc that ends does so at a limit, and all those ends are known
// beforehand; arcs that close are met by the solutions at some values.
#pragma once

#include "cspace/ik/redundant/trace.hpp"

namespace cspace::inline CSPACE_ISA {

inline void trace_from_limits(Tracer& tracer) {
    const ik::Redundant& arm = *tracer.arm;
    for (int k = 0; k < tracer.points->count; ++k) {
        if (tracer.trail->used[k]) continue;
        const ik::LimitPoint& point = tracer.points->point[k];
        CurvePoint at;
        for (int i = 0; i < arm.chain.n; ++i) at.q[i] = point.q[i];
        put_on_curve(tracer, at);
        tracer.trail->used[k] = true;
        const double inwards = point.side ? -at.tangent[point.joint] : at.tangent[point.joint];
        if (std::fabs(inwards) < 1e-9) continue;  // the joint touches its limit and does not cross it
        for (int i = 0; inwards < 0 && i < arm.chain.n; ++i) at.tangent[i] = -at.tangent[i];
        const Critical start{at.q[tracer.parameter], point.joint, point.side};
        if (follow_arc(tracer, at, start) == ArcEnd::lost) tracer.out->complete = false;
    }
}

// Two pieces that begin at one point and lead away from it to either side are one.
inline void join_pieces(Tracer& tracer, int a, int b, double value) {
    ik::Intervals& out = *tracer.out;
    if (a >= b || b >= out.count) return;
    const bool upwards = out.interval[a].upper > value + limit_slack;
    const int low = upwards ? b : a, high = upwards ? a : b;
    ik::Interval joined = out.interval[a];
    joined.lower = out.interval[low].lower;
    joined.upper = out.interval[high].upper;
    joined.end[0] = out.interval[low].end[0];
    joined.side[0] = out.interval[low].side[0];
    joined.end[1] = out.interval[high].end[1];
    joined.side[1] = out.interval[high].side[1];
    out.interval[a] = joined;
    for (int k = b; k + 1 < out.count; ++k) out.interval[k] = out.interval[k + 1];
    --out.count;
}

// Arcs that close within all limits, or go on for ever along a slide that has none: a configuration of one of
// them.
inline void trace_loop(Tracer& tracer, const double* q) {
    if (!is_within(*tracer.arm, q, -limit_slack) || is_far(tracer, q) || is_on_trail(tracer, q)) return;
    CurvePoint at;
    for (int i = 0; i < tracer.arm->chain.n; ++i) at.q[i] = q[i];
    put_on_curve(tracer, at);
    const double value = at.q[tracer.parameter];
    const int first = tracer.out->count;
    ArcEnd end = follow_arc(tracer, at, {value, ik::end_none, 0});
    if (end == ArcEnd::open) {
        const int back = tracer.out->count;
        for (double& t : at.tangent) t = -t;
        end = follow_arc(tracer, at, {value, ik::end_none, 0});
        if (end == ArcEnd::open) join_pieces(tracer, first, back, value);
    }
    if (end != ArcEnd::closed && end != ArcEnd::open) tracer.out->complete = false;
}
// The solutions at some values of a joint.
inline void trace_loops_at(Tracer& tracer, const ik::LockedArm& locked, int joint, int looks) {
    const Domain domain = domain_of(*tracer.arm, joint, tracer.goal);
    double at[ik::max_joints], q[ik::max_joints];
    for (int look = 0; look < looks; ++look) {
        at[joint] = domain.lower + (look + 0.5) / looks * (domain.upper - domain.lower);
        const ik::Solutions found = solve_locked(locked, tracer.goal, at, nullptr);
        for (int j = 0; j < found.count; ++j) {
            whole_row(locked, at, found.q[j], q);
            trace_loop(tracer, q);
        }
    }
}
// They are met by the solutions at some values of the parameter; and of other joints, for a loop that hardly
// moves one joint moves others.
inline void trace_loops(Tracer& tracer, const Sweep& sweep, const ik::LimitArms& arms) {
    constexpr int looks = 24, other_looks = 8;
    const Domain domain = domain_of(*tracer.arm, tracer.parameter, tracer.goal);
    double values[looks];
    for (int k = 0; k < looks; ++k)
        values[k] = domain.lower + (k + 0.5) / looks * (domain.upper - domain.lower);
    sweep_values(sweep, values, looks, [&](int, const SweptRows& rows) {
        for (int j = 0; j < rows.count; ++j) trace_loop(tracer, rows.q[j]);
    });
    for (int k = 0; k < arms.count; ++k)
        if (arms.joint[k] != tracer.parameter)
            trace_loops_at(tracer, arms.locked[k], arms.joint[k], other_looks);
    if (arms.freest >= 0 && arms.freest != tracer.parameter)
        trace_loops_at(tracer, arms.by_freest, arms.freest, looks);
}

// The intervals of joint `parameter`, held by `locked`; trail: working memory.
inline void intervals_by_arcs(const ik::Redundant& arm, const ik::LockedArm& locked, int parameter,
                              const ik::LimitArms& arms, const Posed& goal, Trail& trail,
                              ik::Intervals& out) {
    ik::LimitPoints points;
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
    trace_loops(tracer, make_sweep(locked, parameter, goal, arm.middle), arms);
}

}  // namespace cspace::inline CSPACE_ISA
