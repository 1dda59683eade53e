// What an axis reaches in a given time: the interval of displacements from P_min(T) to P_max(T).
//
// The motions of one axis that change its state as asked within a time T form a convex set, so what they
// reach is an interval. P_max(T) belongs to the motion +J, hold a_max, −J, cruise at v_max, −J, hold a_min,
// +J. With its peak p and trough l of acceleration and no hold,
//   p − l = w = (JT + a0 − af) / 2,   p + l = κ / w,   κ = JΔv + (a0² − af²) / 2.
// P_min(T) is −P_max(T) of the mirrored change. dP_max/dT is the velocity at the start of −J plus
// p (p − l) / (2J), or v_max in a cruise. P_max is concave at first (the head), then convex, then straight.
#pragma once

#include "cspace/trajectory/axis_motion.hpp"

namespace cspace::trajectory {

enum class Regime { free, peak_held, trough_held, both_held, cruise };

// The times of +J, hold, −J, cruise, −J, hold, +J, and the accelerations of the holds.
struct SevenPhases {
    double t[7] = {}, peak = 0, trough = 0;

    double duration() const { return t[0] + t[1] + t[2] + t[3] + t[4] + t[5] + t[6]; }
    // The i-th phase; a0: the acceleration at first.
    Phase phase(int i, double a0, double jerk) const {
        switch (i) {
            case 0:
                return {t[0], a0, jerk};
            case 1:
                return {t[1], peak, 0};
            case 2:
                return {t[2], peak, -jerk};
            case 3:
                return {t[3], 0, 0};
            case 4:
                return {t[4], std::min(peak, 0.0), -jerk};
            case 5:
                return {t[5], trough, 0};
            default:
                return {t[6], trough, jerk};
        }
    }
};

struct Reach {
    double displacement, slope, bend;  // and its first two derivatives by T
    Regime regime;
    SevenPhases phases;
};

inline double displace_axis(const VelocityChange& q, const SevenPhases& phases) {
    AxisState s{0, q.v0, q.a0};
    for (int i = 0; i < 7; ++i)
        if (phases.t[i] > 0) s = advance_axis(s, phases.phase(i, q.a0, q.limits.jerk));
    return s.p;
}

namespace reach {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
// Relative rounding of a hold that may be negative by it.
inline constexpr double time_rounding = 1e-12;
// Relative rounding of accelerations, up to which a peak is at its limit and not above it, and up to which a
// change is one by a single phase.
inline constexpr double acceleration_rounding = 1e-14;

inline double square(double x) { return x * x; }
inline double root(double x) { return std::sqrt(std::max(x, 0.0)); }

// Peak p and trough l of acceleration, and how long they are held.
struct Peaks {
    double p, l, hold_p = 0, hold_l = 0;
    Regime regime = Regime::free;
};

// With p = a_max; false if l or the hold are not possible.
inline bool hold_peak(const VelocityChange& q, double T, Peaks& found) {
    const double J = q.limits.jerk, a0 = q.a0, af = q.af, p = q.limits.a_max, dv = q.vf - q.v0;
    const double c = J * dv - J * p * T + p * (2 * p + af - a0) - (2 * p * p - a0 * a0 + af * af) / 2;
    const double s2 = p * p - c;
    if (s2 < 0) return false;
    const double l = c / (p + std::sqrt(s2)), hold = T - (2 * (p - l) + af - a0) / J;
    if (l < q.limits.a_min || hold < -time_rounding * T) return false;
    found = {p, l, std::max(hold, 0.0), 0, Regime::peak_held};
    return true;
}

// With l = a_min, likewise.
inline bool hold_trough(const VelocityChange& q, double T, Peaks& found) {
    const double J = q.limits.jerk, a0 = q.a0, af = q.af, l = q.limits.a_min, dv = q.vf - q.v0;
    const double c = J * l * T - l * (af - a0 - 2 * l) + (af * af - a0 * a0 - 2 * l * l) / 2 - J * dv;
    const double s2 = l * l - c;
    if (s2 < 0) return false;
    const double p = -c / (std::sqrt(s2) - l), hold = T - (2 * (p - l) + af - a0) / J;
    if (p > q.limits.a_max || hold < -time_rounding * T) return false;
    found = {p, l, 0, std::max(hold, 0.0), Regime::trough_held};
    return true;
}

inline Peaks hold_both(const VelocityChange& q, double T) {
    const double J = q.limits.jerk, a0 = q.a0, af = q.af, p = q.limits.a_max, l = q.limits.a_min;
    const double time = T - (2 * (p - l) + af - a0) / J;
    const double change = q.vf - q.v0 - (2 * p * p - a0 * a0 + af * af - 2 * l * l) / (2 * J);
    const double hold = (change - l * time) / (p - l);
    return {p, l, std::max(hold, 0.0), std::max(time - hold, 0.0), Regime::both_held};
}

inline Peaks find_peaks(const VelocityChange& q, double T) {
    const double J = q.limits.jerk, a0 = q.a0, af = q.af;
    const double w = std::max((J * T + a0 - af) / 2, 0.0),
                 kappa = J * (q.vf - q.v0) + (a0 * a0 - af * af) / 2;
    // All phases last zero or more for p between a0 and af + w.
    const double least = a0, most = std::max(af + w, a0);
    const double p = w > 0 ? std::clamp((w + kappa / w) / 2, least, most) : a0;
    Peaks found{p, w > 0 ? p - w : a0};
    const double slack = acceleration_rounding * (std::fabs(found.p) + std::fabs(found.l));
    const bool high = found.p > q.limits.a_max + slack, low = found.l < q.limits.a_min - slack;
    if (!high && !low) return found;
    if (high && hold_peak(q, T, found)) return found;
    if (low && hold_trough(q, T, found)) return found;
    return hold_both(q, T);
}

// d²P/dT² of a motion without a cruise.
inline double bend_of(const Peaks& k, double w, double kappa) {
    switch (k.regime) {
        case Regime::free:
            return w > 0 ? (3 * w - kappa * kappa / (w * w * w)) / 8 : 0;
        case Regime::peak_held:
            return k.p * (k.p - 4 * k.l) / (4 * (k.p - k.l));
        case Regime::trough_held:
            return -k.l * (4 * k.p - k.l) / (4 * (k.p - k.l));
        case Regime::both_held:
            return -k.p * k.l / (k.p - k.l);
        default:
            return 0;
    }
}

// From (v, a) to v_max without acceleration, +J, hold, −J: the times into t[0], t[1], t[2]. Returns the peak.
inline double climb_to_cruise(double v, double a, double v_max, double a_max, double J, double* t) {
    double p = std::max(root(J * (v_max - v) + a * a / 2), a), hold = 0;
    if (p > a_max) {
        p = std::max(a_max, a);
        hold = std::max((v_max - v - (2 * p * p - a * a) / (2 * J)) / p, 0.0);
    }
    t[0] = (p - a) / J;
    t[1] = hold;
    t[2] = p / J;
    return p;
}

// The shortest motion that attains v_max between its ends.
inline SevenPhases touch_cruise(const VelocityChange& q) {
    const AxisLimits& l = q.limits;
    SevenPhases f;
    if (!l.has_jerk()) {
        f.peak = l.a_max;
        f.trough = l.a_min;
        f.t[1] = (l.v_max - q.v0) / l.a_max;
        f.t[5] = (q.vf - l.v_max) / l.a_min;
        return f;
    }
    f.peak = climb_to_cruise(q.v0, q.a0, l.v_max, l.a_max, l.jerk, f.t);
    double back[3];  // the same backwards in time, where accelerations change their sign
    f.trough = -climb_to_cruise(q.vf, -q.af, l.v_max, -l.a_min, l.jerk, back);
    f.t[4] = back[2];
    f.t[5] = back[1];
    f.t[6] = back[0];
    return f;
}

inline Reach cruise_for(const VelocityChange& q, double T) {
    Reach r{0, q.limits.v_max, 0, Regime::cruise, touch_cruise(q)};
    r.phases.t[3] = std::max(T - r.phases.duration(), 0.0);
    r.displacement = displace_axis(q, r.phases);
    return r;
}

// With accelerations that jump: a_max up to a velocity, then a_min.
inline Reach reach_by_accelerations(const VelocityChange& q, double T) {
    const double up = 1 / q.limits.a_max, down = -1 / q.limits.a_min;
    const double top = (T + q.v0 * up + q.vf * down) / (up + down);
    if (top > q.limits.v_max) return cruise_for(q, T);
    Reach r{0, top, 1 / (up + down), Regime::both_held, {}};
    r.phases.peak = q.limits.a_max;
    r.phases.trough = q.limits.a_min;
    r.phases.t[1] = std::max((top - q.v0) * up, 0.0);
    r.phases.t[5] = std::max((top - q.vf) * down, 0.0);
    r.displacement = displace_axis(q, r.phases);
    return r;
}

}  // namespace reach

// P_max(T) and its motion; T lies in the domain of the change.
inline Reach find_farthest(const VelocityChange& q, double T) {
    using namespace reach;
    if (!q.limits.has_jerk()) return reach_by_accelerations(q, T);
    const double J = q.limits.jerk, a0 = q.a0, af = q.af;
    const Peaks k = find_peaks(q, T);
    const double v_fall = q.v0 + (k.p * k.p - a0 * a0) / (2 * J) + k.p * k.hold_p;  // where −J begins
    if (k.p > 0 && k.l < 0 && v_fall + k.p * k.p / (2 * J) > q.limits.v_max) return cruise_for(q, T);
    const double w = (J * T + a0 - af) / 2, kappa = J * (q.vf - q.v0) + (a0 * a0 - af * af) / 2;
    Reach r{0, v_fall + k.p * (k.p - k.l) / (2 * J), bend_of(k, w, kappa), k.regime, {}};
    SevenPhases& f = r.phases;
    f.peak = k.p;
    f.trough = k.l;
    f.t[0] = std::max((k.p - a0) / J, 0.0);
    f.t[1] = k.hold_p;
    const double above = std::max(k.p, 0.0) - std::max(k.l, 0.0);  // of the fall from p to l, that above zero
    f.t[2] = above / J;
    f.t[4] = ((k.p - k.l) - above) / J;
    f.t[5] = k.hold_l;
    f.t[6] = std::max((af - k.l) / J, 0.0);
    r.displacement = displace_axis(q, f);
    return r;
}

// Times in which a change is possible: from first to gap_begin and from gap_end on; what the axis is
// displaced by at their beginnings, where nothing else can be reached.
struct Domain {
    double first, gap_begin, gap_end, displacement, displacement_after_gap;
    bool has_gap;
};

inline bool is_in_domain(const Domain& d, double T) {
    return T >= d.first && !(d.has_gap && T > d.gap_begin && T < d.gap_end);
}

namespace reach {

// The change by +J, hold, −J (p above both accelerations).
inline SevenPhases change_upwards(const VelocityChange& q) {
    const double J = q.limits.jerk, dv = q.vf - q.v0, a0 = q.a0, af = q.af;
    double p = std::max({root(J * dv + (a0 * a0 + af * af) / 2), a0, af}), hold = 0;
    if (p > q.limits.a_max) {
        p = std::max({q.limits.a_max, a0, af});
        hold = std::max((dv - (2 * p * p - a0 * a0 - af * af) / (2 * J)) / p, 0.0);
    }
    SevenPhases f;
    f.peak = p;
    f.trough = af;
    f.t[0] = (p - a0) / J;
    f.t[1] = hold;
    f.t[2] = (p - af) / J;
    return f;
}

// The change by −J, hold, +J.
inline SevenPhases change_downwards(const VelocityChange& q) {
    const SevenPhases f = change_upwards(mirror_change(q));
    SevenPhases g;
    g.peak = q.a0;
    g.trough = -f.peak;
    g.t[2] = std::max(q.a0, 0.0) / q.limits.jerk;
    g.t[4] = (std::min(q.a0, 0.0) - g.trough) / q.limits.jerk;
    g.t[5] = f.t[1];
    g.t[6] = f.t[2];
    return g;
}

inline SevenPhases change_by_acceleration(const VelocityChange& q) {
    SevenPhases f;
    f.peak = q.limits.a_max;
    f.trough = q.limits.a_min;
    const double dv = q.vf - q.v0;
    (dv > 0 ? f.t[1] : f.t[5]) = dv / (dv > 0 ? f.peak : f.trough);
    return f;
}

}  // namespace reach

inline Domain find_domain(const VelocityChange& q) {
    using namespace reach;
    if (!q.limits.has_jerk()) {
        const SevenPhases f = change_by_acceleration(q);
        return {f.duration(), infinity, infinity, displace_axis(q, f), 0, false};
    }
    const double J = q.limits.jerk, dv = q.vf - q.v0, a0 = q.a0, af = q.af;
    const double ramp = (af >= a0 ? 1 : -1) * (af - a0) * (af + a0) / (2 * J);
    // A single phase is the shortest change both ways, but upwards not between negative accelerations.
    const double gap = J * (dv - ramp), size = J * std::fabs(dv) + a0 * a0 + af * af;
    const bool is_ramp = std::fabs(gap) <= acceleration_rounding * size;
    const bool upwards = is_ramp ? !(a0 < 0 && af < 0) : gap > 0;
    const VelocityChange u = upwards ? q : mirror_change(q);
    const double sign = upwards ? 1 : -1;
    const SevenPhases f = change_upwards(u);
    Domain d{f.duration(), infinity, infinity, sign * displace_axis(u, f), 0, false};
    const double room = (u.a0 * u.a0 + u.af * u.af) / 2 - J * (u.vf - u.v0);
    if (u.a0 > 0 && u.af > 0 && room > 0) {
        const SevenPhases g = change_downwards(u);
        d.has_gap = true;
        d.gap_begin = std::max((u.a0 + u.af - 2 * std::sqrt(room)) / J, d.first);
        d.gap_end = g.duration();
        d.displacement_after_gap = sign * displace_axis(u, g);
    }
    return d;
}

}  // namespace cspace::trajectory
