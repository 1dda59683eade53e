// An arc of the self-motion, followed until a joint stops or the curve closes: steps along the tangent and
// the bend of the curve and back onto it (Allgower & Georg 1990, chapter 6).
#pragma once

#include "cspace/ik/redundant/curve.hpp"
#include "cspace/ik/redundant/intervals.hpp"

namespace cspace {

// All points stepped on, and those arcs' pieces between turns of the held joint.
struct Trail {
    static constexpr int room = 6000;
    int count = 0;
    bool first_of_arc[room];
    double q[room][ik::max_joints];
    bool used[ik::LimitPoints::room];  // limit points that an arc started or ended in
};

struct Tracer {
    const ik::Redundant* arm;
    const ik::LimitPoints* points;
    Posed goal;
    int parameter;
    Trail* trail;
    ik::Intervals* out;
    double far;  // how far slides without limits are followed; 0 if there are none
    int branches = 0;
};

enum class ArcEnd { limit, closed, open, lost };

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

inline void put_on_curve(const Tracer& tracer, CurvePoint& at) {
    for (int k = 0; k < 4; ++k) {
        onto_curve(tracer.arm->chain, tracer.arm->rank, tracer.goal, tracer.arm->length, at);
        if (at.error < 1e-14) break;
    }
}
inline void orient(CurvePoint& at, const double* along, int n) {
    if (dot_n(at.tangent, along, n) >= 0) return;
    for (int i = 0; i < n; ++i) at.tangent[i] = -at.tangent[i];
}

// How far a step may lead: a turning joint by 0.25 rad, slides in proportion where the curve goes far.
inline double longest_step(const Tracer& tracer, const CurvePoint& from) {
    constexpr double longest = 0.25, steps_across = 64;
    if (!(tracer.far > 0)) return longest;
    const double slide = max(longest, tracer.far / steps_across);
    double most = 0;
    for (int i = 0; i < tracer.arm->chain.n; ++i)
        most = max(most, std::fabs(from.tangent[i]) / (tracer.arm->chain.prismatic[i] ? slide : longest));
    return 1 / most;
}

// One step; halved until the curve was followed closely. False where it cannot be followed.
inline bool step_along(const Tracer& tracer, const CurvePoint& from, double& stride, CurvePoint& to) {
    constexpr double shortest = 1e-7;
    const int n = tracer.arm->chain.n;
    const double bend = std::sqrt(dot_n(from.bend, from.bend, n));
    stride = min(min(2 * stride, longest_step(tracer, from)), 0.25 / (bend + 1e-3));
    for (; stride > shortest; stride *= 0.5) {
        double guess[ik::max_joints];
        for (int i = 0; i < n; ++i)
            to.q[i] = guess[i] = from.q[i] + stride * from.tangent[i] + 0.5 * stride * stride * from.bend[i];
        put_on_curve(tracer, to);
        orient(to, from.tangent, n);
        double off = 0;
        for (int i = 0; i < n; ++i) off = max(off, std::fabs(to.q[i] - guess[i]));
        if (to.error < 1e-9 && off < 0.1 * stride && dot_n(to.tangent, from.tangent, n) > 0.9) return true;
    }
    return false;
}

// The joint that has left its limits at `to`, or −1; and which side of them.
inline int stopped_joint(const Tracer& tracer, const CurvePoint& to, double slack, int& side) {
    const ik::Redundant& arm = *tracer.arm;
    int worst = -1;
    double most = slack;
    for (int i = 0; i < arm.chain.n; ++i) {
        const double over = excess(arm, i, to.q[i]);
        if (!(over > most)) continue;
        most = over;
        worst = i;
    }
    if (worst < 0) return -1;
    const double q = to.q[worst], lower = q - arm.lower[worst], upper = q - arm.upper[worst];
    const bool turns = !arm.chain.prismatic[worst];
    side = std::fabs(turns ? short_way(upper) : upper) < std::fabs(turns ? short_way(lower) : lower);
    return worst;
}

// Moves `at` along the curve to where joint i stands at its limit.
inline void settle_limit(const Tracer& tracer, int i, int side, CurvePoint& at) {
    const ik::Redundant& arm = *tracer.arm;
    const double limit = limit_of(arm, i, side);
    double along[ik::max_joints];
    for (int j = 0; j < arm.chain.n; ++j) along[j] = at.tangent[j];
    for (int k = 0; k < 12; ++k) {
        const double gap = arm.chain.prismatic[i] ? limit - at.q[i] : short_way(limit - at.q[i]);
        double step = gap / (std::fabs(at.tangent[i]) > 1e-9 ? at.tangent[i] : 1e-9);
        step = max(-0.1, min(0.1, step));
        for (int j = 0; j < arm.chain.n; ++j)
            at.q[j] += step * at.tangent[j] + 0.5 * step * step * at.bend[j];
        put_on_curve(tracer, at);
        orient(at, along, arm.chain.n);
        if (std::fabs(gap) < 1e-13) return;
    }
}

// Whether a slide without limits has gone as far as it is followed.
inline bool is_far(const Tracer& tracer, const double* q) {
    bool far = false;
    for (int i = 0; i < tracer.arm->chain.n && tracer.far > 0; ++i)
        far = far || (tracer.arm->chain.prismatic[i] && std::fabs(q[i]) > tracer.far);
    return far;
}

// Of the known points at limits the first that a step passed over: a joint may leave its limits and come back
// within one step, or all the way round.
inline int point_passed(const Tracer& tracer, const CurvePoint& from, const CurvePoint& to) {
    const int n = tracer.arm->chain.n;
    double way[ik::max_joints], length2 = 0, first = 2;
    for (int i = 0; i < n; ++i) {
        way[i] = to.q[i] - from.q[i];
        length2 += way[i] * way[i];
    }
    int found = -1;
    for (int k = 0; k < tracer.points->count; ++k) {
        const double* q = tracer.points->point[k].q;
        double gap[ik::max_joints], along = 0, off = 0;
        for (int i = 0; i < n; ++i) {
            const double d = q[i] - from.q[i];
            gap[i] = tracer.arm->chain.prismatic[i] ? d : short_way(d);
            along += gap[i] * way[i];
        }
        const double part = along / length2;
        if (!(part > 1e-6 && part < min(first, 1 + 1e-9))) continue;
        for (int i = 0; i < n; ++i) off = max(off, std::fabs(gap[i] - part * way[i]));
        if (off > 0.06 * std::sqrt(length2)) continue;
        first = part;
        found = k;
    }
    return found;
}

// Where a step has left the limits, back to the first of them that it crossed; the joint that stops there.
inline int go_back_to_limit(const Tracer& tracer, CurvePoint& at, int& side) {
    int stop = stopped_joint(tracer, at, 1e-12, side);
    for (int k = 0, next = stop; next >= 0 && k < 4; ++k) {
        stop = next;
        settle_limit(tracer, stop, side, at);
        int other_side = side;
        next = stopped_joint(tracer, at, limit_slack, other_side);
        if (next >= 0) side = other_side;
    }
    return stop;
}

inline void remember(Tracer& tracer, const double* q, bool first) {
    Trail& trail = *tracer.trail;
    if (trail.count == Trail::room) {
        tracer.out->complete = false;
        return;
    }
    trail.first_of_arc[trail.count] = first;
    for (int i = 0; i < tracer.arm->chain.n; ++i) trail.q[trail.count][i] = q[i];
    ++trail.count;
}

// Marks the known end of an arc.
inline void use_point(Tracer& tracer, const double* q) {
    for (int k = 0; k < tracer.points->count; ++k)
        if (joint_gap(tracer.arm->chain, tracer.points->point[k].q, q) < 1e-6) tracer.trail->used[k] = true;
}

// A piece between two turns of the parameter, from either end of it.
inline void add_piece(Tracer& tracer, const Critical& from, const Critical& to, const double* q) {
    ik::Intervals& out = *tracer.out;
    const bool rising = from.value <= to.value;
    const Critical &low = rising ? from : to, &high = rising ? to : from;
    if (high.value - low.value <= limit_slack) return;
    if (out.count == ik::Intervals::room) {
        out.complete = false;
        return;
    }
    ik::Interval& made = out.interval[out.count++];
    made = {low.value, high.value, tracer.branches++, {low.end, high.end}, {low.side, high.side}, {}};
    if (!tracer.arm->chain.prismatic[tracer.parameter]) {
        const double home =
            ik::is_stopped(*tracer.arm, tracer.parameter)
                ? 0.5 * (tracer.arm->lower[tracer.parameter] + tracer.arm->upper[tracer.parameter])
                : 0;
        const double middle = 0.5 * (low.value + high.value);
        const double turns = 2 * pi * std::round((middle - home) / (2 * pi));
        made.lower -= turns;
        made.upper -= turns;
    }
    for (int i = 0; i < tracer.arm->chain.n; ++i) made.q[i] = q[i];
}

// Follows the curve from `at` (its tangent says which way) until a joint stops or the curve closes. `start`
// says what the arc begins with.
inline ArcEnd follow_arc(Tracer& tracer, CurvePoint at, Critical start) {
    constexpr int most_steps = 3000;
    const ik::Redundant& arm = *tracer.arm;
    const int n = arm.chain.n, p = tracer.parameter;
    const CurvePoint origin = at;
    const int first_piece = tracer.out->count;
    double stride = 0.02, middle[ik::max_joints], home = 0, travel = 0;
    for (int i = 0; i < n; ++i) middle[i] = at.q[i];
    remember(tracer, at.q, true);
    for (int k = 0; k < most_steps; ++k) {
        CurvePoint next;
        if (!step_along(tracer, at, stride, next)) return ArcEnd::lost;
        int side = 0;
        int stop = go_back_to_limit(tracer, next, side);
        const int passed = point_passed(tracer, at, next);
        if (passed >= 0) {
            const ik::LimitPoint& point = tracer.points->point[passed];
            for (int i = 0; i < n; ++i) {
                const double gap = point.q[i] - at.q[i];
                next.q[i] = at.q[i] + (arm.chain.prismatic[i] ? gap : short_way(gap));
            }
            put_on_curve(tracer, next);
            orient(next, at.tangent, n);
            stop = point.joint;
            side = point.side;
        }
        if (at.tangent[p] * next.tangent[p] < 0) {
            CurvePoint fold = at;
            const double part = at.tangent[p] / (at.tangent[p] - next.tangent[p]);
            for (int i = 0; i < n; ++i) fold.q[i] += part * (next.q[i] - at.q[i]);
            if (settle_fold(arm.chain, arm.rank, tracer.goal, arm.length, p, 0.3, fold)) {
                add_piece(tracer, start, {fold.q[p], ik::end_fold, 0}, middle);
                start = {fold.q[p], ik::end_fold, 0};
                for (int i = 0; i < n; ++i) middle[i] = fold.q[i];
            }
        } else {
            for (int i = 0; i < n; ++i) middle[i] = at.q[i];
        }
        remember(tracer, next.q, false);
        if (stop >= 0) {
            use_point(tracer, next.q);
            add_piece(tracer, start, {next.q[p], stop, side}, middle);
            return ArcEnd::limit;
        }
        if (is_far(tracer, next.q)) {
            add_piece(tracer, start, {next.q[p], ik::end_none, 0}, middle);
            return ArcEnd::open;
        }
        travel += next.q[p] - at.q[p];
        // Back at the origin, from where the arc may have started in the middle of a piece.
        const double before = home;
        home = 0;
        for (int i = 0; i < n; ++i) {
            const double gap = origin.q[i] - next.q[i];
            home += (arm.chain.prismatic[i] ? gap : short_way(gap)) * next.tangent[i];
        }
        double away = 0;
        for (int i = 0; i < n; ++i) {
            const double gap = origin.q[i] - next.q[i];
            away = max(away,
                       std::fabs((arm.chain.prismatic[i] ? gap : short_way(gap)) - home * next.tangent[i]));
        }
        if (k > 2 && before > 0 && home <= 0 && home > -0.5 && away < 0.05 &&
            dot_n(origin.tangent, next.tangent, n) > 0.5) {
            const double value = next.q[p] + home * next.tangent[p];
            if (tracer.out->count == first_piece) {
                if (std::fabs(travel) < pi)
                    return ArcEnd::closed;  // it rests, at the one value that it can have
                add_piece(tracer, {-pi, ik::end_none, 0}, {pi, ik::end_none, 0}, middle);
                return ArcEnd::closed;
            }
            ik::Interval& head = tracer.out->interval[first_piece];
            // The first piece began at the origin: it reaches back to the last fold instead.
            const double turns = 2 * pi * std::round((0.5 * (head.lower + head.upper) - value) / (2 * pi));
            const double fold = start.value + turns;
            const bool low = fold < 0.5 * (head.lower + head.upper);
            (low ? head.lower : head.upper) = fold;
            head.end[low ? 0 : 1] = ik::end_fold;
            return ArcEnd::closed;
        }
        at = next;
    }
    return ArcEnd::lost;
}

// Whether a configuration lies on an arc that was followed: between two of its points.
inline bool is_on_trail(const Tracer& tracer, const double* q) {
    const Trail& trail = *tracer.trail;
    const int n = tracer.arm->chain.n;
    for (int k = 1; k < trail.count; ++k) {
        if (trail.first_of_arc[k]) continue;
        const double *a = trail.q[k - 1], *b = trail.q[k];
        double along = 0, length2 = 0, gap[ik::max_joints], off = 0;
        for (int i = 0; i < n; ++i) {
            gap[i] = tracer.arm->chain.prismatic[i] ? q[i] - a[i] : short_way(q[i] - a[i]);
            along += gap[i] * (b[i] - a[i]);
            length2 += (b[i] - a[i]) * (b[i] - a[i]);
        }
        const double part = length2 > 0 ? along / length2 : 0;
        if (part < -0.1 || part > 1.1) continue;
        for (int i = 0; i < n; ++i) off = max(off, std::fabs(gap[i] - part * (b[i] - a[i])));
        if (off < 0.03) return true;
    }
    return false;
}

}  // namespace cspace::inline CSPACE_ISA
