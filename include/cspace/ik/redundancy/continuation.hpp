// Numerical continuation of the self-motion: steps along one arc, short enough that no other arc is confused
// with it (Allgower & Georg 1990, chapter 6). Detects the joint limits and the turning points of the
// parameter that a step passes.
#pragma once

#include "cspace/ik/redundancy/feasible_intervals.hpp"
#include "cspace/ik/redundancy/tip_jacobian.hpp"
#include "cspace/math/continuation.hpp"

namespace cspace::ik {

// All points of the traced curve, and the solutions at sampled values.
struct Trail {
    static constexpr int room = 12000;
    int count = 0;
    bool first_of_arc[room];
    double q[room][max_joints], length[room];  // length: of the chord that ends there
    // The joints once more, one after the other, and how far from a point its chord and the chord's tube
    // reach; negative where an arc begins.
    double joint[max_joints][room], reach[room];
    bool used[LimitPoints::room];  // limit points that an arc started or ended in
    SweptRows swept[loop_looks];
};

// The third and fourth derivative of the curve at the point that a step led to, from the tangents and bends
// at both of its ends, and how much the Jacobian changed per length; zero where the step was too short to
// tell.
struct Ahead {
    double third[max_joints] = {}, fourth[max_joints] = {}, change = 0;
};

struct Tracer {
    const Redundant* arm;
    const LimitPoints* points;
    Posed goal;
    int parameter;
    Trail* trail;
    Intervals* out;
    double far;  // how far slides without limits are followed; 0 if there are none
    int branches = 0;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline void put_on_curve(const Tracer& tracer, CurvePoint& at) {
    constexpr double settled = 1e-9;  // the step taken after it is Newton's: it squares the error
    for (int k = 0; k < 5; ++k) {
        onto_curve(tracer.arm->chain, tracer.arm->rank, tracer.goal, tracer.arm->length, at);
        if (at.error < settled) break;
    }
}
// Position of a solution on the chord of a step, from 0 to 1; −1 if it is off the chord. A chord deviates
// from the curve by less than the width of the tube, and no other arc enters the tube: see step_along_arc.
inline double part_of_chord(const Chain& chain, const double* from, const double* to, const double* q) {
    constexpr double tube = 0.06;
    constexpr double rounding = 1e-9;  // of a share of the chord
    double way[max_joints], gap[max_joints], length2 = 0, along = 0;
    for (int i = 0; i < chain.n; ++i) {
        way[i] = to[i] - from[i];
        length2 += way[i] * way[i];
    }
    const double off = tube * std::sqrt(length2);
    for (int i = 0; i < chain.n; ++i) {
        gap[i] = joint_difference(chain, i, q[i] - from[i]);
        if (std::fabs(gap[i]) > std::fabs(way[i]) + off) return -1;
        along += gap[i] * way[i];
    }
    const double part = along / length2;
    if (!(part >= -rounding && part <= 1 + rounding)) return -1;
    for (int i = 0; i < chain.n; ++i)
        if (std::fabs(gap[i] - part * way[i]) > off) return -1;
    return max(0.0, part);
}

// Upper bound of a step: 0.35 rad for revolute joints, in proportion for prismatic joints where the curve is
// long.
inline double longest_step(const Tracer& tracer, const CurvePoint& from) {
    constexpr double longest = 0.35, steps_across = 64;
    if (!(tracer.far > 0)) return longest;
    const double slide = max(longest, tracer.far / steps_across);
    double most = 0;
    for (int i = 0; i < tracer.arm->chain.n; ++i)
        most = max(most, std::fabs(from.tangent[i]) / (tracer.arm->chain.prismatic[i] ? slide : longest));
    return 1 / most;
}

// The derivatives ahead of `to`, where a step from `from` ended: of the Hermite polynomial for the tangents
// t(−h), t(0) and bends b(−h), b(0).
inline Ahead look_ahead(const CurvePoint& from, const CurvePoint& to, int n) {
    constexpr double shortest = 1e-3, arc = 1.0 / 24;  // arc − chord = κ² h³ / 24
    Ahead out;
    double chord2 = 0;
    for (int i = 0; i < n; ++i) chord2 += (to.q[i] - from.q[i]) * (to.q[i] - from.q[i]);
    if (!(chord2 > shortest * shortest)) return out;
    const double h = std::sqrt(chord2) * (1 + arc * chord2 * dot_n(to.bend, to.bend, n)), per = 1 / h;
    for (int i = 0; i < n; ++i) {
        const double turned = per * per * (from.tangent[i] - to.tangent[i] + h * to.bend[i]);
        const double bent = per * (from.bend[i] - to.bend[i]);
        out.third[i] = 6 * turned + 2 * bent;
        out.fourth[i] = 2 * per * (bent + out.third[i]);
    }
    return out;
}

// Tries a step of length `stride`. Returns true if it stayed close to the curve: the bend alone must lead
// close to its end, for then the chord is close as well. Newton steps end with one so small that the next one
// would be rounding to what follows, unless the parameter all but turns.
inline bool try_step(const Tracer& tracer, const CurvePoint& from, const Ahead& ahead, double stride,
                     double most_off, CurvePoint& to) {
    constexpr double small = 1e-4, turning = 0.01, third = 1.0 / 6, fourth = 1.0 / 24;
    const Redundant& arm = *tracer.arm;
    const int n = arm.chain.n;
    double bent[max_joints], before[max_joints];
    predict_along(from.q, from.tangent, from.bend, stride, n, bent);
    const double h3 = stride * stride * stride;
    for (int i = 0; i < n; ++i)
        to.q[i] = bent[i] + h3 * (third * ahead.third[i] + fourth * stride * ahead.fourth[i]);
    const auto away_from = [&](const double* predicted) {
        double off = 0;
        for (int i = 0; i < n; ++i) off = max(off, std::fabs(to.q[i] - predicted[i]));
        return off;
    };
    bool is_settled = false;
    for (int pass = 0; pass < 3 && !is_settled; ++pass) {
        for (int i = 0; i < n; ++i) before[i] = to.q[i];
        onto_curve(arm.chain, arm.rank, tracer.goal, arm.length, to);
        is_settled = away_from(before) < small;
    }
    is_settled = is_settled && std::fabs(to.tangent[tracer.parameter]) > turning;
    if (!is_settled) put_on_curve(tracer, to);
    orient_tangent(to.tangent, from.tangent, n);
    return (is_settled || to.error < tolerance::reached) && away_from(bent) < most_off * stride &&
           dot_n(to.tangent, from.tangent, n) > 0.95;
}

// One step. It is shortened until it stays close to the curve and the Jacobian changes little, so that two
// arcs that nearly cross are distinguished. At a crossing the step continues straight to the far side.
// Returns false where the curve cannot be followed.
inline bool step_along_arc(const Tracer& tracer, const CurvePoint& from, Ahead& ahead, double& stride,
                           CurvePoint& to) {
    constexpr double shortest = 1e-7, crossing = 1e-5, most_change = 0.5;
    constexpr double straight = 1e-3;  // a bend this small restrains no step
    const int n = tracer.arm->chain.n;
    const double bend = std::sqrt(dot_n(from.bend, from.bend, n));
    stride = min(min(2 * stride, longest_step(tracer, from)), 0.25 / (bend + straight));
    if (ahead.change > 0) stride = min(stride, 0.9 * most_change / ahead.change);
    bool crosses = false;
    while (stride > shortest) {
        if (!try_step(tracer, from, ahead, stride, most_correction, to)) {
            stride *= 0.5;
            ahead = {};
            continue;
        }
        const auto changed =
            n == 7 && tracer.arm->rank == 6 ? jacobian_change<7, double> : jacobian_change<0, double>;
        const double there = changed(from, to, n);
        const double change = there < most_change ? there : min(there, changed(to, from, n));
        if (change < most_change) {
            ahead = look_ahead(from, to, n);
            ahead.change = change / stride;
            return true;
        }
        if (!crosses && stride < crossing) {
            crosses = true;
            ahead = {};
            if (try_step(tracer, from, ahead, 10 * crossing, 0.01, to)) {
                stride = 10 * crossing;
                return true;
            }
        }
        stride *= max(0.25, 0.8 * most_change / change);
    }
    return false;
}

// The joint that violates its limits at `to`, or −1. side: which limit.
inline int stopped_joint(const Tracer& tracer, const CurvePoint& to, double slack, int& side) {
    const Redundant& arm = *tracer.arm;
    int worst = -1;
    double most = slack;
    for (int i = 0; i < arm.chain.n; ++i) {
        const double over = limit_excess(arm, i, to.q[i]);
        if (!(over > most)) continue;
        most = over;
        worst = i;
    }
    if (worst < 0) return -1;
    const double q = to.q[worst];
    side = std::fabs(joint_difference(arm.chain, worst, q - arm.upper[worst])) <
           std::fabs(joint_difference(arm.chain, worst, q - arm.lower[worst]));
    return worst;
}

// Moves `at` along the curve to the point where joint i is at its limit.
inline void settle_limit(const Tracer& tracer, int i, int side, CurvePoint& at) {
    const Redundant& arm = *tracer.arm;
    constexpr double settled_gap = 1e-13;  // [rad, m] what rounding leaves
    const double limit = limit_of(arm, i, side);
    double along[max_joints];
    for (int j = 0; j < arm.chain.n; ++j) along[j] = at.tangent[j];
    for (int k = 0; k < 12; ++k) {
        const double gap = joint_difference(arm.chain, i, limit - at.q[i]);
        double step =
            gap / (std::fabs(at.tangent[i]) > tolerance::resting ? at.tangent[i] : tolerance::resting);
        step = max(-0.1, min(0.1, step));
        predict_along(at.q, at.tangent, at.bend, step, arm.chain.n, at.q);
        put_on_curve(tracer, at);
        orient_tangent(at.tangent, along, arm.chain.n);
        if (std::fabs(gap) < settled_gap) return;
    }
}

// Whether a prismatic joint without limits has reached the bound up to which the curve is followed.
inline bool is_far(const Tracer& tracer, const double* q) {
    bool far = false;
    for (int i = 0; i < tracer.arm->chain.n && tracer.far > 0; ++i)
        far = far || (tracer.arm->chain.prismatic[i] && std::fabs(q[i]) > tracer.far);
    return far;
}

// The first of the known points at limits that a step passed. Within one step a joint may leave its limits
// and return, or make a full revolution.
inline int point_passed(const Tracer& tracer, const CurvePoint& from, const CurvePoint& to) {
    constexpr double still_there = 1e-6;  // of a step: the point where it starts is not passed again
    double first = 2;
    int found = -1;
    for (int k = 0; k < tracer.points->count; ++k) {
        const double part = part_of_chord(tracer.arm->chain, from.q, to.q, tracer.points->point[k].q);
        if (!(part > still_there && part < first)) continue;
        first = part;
        found = k;
    }
    return found;
}

// Where a step has left the limits, goes back to the first limit that it crossed. Returns the joint that
// stops there.
inline int go_back_to_limit(const Tracer& tracer, CurvePoint& at, int& side) {
    constexpr double outside = 1e-12;  // [rad, m] beyond a limit by more than rounding
    int stop = stopped_joint(tracer, at, outside, side);
    for (int k = 0, next = stop; next >= 0 && k < 4; ++k) {
        stop = next;
        settle_limit(tracer, stop, side, at);
        int other_side = side;
        next = stopped_joint(tracer, at, limit_slack, other_side);
        if (next >= 0) side = other_side;
    }
    return stop;
}

// The joint that stops the step from `at` to `next`, which then ends there; −1 if none does.
inline int stop_at_limit(const Tracer& tracer, const CurvePoint& at, CurvePoint& next, int& side) {
    const Chain& chain = tracer.arm->chain;
    const int passed = point_passed(tracer, at, next);
    if (passed < 0) return go_back_to_limit(tracer, next, side);
    const LimitPoint& point = tracer.points->point[passed];
    for (int i = 0; i < chain.n; ++i) next.q[i] = at.q[i] + joint_difference(chain, i, point.q[i] - at.q[i]);
    put_on_curve(tracer, next);
    orient_tangent(next.tangent, at.tangent, chain.n);
    side = point.side;
    return point.joint;
}

// The point of the curve above a fraction of a chord.
inline CurvePoint point_over_chord(const Tracer& tracer, const CurvePoint& from, const CurvePoint& to,
                                   double part) {
    const int n = tracer.arm->chain.n;
    CurvePoint out;
    for (int i = 0; i < n; ++i) out.q[i] = from.q[i] + part * (to.q[i] - from.q[i]);
    put_on_curve(tracer, out);
    orient_tangent(out.tangent, from.tangent, n);
    return out;
}

// If the parameter turns twice within a step, ends the step between the two turning points. Returns true in
// this case.
inline bool stop_between_turns(const Tracer& tracer, const CurvePoint& at, CurvePoint& next) {
    const int p = tracer.parameter;
    const double sign = at.tangent[p] < 0 ? -1 : 1;
    const double from = sign * at.tangent[p], to = sign * next.tangent[p];
    if (!(to > 0 && sign * at.bend[p] < 0 && sign * next.bend[p] > 0)) return false;
    double slope0 = sign * at.bend[p], part0 = 0, slope1 = sign * next.bend[p], part1 = 1;
    for (int k = 0; k < 4; ++k) {
        const double part = part0 + (part1 - part0) * slope0 / (slope0 - slope1);
        const CurvePoint least = point_over_chord(tracer, at, next, part);
        const double there = sign * least.tangent[p], slope = sign * least.bend[p];
        if (there < 0) {
            next = least;
            return true;
        }
        if (there > 0.5 * min(from, to)) return false;
        (slope < 0 ? slope0 : slope1) = slope;
        (slope < 0 ? part0 : part1) = part;
    }
    return false;
}

// The turning point of the parameter within a step, by Newton's method; by bisection if Newton's method
// leaves the step.
inline CurvePoint turn_between(const Tracer& tracer, const CurvePoint& at, const CurvePoint& next) {
    const Redundant& arm = *tracer.arm;
    const int p = tracer.parameter;
    double low = 0, high = 1;
    CurvePoint fold = point_over_chord(tracer, at, next, at.tangent[p] / (at.tangent[p] - next.tangent[p]));
    if (settle_fold(arm.chain, arm.rank, tracer.goal, arm.length, p, 0.3, fold) &&
        part_of_chord(arm.chain, at.q, next.q, fold.q) >= 0)
        return fold;
    for (int k = 0; k < 45; ++k) {
        const double middle = 0.5 * (low + high);
        fold = point_over_chord(tracer, at, next, middle);
        (fold.tangent[p] * at.tangent[p] > 0 ? low : high) = middle;
    }
    return fold;
}

inline void record_point(Tracer& tracer, const double* q, bool first) {
    Trail& trail = *tracer.trail;
    if (trail.count == Trail::room) {
        tracer.out->complete = false;
        return;
    }
    constexpr double beyond = 1.1;  // of a chord: the chord and its tube
    const int k = trail.count++, n = tracer.arm->chain.n;
    double length2 = 0;
    for (int i = 0; i < n; ++i) {
        trail.q[k][i] = trail.joint[i][k] = q[i];
        if (!first) length2 += (q[i] - trail.q[k - 1][i]) * (q[i] - trail.q[k - 1][i]);
    }
    trail.first_of_arc[k] = first;
    trail.length[k] = std::sqrt(length2);
    trail.reach[k] = first ? -1 : beyond * trail.length[k];
}

// Whether a configuration lies on a traced arc, from trail point `first` on.
inline bool is_on_trail(const Tracer& tracer, const double* q, int first = 0) {
    using V = Pack<4>;
    const Trail& trail = *tracer.trail;
    const Chain& chain = tracer.arm->chain;
    for (int start = first + 1; start < trail.count; start += 4) {
        const int count = std::min(4, trail.count - start);
        const V reach = load_lanes<V>(trail.reach + start, count);
        unsigned near_by = (1u << count) - 1;
        for (int i = 0; i < chain.n && near_by; ++i) {
            const V gap = q[i] - load_lanes<V>(trail.joint[i] + start, count);
            near_by &= bits_of(abs(joint_difference(chain, i, gap)) <= reach);
        }
        for (int k = start; near_by; ++k, near_by >>= 1)
            if (near_by & 1 && part_of_chord(chain, trail.q[k - 1], trail.q[k], q) >= 0) return true;
    }
    return false;
}

}  // namespace cspace::ik::inline CSPACE_ISA
