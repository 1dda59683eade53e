// When an axis can be where it is asked to be: the shortest time, the next time from a given one on, and the
// motion for any time in which it can.
//
// A displacement P can be attained in T if T lies in the domain and P_min(T) ≤ P ≤ P_max(T). P_max crosses a
// level at most three times: once or twice in its concave head, then once.
#pragma once

#include "cspace/trajectory/reach_interval.hpp"

namespace cspace::trajectory {

inline constexpr double never = std::numeric_limits<double>::infinity();

// What is asked of an axis: to change its state and to be displaced by P meanwhile.
template <class V>
struct AxisTaskOf {
    VelocityChangeOf<V> up, down;  // the change and its mirror image
    V P;
    DomainOf<V> domain;
};
using AxisTask = AxisTaskOf<double>;

}  // namespace cspace::trajectory

namespace cspace::trajectory::inline CSPACE_ISA {

namespace crossing {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
inline constexpr int most_steps = 200;  // bisection alone needs 64, and 30 more from any magnitude
inline constexpr int first_steps = 30;  // after which a bracket that is still wide is halved in logarithms,
inline constexpr double wide = 1024;    // from this ratio of its ends on
inline constexpr double widest = 1e16;  // and at most: a bracket may begin at zero

template <class V>
struct Value {
    V value, slope, bend;
};

// The geometric mean of the ends of a bracket, of which the first may be zero.
template <class V>
CSPACE_INLINE V halve_magnitudes(V low, V high) {
    return sqrt(max(low, high * (1 / widest))) * sqrt(high);
}

// The time between low and high at which f, which is below zero at low and not at high, is zero: Halley's
// method in a bracket, where `asked`. f(T) returns value, slope and bend.
template <class V, class F>
CSPACE_INLINE V find_root(V low, V high, mask_of<V> asked, const F& f) {
    V x = high;
    auto open = asked;
    for (int i = 0; i < most_steps; ++i) {
        const Value<V> e = f(x);
        const auto above = e.value > 0, met = e.value == 0;
        high = select_lanes(open && above, x, high);
        low = select_lanes(open && !above, x, low);
        const V halley = 2 * e.slope * e.slope - e.value * e.bend;
        const V step = select_lanes(halley > 0, 2 * e.value * e.slope / halley, e.value / e.slope);
        V next = x - step;
        const auto inside = next > low && next < high;
        // A step that leaves the bracket by rounding alone has arrived.
        const auto stays = met || (!inside && abs(next - x) <= 2 * epsilon * x);
        next = select_lanes(inside || stays, next, 0.5 * (low + high));
        if (i >= first_steps)  // steps from far above only halve the time
            next = select_lanes(!stays && high > wide * low, halve_magnitudes(low, high), next);
        const auto arrived = abs(next - x) <= 2 * epsilon * x || high - low <= 2 * epsilon * high;
        x = select_lanes(open && !stays, next, x);
        open = open && !stays && !arrived;
        if (!any(open)) return x;
    }
    return select_lanes(open, high, x);
}

// When P_max(T) = P between low, where it is less, and high, where it is not.
template <class V>
CSPACE_INLINE V find_crossing(const VelocityChangeOf<V>& q, V P, V low, V high, mask_of<V> asked) {
    return find_root<V>(low, high, asked, [&](V T) {
        const ReachOf<V> r = find_farthest(q, T);
        return Value<V>{r.displacement - P, r.slope, r.bend};
    });
}

// The end of the concave head of P_max, where its second derivative becomes positive; it is before `low`
// where P_max is convex there.
template <class V>
CSPACE_INLINE V end_of_head(const VelocityChangeOf<V>& q) {
    const V J = q.limits.jerk, a0 = q.a0, af = q.af, dv = q.vf - q.v0;
    const V kappa = J * dv + (a0 * a0 - af * af) / 2, size = abs(kappa), w = sqrt(size / std::sqrt(3.0));
    const auto time_of = [&](V width) { return (2 * width - a0 + af) / J; };
    const V p = (w + kappa / w) / 2, l = p - w;
    const auto is_free = !(w > 0) || (p <= q.limits.a_max && l >= q.limits.a_min);
    // p is held at a_max up to where l = p / 4 or p is no longer held; likewise l.
    const V held = select_lanes(kappa > 0, q.limits.a_max, -q.limits.a_min);
    const V until = (held * (9.0 / 16 * held + af - a0) + size) / (J * held);
    const V beyond = held * held - size;  // below zero: it is held for ever
    const V while_held =
        select_lanes(beyond < 0, until, min(until, time_of(held - reach::root_or_zero(beyond))));
    return select_lanes(is_free, time_of(w), while_held);
}

// A time in low … high, within the head, at which P_max ≥ P, if there is one; else where it is largest.
template <class V>
CSPACE_INLINE V top_of_head(const VelocityChangeOf<V>& q, V P, V low, V high, mask_of<V> asked) {
    V x = high;
    auto open = asked;
    for (int i = 0; i < most_steps; ++i) {
        open = open && high - low > 2 * epsilon * high;
        if (!any(open)) break;
        const ReachOf<V> r = find_farthest(q, x);
        const auto rises = r.slope > 0;
        open = open && r.displacement < P;
        if (i == 0) open = open && r.slope < 0;
        low = select_lanes(open && rises, x, low);
        high = select_lanes(open && !rises, x, high);
        const V next = x - r.slope / r.bend;
        x = select_lanes(open, select_lanes(next > low && next < high, next, 0.5 * (low + high)), x);
    }
    return x;
}

}  // namespace crossing

template <class V>
CSPACE_INLINE AxisTaskOf<V> make_axis_task(const VelocityChangeOf<V>& q, V P) {
    return {q, mirror_change(q), P, find_domain(q)};
}

// What rounding may leave of a displacement.
template <class V>
CSPACE_INLINE V displacement_rounding(const AxisTaskOf<V>& x, V T) {
    constexpr double roundings = 64 * std::numeric_limits<double>::epsilon();
    const VelocityChangeOf<V>& q = x.up;
    const V by_acceleration = max(q.limits.a_max, -q.limits.a_min) * T, by_jerk = q.limits.jerk * T * T;
    // An infinite acceleration times T = 0 is NaN, which min leaves out.
    const V swing = select_lanes(q.limits.jerk < never, min(by_acceleration, by_jerk), by_acceleration);
    const V fastest = min(abs(q.v0) + abs(q.vf) + swing, max(q.limits.v_max, -q.limits.v_min));
    return roundings * (abs(x.P) + T * fastest);
}

// Where `asked`, the first time from A to B at which P_max(T) ≥ P, where P_max(A) < P and A … B lies in the
// domain. slack: by how much P_max may fall short of P at the end of a part of the domain, and where it turns
// back.
template <class V>
inline V first_reached(const VelocityChangeOf<V>& q, V P, V A, V B, V slack, mask_of<V> asked) {
    using namespace crossing;
    V found = fill_lanes<V>(never), low = A, high = B;
    auto open = asked, crosses = open && !open;
    // At the end of the head or of the part: a crossing before it, or within the slack.
    const auto decide = [&](mask_of<V> here, V end) {
        const V most = find_farthest(q, end).displacement;
        const auto reached = here && most >= P, nearly = here && !reached && most >= P - slack;
        high = select_lanes(reached, end, high);
        found = select_lanes(nearly, end, found);
        crosses = crosses || reached;
        open = open && !reached && !nearly;
    };
    const ReachOf<V> first = find_farthest(q, A);
    const auto head = open && first.bend < 0;
    if (any(head)) {
        const V end = min(max(end_of_head(q), A), B);
        decide(head, top_of_head(q, P, A, end, head));
        A = select_lanes(head && open, end, A);
        low = select_lanes(open, A, low);
        open = open && A < B;
    }
    const auto ends = open && B < never;
    if (any(ends)) {
        decide(ends, B);
        open = open && !ends;
    }
    const auto straight = open && q.limits.v_max < never;
    if (any(straight)) {
        const SevenPhasesOf<V> touch = reach::touch_cruise(q);
        const V on = duration_of(touch), at = displace_axis(q, touch), v = q.limits.v_max;
        const auto passed = straight && on <= A, later = straight && !passed && P >= at;
        if (any(passed)) found = select_lanes(passed, A + (P - find_farthest(q, A).displacement) / v, found);
        found = select_lanes(later, on + (P - at) / v, found);
        const auto before = straight && !passed && !later;
        high = select_lanes(before, on, high);
        crosses = crosses || before;
        open = open && !straight;
    }
    if (any(open)) {
        V far = select_lanes(A > 0, 2 * A, fill_lanes<V>(1.0));
        for (auto shorter = open; any(shorter); far = select_lanes(shorter, 2 * far, far))
            shorter = shorter && find_farthest(q, far).displacement < P;
        high = select_lanes(open, far, high);
        crosses = crosses || open;
    }
    if (any(crosses)) found = select_lanes(crosses, find_crossing<V>(q, P, low, high, crosses), found);
    return found;
}

// The two extreme motions for a time.
struct ExtremeMotions {
    double T = -1;
    Reach up, down;
};

// Where `asked`, the first time from A to B, a part of the domain, in which P can be attained; at A the axis
// is displaced by up at most and by down at least.
template <class V>
CSPACE_INLINE V first_in_part(const AxisTaskOf<V>& x, V A, V B, V down, V up, mask_of<V> asked) {
    const V slack = displacement_rounding(x, A);
    const auto rises = x.P > up + slack, moves = asked && (rises || x.P < down - slack);
    if (!any(moves)) return A;
    const VelocityChangeOf<V> q = select_change<V>(rises, x.up, x.down);
    return select_lanes(moves, first_reached<V>(q, select_lanes(rises, x.P, -x.P), A, B, slack, moves), A);
}

// The shortest time.
template <class V>
CSPACE_INLINE V minimum_time(const AxisTaskOf<V>& x) {
    const DomainOf<V>& d = x.domain;
    const V P0 = d.displacement, P1 = d.displacement_after_gap;
    const auto all_axes = P0 == P0 || P0 != P0;
    const V T = first_in_part<V>(x, d.first, d.gap_begin, P0, P0, all_axes);
    const auto later = !(T < never) && d.has_gap;
    if (!any(later)) return T;
    return select_lanes(later, first_in_part<V>(x, d.gap_end, fill_lanes<V>(never), P1, P1, later), T);
}

// The next time not before T in which P can be attained; the extreme motions for T, if they were needed.
inline double next_time(const AxisTask& x, double T, ExtremeMotions& at) {
    const Domain& d = x.domain;
    if (T <= d.first) return minimum_time(x);
    const auto next_in_part = [&](double B) {
        at = {T, find_farthest(x.up, T), find_farthest(x.down, T)};
        return first_in_part(x, T, B, -at.down.displacement, at.up.displacement, true);
    };
    if (d.has_gap && T <= d.gap_begin) {
        const double found = next_in_part(d.gap_begin);
        if (found < never) return found;
    }
    const double P1 = d.displacement_after_gap;
    if (d.has_gap && T <= d.gap_end) return first_in_part(x, d.gap_end, never, P1, P1, true);
    return next_in_part(never);
}

// How an axis moves that attains P in T: by the combination θ up + (1 − θ) down of the two extreme motions,
// which keeps all limits because they are convex.
template <class V>
struct CombinationOf {
    V theta;
    V up[7], down[7];  // the times of the phases of both
};
using Combination = CombinationOf<double>;

template <class V>
CSPACE_INLINE CombinationOf<V> combine_motions(const AxisTaskOf<V>& x, const ReachOf<V>& up,
                                               const ReachOf<V>& down) {
    const V width = up.displacement + down.displacement, one = fill_lanes<V>(1.0);
    const V share = min(reach::not_negative((x.P + down.displacement) / width), one);
    CombinationOf<V> made;
    made.theta = select_lanes(width > 0, share, one);
    for (int i = 0; i < 7; ++i) {
        made.up[i] = up.phases.t[i];
        made.down[i] = down.phases.t[i];
    }
    return made;
}

// The motion in T, and where it is possible: elsewhere T is outside of the domain, or P of the interval.
template <class V>
inline mask_of<V> attain_in(const AxisTaskOf<V>& x, V T, CombinationOf<V>& made) {
    const ReachOf<V> up = find_farthest(x.up, T), down = find_farthest(x.down, T);
    const V slack = displacement_rounding(x, T);
    made = combine_motions(x, up, down);
    return T > x.domain.first && is_in_domain(x.domain, T) && x.P <= up.displacement + slack &&
           x.P >= -down.displacement - slack;
}

namespace crossing {

// A moment of a motion: the time since its start, or until its end, so that phases near either end of a long
// motion have no more than their own rounding.
struct Moment {
    double time;
    bool until_end;
};

// The time from one moment of a motion of T seconds to another.
inline double time_between(const Moment& a, const Moment& b, double T) {
    if (a.until_end == b.until_end) return a.until_end ? a.time - b.time : b.time - a.time;
    const double rest = T - a.time - b.time;
    return a.until_end ? -rest : rest;
}

// A motion of seven phases as its part of a convex combination: the phase at a moment, and when it ends.
struct Walk {
    const SevenPhases& f;
    double a0, jerk, sign, T;
    Moment ends[8];  // from the start on
    int i = 0;

