// Tracing an arc of the self-motion until a joint stops or the curve closes, and dividing it at the turning
// points of the parameter.
#pragma once

#include "cspace/ik/redundancy/continuation.hpp"

namespace cspace::ik {

enum class ArcEnd { limit, known_limit, closed, open, lost };

// The turning points of the parameter along an arc, and its end. Values are not wrapped.
struct Turns {
    static constexpr int room = 96;
    int count = 0;
    double value[room];
    int end[room], side[room];
    double q[room][max_joints];  // on the piece that ends there
    double closing;              // of the parameter where the arc has closed
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline bool add_turn(const Tracer& tracer, Turns& turns, double value, int end, int side, const double* q) {
    if (turns.count == Turns::room) return false;
    const int k = turns.count++;
    turns.value[k] = value;
    turns.end[k] = end;
    turns.side[k] = side;
    for (int i = 0; i < tracer.arm->chain.n; ++i) turns.q[k][i] = q[i];
    return true;
}

// Marks the known points at limits where the curve enters the limits along the tangent of `at` (sense 1) or
// leaves them (sense −1). At a corner of the limits these are several points. Returns true if one of them was
// not marked before.
inline bool use_points(Tracer& tracer, const CurvePoint& at, double sense) {
    bool fresh = false;
    for (int k = 0; k < tracer.points->count; ++k) {
        const LimitPoint& point = tracer.points->point[k];
        const double inwards = point.side ? -at.tangent[point.joint] : at.tangent[point.joint];
        if (!(sense * inwards > 0 && joint_gap(tracer.arm->chain, point.q, at.q) < 1e-6)) continue;
        fresh = fresh || !tracer.trail->used[k];
        tracer.trail->used[k] = true;
    }
    return fresh;
}

// Traces the curve from `at` in the direction of its tangent.
inline ArcEnd follow_arc(Tracer& tracer, CurvePoint at, Turns& turns) {
    constexpr int most_steps = 5000;
    const Redundant& arm = *tracer.arm;
    const int n = arm.chain.n, p = tracer.parameter;
    const CurvePoint origin = at;
    double stride = 0.02, inside[max_joints];
    const auto add = [&](double value, int end, int side) {
        return add_turn(tracer, turns, value, end, side, inside);
    };
    for (int i = 0; i < n; ++i) inside[i] = at.q[i];
    record_point(tracer, at.q, true);
    for (int k = 0; k < most_steps; ++k) {
        CurvePoint next;
        if (!step_along(tracer, at, stride, next)) return ArcEnd::lost;
        int side = 0, stop = stop_at_limit(tracer, at, next, side);
        if (stop_between_turns(tracer, at, next)) stop = -1;
        if (at.tangent[p] * next.tangent[p] < 0 &&
            max(std::fabs(at.tangent[p]), std::fabs(next.tangent[p])) > 1e-9) {
            const CurvePoint fold = turn_between(tracer, at, next);
            if (!add(fold.q[p], end_fold, 0)) return ArcEnd::lost;
            for (int i = 0; i < n; ++i) inside[i] = fold.q[i];
        } else {
            for (int i = 0; i < n; ++i) inside[i] = at.q[i];
        }
        record_point(tracer, next.q, false);
        if (stop >= 0) {
            if (!add(next.q[p], stop, side)) return ArcEnd::lost;
            return use_points(tracer, next, -1) ? ArcEnd::limit : ArcEnd::known_limit;
        }
        if (is_far(tracer, next.q)) return add(next.q[p], end_none, 0) ? ArcEnd::open : ArcEnd::lost;
        if (k > 0 && part_of_chord(arm.chain, at.q, next.q, origin.q) >= 0) {
            turns.closing = next.q[p] + joint_difference(arm.chain, p, origin.q[p] - next.q[p]);
            return ArcEnd::closed;
        }
        at = next;
    }
    return ArcEnd::lost;
}

inline void add_interval(Tracer& tracer, const Critical& low, const Critical& high, const double* q) {
    Intervals& out = *tracer.out;
    if (out.count == Intervals::room) {
        out.complete = false;
        return;
    }
    Interval& made = out.interval[out.count++];
    made = {low.value, high.value, tracer.branches++, {low.end, high.end}, {low.side, high.side}, {}};
    for (int i = 0; i < tracer.arm->chain.n; ++i) made.q[i] = q[i];
    const int p = tracer.parameter;
    if (tracer.arm->chain.prismatic[p]) return;
    const bool stopped = is_stopped(*tracer.arm, p);
    const double home = stopped ? 0.5 * (tracer.arm->lower[p] + tracer.arm->upper[p]) : 0;
    const double turns = nearest_multiple(0.5 * (low.value + high.value) - home);
    made.lower -= turns;
    made.upper -= turns;
}

// Adds a piece between two turning points of the parameter, from either end. A piece of more than one
// revolution is divided, because each revolution is one branch.
inline void add_piece(Tracer& tracer, const Critical& from, const Critical& to, const double* q) {
    const bool rising = from.value <= to.value;
    const Critical &low = rising ? from : to, &high = rising ? to : from;
    const double length = high.value - low.value;
    if (length <= limit_slack) return;
    const bool turns = !tracer.arm->chain.prismatic[tracer.parameter];
    const int parts = turns ? int(std::ceil(length / (2 * pi) - 1e-9)) : 1;
    for (int k = 0; k < parts; ++k) {
        const Critical cut[2] = {{low.value + k * length / parts, end_none, 0},
                                 {low.value + (k + 1) * length / parts, end_none, 0}};
        add_interval(tracer, k ? cut[0] : low, k + 1 < parts ? cut[1] : high, q);
    }
}
inline Critical turn_at(const Turns& turns, int k, double shift = 0) {
    return {turns.value[k] + shift, turns.end[k], turns.side[k]};
}
inline void add_pieces(Tracer& tracer, const Turns& turns) {
    for (int k = 0; k + 1 < turns.count; ++k)
        add_piece(tracer, turn_at(turns, k), turn_at(turns, k + 1), turns.q[k + 1]);
}
// start: the parameter at which tracing began.
inline void add_closed_pieces(Tracer& tracer, const Turns& turns, double start, const double* q) {
    const double shift = turns.closing - start;
    if (turns.count) {
        add_pieces(tracer, turns);
        const int last = turns.count - 1;
        add_piece(tracer, turn_at(turns, last), turn_at(turns, 0, shift), turns.q[0]);
        return;
    }
    const double rounds = std::fabs(std::round(shift / (2 * pi)));  // 0 where it rests at its one value
    add_piece(tracer, {-pi, end_none, 0}, {-pi + 2 * pi * rounds, end_none, 0}, q);
}

}  // namespace cspace::ik::inline CSPACE_ISA
