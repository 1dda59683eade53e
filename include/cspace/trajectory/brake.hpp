// Brings an axis that moves beyond its limits, or is bound to leave them, back within them.
//
// The acceleration returns within its limits first, at full jerk. A velocity that is too high, or will be by
// the time the acceleration is gone, is lowered at full jerk and acceleration until it is v_max, unless it
// would then fall below v_min. After that every limit is kept.
#pragma once

#include "cspace/trajectory/reach_interval.hpp"

namespace cspace::trajectory {

namespace brake {

// The velocity at which the acceleration is zero, by jerk j.
inline double velocity_at_rest(const AxisState& s, double j) { return s.v + s.a * s.a / (2 * j); }

// Two phases, −J and then a hold, that lower the velocity to v_max.
inline void lower_velocity(const AxisState& s, const AxisLimits& l, double* h) {
    const double J = l.jerk;
    const double to_v_max = s.a / J + reach::root_or_zero(s.a * s.a + 2 * J * (s.v - l.v_max)) / J;
    const double to_v_min = s.a / J + reach::root_or_zero(s.a * s.a / 2 + J * (s.v - l.v_min)) / J;
    const double first = std::min(to_v_max, to_v_min), to_a_min = (s.a - l.a_min) / J;
    h[0] = std::max(first, 0.0);
    if (!(to_a_min < first)) return;
    h[0] = std::max(to_a_min, 0.0);
    const double v = s.v + h[0] * (s.a - h[0] * J / 2);
    const double held_to_v_max = -(v - l.v_max) / l.a_min;
    const double held_to_v_min = l.a_min / (2 * J) - (v - l.v_min) / l.a_min;
    h[1] = std::max(std::min(held_to_v_max, held_to_v_min), 0.0);
}

// An acceleration above a_max: −J down to it, or on, where the velocity is too high as well.
inline void lower_acceleration(const AxisState& s, const AxisLimits& l, double* h) {
    const double J = l.jerk, to_a_max = (s.a - l.a_max) / J;
    if (velocity_at_rest(s, J) > l.v_max) return lower_velocity(s, l, h);
    h[0] = to_a_max;
    const double v = s.v + to_a_max * (s.a - to_a_max * J / 2);
    if (v >= l.v_min) return;
    const double to_v_min = (l.v_min - v) / l.a_max;
    const double to_v_max = (l.v_max - v) / l.a_max - l.a_max / (2 * J);
    h[1] = std::max(std::min(to_v_min, to_v_max), 0.0);
}

inline AxisLimits mirror_limits(const AxisLimits& l) {
    return {-l.v_min, -l.v_max, -l.a_min, -l.a_max, l.jerk};
}

// Whether the velocity is too high and lowering it helps, or will be too high.
inline bool is_too_fast(const AxisState& s, const AxisLimits& l) {
    return (s.v > l.v_max && velocity_at_rest(s, -l.jerk) > l.v_min) ||
           (s.a > 0 && velocity_at_rest(s, l.jerk) > l.v_max);
}

// The phases, of the state or of its mirror image; false if none are needed.
inline bool find_phases(const AxisState& s, const AxisLimits& l, double* h, double& jerk, double& sign) {
    const AxisState m{-s.p, -s.v, -s.a};
    const AxisLimits n = mirror_limits(l);
    sign = s.a > l.a_max || (s.a >= l.a_min && is_too_fast(s, l)) ? 1 : -1;
    const AxisState& t = sign > 0 ? s : m;
    const AxisLimits& k = sign > 0 ? l : n;
    jerk = -k.jerk;
    if (t.a > k.a_max)
        lower_acceleration(t, k, h);
    else if (is_too_fast(t, k))
        lower_velocity(t, k, h);
    else
        return false;
    return true;
}

}  // namespace brake

// Appends what is needed to bring an axis within its limits, and returns the state after it.
inline AxisState append_brake(AxisState s, const AxisLimits& l, Phases& out) {
    if (!l.has_jerk()) {
        s.a = 0;
        const double beyond = s.v > l.v_max ? s.v - l.v_max : std::min(s.v - l.v_min, 0.0);
        if (beyond == 0) return s;
        const double a = beyond > 0 ? l.a_min : l.a_max;
        out.append({-beyond / a, a, 0});
        s = advance_axis(s, {-beyond / a, a, 0});
        return {s.p, beyond > 0 ? l.v_max : l.v_min, 0};
    }
    double h[2] = {}, jerk, sign;
    if (!brake::find_phases(s, l, h, jerk, sign)) return s;
    for (int i = 0; i < 2; ++i) {
        if (!(h[i] > 0)) continue;
        const Phase f{h[i], s.a, i == 0 ? sign * jerk : 0};
        out.append(f);
        s = advance_axis(s, f);
    }
    return s;
}

}  // namespace cspace::trajectory