    Walk(const SevenPhases& phases, const VelocityChange& change, double side, double duration)
        : f(phases), a0(change.a0), jerk(change.limits.jerk), sign(side), T(duration) {
        // What the sum of the phases differs from T by is that of the longest one.
        const int longest = int(std::max_element(f.t, f.t + 7) - f.t);
        ends[0] = {0, false};
        ends[7] = {0, true};
        for (int k = 1; k <= longest; ++k) ends[k] = {ends[k - 1].time + f.t[k - 1], false};
        for (int k = 6; k > longest; --k) ends[k] = {ends[k + 1].time + f.t[k], true};
    }
    const Moment& end() const { return ends[i + 1]; }
    void advance_to(const Moment& now) {
        while (i < 6 && !(time_between(now, end(), T) > 0)) ++i;
    }
    Phase at(const Moment& now) const {
        const Phase p = phase_of(f, i, a0, jerk);
        const double j = std::isfinite(p.j) ? p.j : 0;
        return {time_between(now, end(), T), sign * (p.a + j * time_between(ends[i], now, T)), sign * j};
    }
};

// The phases of an extreme motion from their times. Peaks differ from their limits by rounding alone.
inline SevenPhases restore_phases(const VelocityChange& q, const double* t) {
    const AxisLimits& l = q.limits;
    SevenPhases f;
    std::copy_n(t, 7, f.t);
    f.peak = l.has_jerk() ? std::min(q.a0 + l.jerk * t[0], std::max(l.a_max, q.a0)) : l.a_max;
    f.trough = l.has_jerk() ? std::max(q.af - l.jerk * t[6], std::min(l.a_min, q.af)) : l.a_min;
    return f;
}

}  // namespace crossing

// Whether an axis rests and stays where it is.
inline bool is_still(const AxisTask& x) {
    const VelocityChange& q = x.up;
    return x.P == 0 && q.v0 == 0 && q.vf == 0 && q.a0 == 0 && q.af == 0;
}

// Appends the phases of a motion of T seconds.
inline void append_motion(const AxisTask& x, double T, const Combination& combination, Phases& out) {
    using namespace crossing;
    if (is_still(x)) return out.append({T, 0, 0});
    const SevenPhases up = restore_phases(x.up, combination.up),
                      down = restore_phases(x.down, combination.down);
    const double theta = combination.theta, other = 1 - theta;
    Walk a(up, x.up, 1, T), b(down, x.down, -1, T);
    for (Moment now{0, false};;) {
        a.advance_to(now);
        b.advance_to(now);
        const Phase f = a.at(now), g = b.at(now);
        const Moment next = time_between(a.end(), b.end(), T) >= 0 ? a.end() : b.end();
        const double h = time_between(now, next, T);
        if (!(h > 0)) return;
        out.append({h, theta * f.a + other * g.a, theta * f.j + other * g.j});
        now = next;
    }
}

}  // namespace cspace::trajectory::inline CSPACE_ISA
