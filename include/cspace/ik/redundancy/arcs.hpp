// All feasible arcs of the self-motion of a redundant arm. An open arc ends at a joint limit, and all points
// at limits are computed first. Closed arcs are found from the solutions at sampled joint values.
#pragma once

#include "cspace/ik/redundancy/continuation.hpp"

namespace cspace::ik {

enum class ArcEnd { limit, known_limit, closed, open, lost };

// The turning points of the parameter along an arc, and its end. Values are not wrapped.
struct Turns {
    static constexpr int room = 96;
    int count = 0;
    Critical at[room];
    double q[room][max_joints];  // on the piece that ends there
    double closing;              // of the parameter where the arc has closed
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Tracing an arc of the self-motion until a joint stops or the curve closes, and dividing it at the turning
// points of the parameter.

inline bool add_turn(const Tracer& tracer, Turns& turns, const Critical& at, const double* q) {
    if (turns.count == Turns::room) return false;
    const int k = turns.count++;
    turns.at[k] = at;
    for (int i = 0; i < tracer.arm->chain.n; ++i) turns.q[k][i] = q[i];
    return true;
}

// [rad, m] Points of a curve closer than this are one: a corner of the limits is known to the square root of
// rounding.
inline constexpr double same_point = 1e-6;

// Marks the known points at limits where the curve enters the limits along the tangent of `at` (sense 1) or
// leaves them (sense −1). At a corner of the limits these are several points. Returns true if one of them was
// not marked before.
inline bool use_points(Tracer& tracer, const CurvePoint& at, double sense) {
    bool fresh = false;
    for (int k = 0; k < tracer.points->count; ++k) {
        const LimitPoint& point = tracer.points->point[k];
        const double inwards = point.side ? -at.tangent[point.joint] : at.tangent[point.joint];
        if (!(sense * inwards > 0 && joint_gap(tracer.arm->chain, point.q, at.q) < same_point)) continue;
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
    Ahead ahead;
    const auto add = [&](const Critical& turn) {
        CurvePoint there;
        for (int i = 0; i < n; ++i) there.q[i] = inside[i];
        put_on_curve(tracer, there);
        return add_turn(tracer, turns, turn, there.q);
    };
    for (int i = 0; i < n; ++i) inside[i] = at.q[i];
    record_point(tracer, at.q, true);
    for (int k = 0; k < most_steps; ++k) {
        CurvePoint next;
        if (!step_along_arc(tracer, at, ahead, stride, next)) return ArcEnd::lost;
        int side = 0, stop = stop_at_limit(tracer, at, next, side);
        if (stop_between_turns(tracer, at, next)) stop = -1;
        if (at.tangent[p] * next.tangent[p] < 0 &&
            max(std::fabs(at.tangent[p]), std::fabs(next.tangent[p])) > tolerance::resting) {
            const CurvePoint fold = turn_between(tracer, at, next);
            if (!add({fold.q[p], end_fold, 0})) return ArcEnd::lost;
            for (int i = 0; i < n; ++i) inside[i] = fold.q[i];
        } else {
            for (int i = 0; i < n; ++i) inside[i] = at.q[i];
        }
        record_point(tracer, next.q, false);
        if (stop >= 0) {
            if (!add({next.q[p], stop, side})) return ArcEnd::lost;
            return use_points(tracer, next, -1) ? ArcEnd::limit : ArcEnd::known_limit;
        }
        if (is_far(tracer, next.q)) return add({next.q[p], end_none, 0}) ? ArcEnd::open : ArcEnd::lost;
        // Not the other strand of a narrow loop, which leads back.
        const bool same_way = dot_n(next.tangent, origin.tangent, n) > 0;
        if (k > 0 && same_way && part_of_chord(arm.chain, at.q, next.q, origin.q) >= 0) {
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
    const int parts = turns ? int(std::ceil(length / (2 * pi) - limit_slack)) : 1;
    for (int k = 0; k < parts; ++k) {
        const Critical cut[2] = {{low.value + k * length / parts, end_none, 0},
                                 {low.value + (k + 1) * length / parts, end_none, 0}};
        add_interval(tracer, k ? cut[0] : low, k + 1 < parts ? cut[1] : high, q);
    }
}
inline void add_pieces(Tracer& tracer, const Turns& turns) {
    for (int k = 0; k + 1 < turns.count; ++k) add_piece(tracer, turns.at[k], turns.at[k + 1], turns.q[k + 1]);
}
// start: the parameter at which tracing began. A closed curve turns an even number of times.
inline void add_closed_pieces(Tracer& tracer, Turns& turns, double start, const double* q) {
    const double shift = turns.closing - start;
    if (turns.count % 2) {
        const double again = turns.at[turns.count - 1].value - shift - turns.at[0].value;
        if (std::fabs(again) < same_point)
            --turns.count;  // the last step passed the first turn once more
        else
            tracer.out->complete = false;
    }
    if (turns.count) {
        add_pieces(tracer, turns);
        Critical next = turns.at[0];
        next.value += shift;
        add_piece(tracer, turns.at[turns.count - 1], next, turns.q[0]);
        return;
    }
    const double rounds = std::fabs(std::round(shift / (2 * pi)));  // 0 where it rests at its one value
    add_piece(tracer, {-pi, end_none, 0}, {-pi + 2 * pi * rounds, end_none, 0}, q);
}

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
        // The joint touches its limit and does not cross it.
        if (std::fabs(inwards) < tolerance::resting) continue;
        for (int i = 0; inwards < 0 && i < n; ++i) at.tangent[i] = -at.tangent[i];
        use_points(tracer, at, 1);
        Turns turns;
        add_turn(tracer, turns, {at.q[tracer.parameter], point.joint, point.side}, at.q);
        const ArcEnd end = follow_arc(tracer, at, turns);
        // An arc has two ends of its own, or none where two limits meet in a corner that it only touches.
        const bool touches = joint_gap(tracer.arm->chain, at.q, last_of_trail(tracer)) < same_point;
        if (end != ArcEnd::limit && !touches) tracer.out->complete = false;
        add_pieces(tracer, turns);
    }
}

// Joins the turning points of two curves traced from one point in opposite directions.
inline Turns joined_turns(const Tracer& tracer, const Turns& back, const Turns& on) {
    Turns out;
    for (int k = back.count - 1; k >= 0; --k)
        add_turn(tracer, out, back.at[k], back.q[k + 1 < back.count ? k + 1 : k]);
    for (int k = 0; k < on.count; ++k) add_turn(tracer, out, on.at[k], on.q[k]);
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
inline void trace_loops_at(Tracer& tracer, const LimitArms& arms, int joint) {
    const LockedArm& locked = arms.locked[joint];
    if (!is_solvable(locked.arm)) return;
    const Domain domain = domain_of(*tracer.arm, joint, tracer.goal);
    const int looks = looks_at(arms, joint);
    double at[max_joints], q[max_joints];
    for (int look = 0; look < looks; ++look) {
        at[joint] = middle_of_part(domain, look, looks);
        const Solutions found =
            arms.has_looks[joint] ? solve_arm_briefly(arm_of_look(arms, joint, look), tracer.goal)
            : locked.at_ends      ? solve_arm_briefly(locked.arm, goal_between_ends(locked, tracer.goal, at))
                                  : solve_locked(locked, tracer.goal, at, nullptr);
        for (int j = 0; j < found.count; ++j) {
            whole_row(locked, at, found.q[j], q);
            trace_loop(tracer, q);
        }
    }
}
// [rad, m] Farther from an end than this, a value is certainly inside or outside.
inline constexpr double far_from_end = 1e-4;

// Number of intervals that contain a value modulo 2π; −1 where the value is within `near_end` of an end.
inline int count_intervals(const Tracer& tracer, double value, double near_end) {
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
// Whether the number of intervals at a value equals the number of solutions there that satisfy their limits,
// or an end is too close to tell.
inline bool agrees_with_solutions(const Tracer& tracer, const SweptRows& rows, double value,
                                  double near_end = far_from_end) {
    int within = 0;
    for (int j = 0; j < rows.count; ++j) {
        if (is_far(tracer, rows.q[j])) return true;  // where no arc is followed
        if (is_within(*tracer.arm, rows.q[j], -same_point))
            ++within;
        else if (is_within(*tracer.arm, rows.q[j], same_point))
            return true;
    }
    const int count = count_intervals(tracer, value, near_end);
    return count < 0 || count == within;
}

// Checks the intervals that are too short for the sampled values in their middles.
inline void check_short_intervals(const Tracer& tracer, const Sweep& sweep, double spacing) {
    for (int k = 0; k < tracer.out->count && tracer.out->complete; ++k) {
        const Interval& interval = tracer.out->interval[k];
        const double length = interval.upper - interval.lower;
        if (length > spacing) continue;
        const double near_end = min(far_from_end, 0.1 * length);
        const double middle = 0.5 * (interval.lower + interval.upper);
        sweep_values(sweep, &middle, 1, [&](int, const SweptRows& rows) {
            tracer.out->complete = agrees_with_solutions(tracer, rows, middle, near_end);
        });
    }
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
    constexpr int starts = 48;
    constexpr DescentRule rule = {32, 0.8};
    const Redundant& arm = *tracer.arm;
    double q[starts][max_joints];
    for (int k = 0; k < starts; ++k) spread_evenly(k, arm.chain.n, q[k]);
    bool reached[starts];
    descend_to_manifold(arm.chain, arm.rank, tracer.goal, arm.length, q, starts, reached, rule);
    for (int k = 0; k < starts; ++k)
        if (reached[k]) trace_loop(tracer, q[k]);
}

// Traces the closed arcs from the solutions at sampled values of the parameter. Other joints are sampled too,
// because a loop that hardly moves one joint moves others; not those that hardly any self-motion moves. At
// the sampled values of the parameter the intervals are counted as a check.
inline void trace_loops(Tracer& tracer, const Sweep& sweep, const LimitArms& arms, SweptRows* swept) {
    constexpr int looks = loop_looks;
    const Domain domain = domain_of(*tracer.arm, tracer.parameter, tracer.goal);
    double values[looks];
    for (int k = 0; k < looks; ++k) values[k] = middle_of_part(domain, k, looks);
    sweep_values(sweep, values, looks, [&](int k, const SweptRows& rows) {
        swept[k] = rows;
        for (int j = 0; j < rows.count; ++j) trace_loop(tracer, rows.q[j]);
    });
    for (int joint = 0; joint < tracer.arm->chain.n; ++joint)
        if (joint != tracer.parameter && !arms.rests[joint]) trace_loops_at(tracer, arms, joint);
    trace_loops_by_descent(tracer);
    for (int k = 0; k < looks && tracer.out->complete; ++k)
        tracer.out->complete = agrees_with_solutions(tracer, swept[k], values[k]);
    check_short_intervals(tracer, sweep, (domain.upper - domain.lower) / looks);
}

// How far prismatic joints without limits are followed; 0 if there are none.
inline double far_to_follow(const Redundant& arm, const Posed& goal) {
    for (int i = 0; i < arm.chain.n; ++i)
        if (arm.chain.prismatic[i] && !(std::isfinite(arm.lower[i]) && std::isfinite(arm.upper[i])))
            return far_away(arm, goal);
    return 0;
}

// The intervals of joint `parameter`, which `locked` locks. trail: working memory.
CSPACE_ONCE void intervals_by_arcs(const Redundant& arm, const LockedArm& locked, int parameter,
                                   const LimitArms& arms, const Posed& goal, Trail& trail, Intervals& out) {
    LimitPoints points;
    find_limit_points(arm, arms, goal, -1, points);
    out.count = 0;
    out.complete = points.complete;
    trail.count = 0;
    for (int k = 0; k < points.count; ++k) trail.used[k] = false;
    Tracer tracer{&arm, &points, goal, parameter, &trail, &out, far_to_follow(arm, goal)};
    trace_from_limits(tracer);
    trace_loops(tracer, make_sweep(locked, parameter, goal, arm.middle), arms, trail.swept);
}

}  // namespace cspace::ik::inline CSPACE_ISA
