// What an axis reaches in a given time: the interval of displacements from P_min(T) to P_max(T).
//
// The motions of one axis that change its state as asked within a time T form a convex set, so what they
// reach is an interval. P_max(T) belongs to the motion +J, hold a_max, −J, cruise at v_max, −J, hold a_min,
// +J. With its peak p and trough l of acceleration and no hold,
//   p − l = w = (JT + a0 − af) / 2,   p + l = κ / w,   κ = JΔv + (a0² − af²) / 2.
// P_min(T) is −P_max(T) of the mirrored change. dP_max/dT is the velocity at the start of −J plus
// p (p − l) / (2J), or v_max in a cruise. P_max is concave at first (the head), then convex, then straight.
//
// V is one axis or a pack of axes; without a limit of jerk it is one.
#pragma once

#include "cspace/trajectory/axis_motion.hpp"

namespace cspace::trajectory {

enum class Regime { free, peak_held, trough_held, both_held, cruise };

// The times of +J, hold, −J, cruise, −J, hold, +J, and the accelerations of the holds.
template <class V>
struct SevenPhasesOf {
    V t[7] = {}, peak{}, trough{};
};
using SevenPhases = SevenPhasesOf<double>;

template <class V>
struct ReachOf {
    V displacement, slope, bend;  // and its first two derivatives by T
    V regime;                     // the number of a Regime
    SevenPhasesOf<V> phases;
};
using Reach = ReachOf<double>;

}  // namespace cspace::trajectory

namespace cspace::trajectory::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE V duration_of(const SevenPhasesOf<V>& f) {
    return f.t[0] + f.t[1] + f.t[2] + f.t[3] + f.t[4] + f.t[5] + f.t[6];
}

// The i-th phase; a0: the acceleration at first.
template <class V>
CSPACE_INLINE PhaseOf<V> phase_of(const SevenPhasesOf<V>& f, int i, V a0, V jerk) {
    const V zero = fill_lanes<V>(0.0);
    switch (i) {
        case 0:
            return {f.t[0], a0, jerk};
        case 1:
            return {f.t[1], f.peak, zero};
        case 2:
            return {f.t[2], f.peak, -jerk};
        case 3:
            return {f.t[3], zero, zero};
        case 4:
            return {f.t[4], min(f.peak, zero), -jerk};
        case 5:
            return {f.t[5], f.trough, zero};
        default:
            return {f.t[6], f.trough, jerk};
    }
}

template <class V>
CSPACE_INLINE V displace_axis(const VelocityChangeOf<V>& q, const SevenPhasesOf<V>& phases) {
    AxisStateOf<V> s{fill_lanes<V>(0.0), q.v0, q.a0};
    for (int i = 0; i < 7; ++i) {
        // Phases of no length may have infinite jerks, if there is no limit.
        if constexpr (Lanes<V>::count == 1)
            if (!(phases.t[i] > 0)) continue;
        s = advance_axis(s, phase_of(phases, i, q.a0, q.limits.jerk));
    }
    return s.p;
}

namespace reach {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
// Relative rounding of a hold that may be negative by it.
inline constexpr double time_rounding = 1e-12;
// Relative rounding of accelerations, up to which a peak is at its limit and not above it, and up to which a
// change is one by a single phase.
inline constexpr double acceleration_rounding = 1e-14;

template <class V>
CSPACE_INLINE V root_or_zero(V x) {
    return sqrt(max(x, fill_lanes<V>(0.0)));
}
template <class V>
CSPACE_INLINE V not_negative(V x) {
    return max(x, fill_lanes<V>(0.0));
}
template <class V>
CSPACE_INLINE V number_of(Regime regime) {
    return fill_lanes<V>(double(regime));
}

// Peak p and trough l of acceleration, how long they are held, and d²P/dT² without a cruise.
template <class V>
struct Peaks {
    V p, l, hold_p, hold_l, bend, regime;

    CSPACE_INLINE void replace(mask_of<V> m, const Peaks& k) {
        p = select_lanes(m, k.p, p);
        l = select_lanes(m, k.l, l);
        hold_p = select_lanes(m, k.hold_p, hold_p);
        hold_l = select_lanes(m, k.hold_l, hold_l);
        bend = select_lanes(m, k.bend, bend);
        regime = select_lanes(m, k.regime, regime);
    }
};

// What rounding may leave of the square of the distance from a held acceleration to the other one, where it
// is zero.
template <class V>
CSPACE_INLINE V square_rounding(const VelocityChangeOf<V>& q, V T, V held) {
    const V a0 = q.a0, af = q.af;
    return acceleration_rounding *
           (q.limits.jerk * (abs(q.vf - q.v0) + abs(held) * T) + a0 * a0 + af * af + 4 * held * held);
}

// With p = a_max where `asked`; returns where l and the hold are possible.
template <class V>
CSPACE_INLINE mask_of<V> hold_peak(const VelocityChangeOf<V>& q, V T, mask_of<V> asked, Peaks<V>& found) {
    const V J = q.limits.jerk, a0 = q.a0, af = q.af, p = q.limits.a_max, dv = q.vf - q.v0;
    const V c = J * dv - J * p * T + p * (2 * p + af - a0) - (2 * p * p - a0 * a0 + af * af) / 2;
    const V s2 = p * p - c;
    const V l = min(c / (p + root_or_zero(s2)), p), hold = T - (2 * (p - l) + af - a0) / J;
    const auto fits =
        asked && s2 >= -square_rounding(q, T, p) && l >= q.limits.a_min && hold >= -time_rounding * T;
    const V bend = p * (p - 4 * l) / (4 * (p - l));
    found.replace(fits,
                  {p, l, not_negative(hold), fill_lanes<V>(0.0), bend, number_of<V>(Regime::peak_held)});
    return fits;
}

// With l = a_min, likewise.
template <class V>
CSPACE_INLINE mask_of<V> hold_trough(const VelocityChangeOf<V>& q, V T, mask_of<V> asked, Peaks<V>& found) {
    const V J = q.limits.jerk, a0 = q.a0, af = q.af, l = q.limits.a_min, dv = q.vf - q.v0;
    const V c = J * l * T - l * (af - a0 - 2 * l) + (af * af - a0 * a0 - 2 * l * l) / 2 - J * dv;
    const V s2 = l * l - c;
    const V p = max(-c / (root_or_zero(s2) - l), l), hold = T - (2 * (p - l) + af - a0) / J;
    const auto fits =
        asked && s2 >= -square_rounding(q, T, l) && p <= q.limits.a_max && hold >= -time_rounding * T;
    const V bend = -l * (4 * p - l) / (4 * (p - l));
    found.replace(fits,
                  {p, l, fill_lanes<V>(0.0), not_negative(hold), bend, number_of<V>(Regime::trough_held)});
    return fits;
}

template <class V>
CSPACE_INLINE Peaks<V> hold_both(const VelocityChangeOf<V>& q, V T) {
    const V J = q.limits.jerk, a0 = q.a0, af = q.af, p = q.limits.a_max, l = q.limits.a_min;
    const V time = T - (2 * (p - l) + af - a0) / J;
    const V change = q.vf - q.v0 - (2 * p * p - a0 * a0 + af * af - 2 * l * l) / (2 * J);
    const V hold = (change - l * time) / (p - l);
    return {p,
            l,
            not_negative(hold),
            not_negative(time - hold),
            -p * l / (p - l),
            number_of<V>(Regime::both_held)};
}

template <class V>
CSPACE_INLINE Peaks<V> find_peaks(const VelocityChangeOf<V>& q, V T) {
    const V J = q.limits.jerk, a0 = q.a0, af = q.af, zero = fill_lanes<V>(0.0);
    const V w = not_negative((J * T + a0 - af) / 2);
    const V kappa = J * (q.vf - q.v0) + (a0 * a0 - af * af) / 2;
    // All phases last zero or more for p between a0 and af + w.
    const V ratio = kappa / w, most = max(af + w, a0);
    const auto lasts = w > 0;
    const V p = select_lanes(lasts, min(max((w + ratio) / 2, a0), most), a0);
    const V bend = select_lanes(lasts, (3 * w - kappa * kappa / (w * w * w)) / 8, zero);
    Peaks<V> found{p, select_lanes(lasts, p - w, a0), zero, zero, bend, number_of<V>(Regime::free)};
    const V slack = acceleration_rounding * (abs(found.p) + abs(found.l));
    const auto high = found.p > q.limits.a_max + slack, low = found.l < q.limits.a_min - slack;
    auto open = high || low;
    if (!any(open)) return found;
    if (any(high)) open = open && !hold_peak(q, T, high, found);
    if (any(low && open)) open = open && !hold_trough(q, T, low && open, found);
    if (any(open)) found.replace(open, hold_both(q, T));
    return found;
}

// From (v, a) to v_max without acceleration, +J, hold, −J: the times into t[0], t[1], t[2]. Returns the peak.
template <class V>
CSPACE_INLINE V climb_to_cruise(V v, V a, V v_max, V a_max, V J, V* t) {
    V p = max(root_or_zero(J * (v_max - v) + a * a / 2), a), hold = fill_lanes<V>(0.0);
    const auto is_held = p > a_max;
    if (any(is_held)) {
        const V held = max(a_max, a);
        const V time = not_negative((v_max - v - (2 * held * held - a * a) / (2 * J)) / held);
        p = select_lanes(is_held, held, p);
        hold = select_lanes(is_held, time, hold);
    }
    t[0] = (p - a) / J;
    t[1] = hold;
    t[2] = p / J;
    return p;
}

inline SevenPhases touch_cruise_by_acceleration(const VelocityChange& q) {
    const AxisLimits& l = q.limits;
    SevenPhases f;
    f.peak = l.a_max;
    f.trough = l.a_min;
    f.t[1] = (l.v_max - q.v0) / l.a_max;
    f.t[5] = (q.vf - l.v_max) / l.a_min;
    return f;
}

// The shortest motion that attains v_max between its ends.
template <class V>
CSPACE_INLINE SevenPhasesOf<V> touch_cruise(const VelocityChangeOf<V>& q) {
    const AxisLimitsOf<V>& l = q.limits;
    if constexpr (Lanes<V>::count == 1)
        if (!l.has_jerk()) return touch_cruise_by_acceleration(q);
    SevenPhasesOf<V> f;
    f.peak = climb_to_cruise(q.v0, q.a0, l.v_max, l.a_max, l.jerk, f.t);
    V back[3];  // the same backwards in time, where accelerations change their sign
    f.trough = -climb_to_cruise(q.vf, -q.af, l.v_max, -l.a_min, l.jerk, back);
    f.t[4] = back[2];
    f.t[5] = back[1];
    f.t[6] = back[0];
    return f;
}

// Where m is set, the motion that cruises.
template <class V>
CSPACE_INLINE void replace_by_cruise(mask_of<V> m, const VelocityChangeOf<V>& q, V T, ReachOf<V>& r) {
    SevenPhasesOf<V> f = touch_cruise(q);
    f.t[3] = not_negative(T - duration_of(f));
    for (int i = 0; i < 7; ++i) r.phases.t[i] = select_lanes(m, f.t[i], r.phases.t[i]);
    r.phases.peak = select_lanes(m, f.peak, r.phases.peak);
    r.phases.trough = select_lanes(m, f.trough, r.phases.trough);
    r.slope = select_lanes(m, q.limits.v_max, r.slope);
    r.bend = select_lanes(m, fill_lanes<V>(0.0), r.bend);
    r.regime = select_lanes(m, number_of<V>(Regime::cruise), r.regime);
}

// With accelerations that jump: a_max up to a velocity, then a_min.
inline Reach reach_by_accelerations(const VelocityChange& q, double T) {
    const double up = 1 / q.limits.a_max, down = -1 / q.limits.a_min;
    const double top = (T + q.v0 * up + q.vf * down) / (up + down);
    Reach r{0, top, 1 / (up + down), double(Regime::both_held), {}};
    r.phases.peak = q.limits.a_max;
    r.phases.trough = q.limits.a_min;
    r.phases.t[1] = std::max((top - q.v0) * up, 0.0);
    r.phases.t[5] = std::max((top - q.vf) * down, 0.0);
    if (top > q.limits.v_max) replace_by_cruise(true, q, T, r);
    r.displacement = displace_axis(q, r.phases);
    return r;
}

}  // namespace reach

// P_max(T) and its motion; T lies in the domain of the change.
template <class V>
inline ReachOf<V> find_farthest(const VelocityChangeOf<V>& q, V T) {
    using namespace reach;
    if constexpr (Lanes<V>::count == 1)
        if (!q.limits.has_jerk()) return reach_by_accelerations(q, T);
    const V J = q.limits.jerk, a0 = q.a0, zero = fill_lanes<V>(0.0);
    const Peaks<V> k = find_peaks(q, T);
    const V v_fall = q.v0 + (k.p * k.p - a0 * a0) / (2 * J) + k.p * k.hold_p;  // where −J begins
    ReachOf<V> r{zero, v_fall + k.p * (k.p - k.l) / (2 * J), k.bend, k.regime, {}};
    SevenPhasesOf<V>& f = r.phases;
    f.peak = k.p;
    f.trough = k.l;
    f.t[0] = not_negative((k.p - a0) / J);
    f.t[1] = k.hold_p;
    const V above = max(k.p, zero) - max(k.l, zero);  // of the fall from p to l, that above zero
    f.t[2] = above / J;
    f.t[4] = ((k.p - k.l) - above) / J;
    f.t[5] = k.hold_l;
    f.t[6] = not_negative((q.af - k.l) / J);
    const auto cruises = k.p > 0 && k.l < 0 && v_fall + k.p * k.p / (2 * J) > q.limits.v_max;
    if (any(cruises)) replace_by_cruise<V>(cruises, q, T, r);
    r.displacement = displace_axis(q, f);
    return r;
}

// Times in which a change is possible: from first to gap_begin and from gap_end on; what the axis is
// displaced by at their beginnings, where nothing else can be reached.
template <class V>
struct DomainOf {
    V first, gap_begin, gap_end, displacement, displacement_after_gap;
    mask_of<V> has_gap;
};
using Domain = DomainOf<double>;

template <class V>
CSPACE_INLINE mask_of<V> is_in_domain(const DomainOf<V>& d, V T) {
    return T >= d.first && !(d.has_gap && T > d.gap_begin && T < d.gap_end);
}

namespace reach {

// The change by +J, hold, −J (p above both accelerations).
template <class V>
CSPACE_INLINE SevenPhasesOf<V> change_upwards(const VelocityChangeOf<V>& q) {
    const V J = q.limits.jerk, dv = q.vf - q.v0, a0 = q.a0, af = q.af, higher = max(a0, af);
    V p = max(root_or_zero(J * dv + (a0 * a0 + af * af) / 2), higher), hold = fill_lanes<V>(0.0);
    const auto is_held = p > q.limits.a_max;
    if (any(is_held)) {
        const V held = max(q.limits.a_max, higher);
        const V time = not_negative((dv - (2 * held * held - a0 * a0 - af * af) / (2 * J)) / held);
        p = select_lanes(is_held, held, p);
        hold = select_lanes(is_held, time, hold);
    }
    SevenPhasesOf<V> f;
    f.peak = p;
    f.trough = af;
    f.t[0] = (p - a0) / J;
    f.t[1] = hold;
    f.t[2] = (p - af) / J;
    return f;
}

// The change by −J, hold, +J.
template <class V>
CSPACE_INLINE SevenPhasesOf<V> change_downwards(const VelocityChangeOf<V>& q) {
    const SevenPhasesOf<V> f = change_upwards(mirror_change(q));
    SevenPhasesOf<V> g;
    g.peak = q.a0;
    g.trough = -f.peak;
    g.t[2] = not_negative(q.a0) / q.limits.jerk;
    g.t[4] = (min(q.a0, fill_lanes<V>(0.0)) - g.trough) / q.limits.jerk;
    g.t[5] = f.t[1];
    g.t[6] = f.t[2];
    return g;
}

inline Domain find_domain_by_acceleration(const VelocityChange& q) {
    SevenPhases f;
    f.peak = q.limits.a_max;
    f.trough = q.limits.a_min;
    const double dv = q.vf - q.v0;
    (dv > 0 ? f.t[1] : f.t[5]) = dv / (dv > 0 ? f.peak : f.trough);
    return {duration_of(f), infinity, infinity, displace_axis(q, f), 0, false};
}

}  // namespace reach

template <class V>
inline DomainOf<V> find_domain(const VelocityChangeOf<V>& q) {
    using namespace reach;
    if constexpr (Lanes<V>::count == 1)
        if (!q.limits.has_jerk()) return find_domain_by_acceleration(q);
    const V J = q.limits.jerk, dv = q.vf - q.v0, a0 = q.a0, af = q.af, zero = fill_lanes<V>(0.0);
    const V ramp =
        select_lanes(af >= a0, fill_lanes<V>(1.0), fill_lanes<V>(-1.0)) * (af - a0) * (af + a0) / (2 * J);
    // A single phase is the shortest change both ways, but upwards not between negative accelerations.
    const V gap = J * (dv - ramp), size = J * abs(dv) + a0 * a0 + af * af;
    const auto is_ramp = abs(gap) <= acceleration_rounding * size;
    const auto upwards = (is_ramp && !(a0 < 0 && af < 0)) || (!is_ramp && gap > 0);
    const VelocityChangeOf<V> u = select_change<V>(upwards, q, mirror_change(q));
    const SevenPhasesOf<V> f = change_upwards(u);
    const V never = fill_lanes<V>(infinity), displaced = displace_axis(u, f);
    const V room = (u.a0 * u.a0 + u.af * u.af) / 2 - J * (u.vf - u.v0);
    DomainOf<V> d{duration_of(f), never,
                  never,          select_lanes(upwards, displaced, -displaced),
                  zero,           u.a0 > 0 && u.af > 0 && room > 0};
    if (any(d.has_gap)) {
        const SevenPhasesOf<V> g = change_downwards(u);
        const V begin = max((u.a0 + u.af - 2 * root_or_zero(room)) / J, d.first), after = displace_axis(u, g);
        d.gap_begin = select_lanes(d.has_gap, begin, never);
        d.gap_end = select_lanes(d.has_gap, duration_of(g), never);
        d.displacement_after_gap = select_lanes(upwards, after, -after);
    }
    return d;
}

}  // namespace cspace::trajectory::inline CSPACE_ISA
