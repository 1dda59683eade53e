// The motion of one axis between two moving states: phases of constant jerk, under limits of velocity,
// acceleration and jerk. An infinite jerk limit makes them phases of constant acceleration.
//
// Types end in Of where they hold packs of axes as well as one.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cspace/math/lanes.hpp"

namespace cspace::trajectory {

// min < 0 < max; any of them may be infinite, but not acceleration and jerk together.
template <class V>
struct AxisLimitsOf {
    V v_max, v_min, a_max, a_min, jerk;
    bool has_jerk() const { return jerk < std::numeric_limits<double>::infinity(); }
};
using AxisLimits = AxisLimitsOf<double>;

template <class V>
struct AxisStateOf {
    V p, v, a;
};
using AxisState = AxisStateOf<double>;

// A change of velocity and acceleration. How far an axis gets meanwhile depends on the time that it takes.
template <class V>
struct VelocityChangeOf {
    V v0, a0, vf, af;
    AxisLimitsOf<V> limits;
};
using VelocityChange = VelocityChangeOf<double>;

// A phase of h seconds that begins with acceleration a and has jerk j. Accelerations may jump between phases.
template <class V>
struct PhaseOf {
    V h, a, j;
};
using Phase = PhaseOf<double>;

// Most phases of a motion: two that bring the axis within its limits, and the merged seven of two motions.
inline constexpr int most_phases = 15;

struct Phases {
    int count = 0;
    Phase phase[most_phases];

    void append(const Phase& f) {
        if (f.h > 0) phase[count++] = f;
    }
    double duration() const {
        double sum = 0;
        for (int i = 0; i < count; ++i) sum += phase[i].h;
        return sum;
    }
};

}  // namespace cspace::trajectory

namespace cspace::trajectory::inline CSPACE_ISA {

// The change seen in a mirror: what is farthest in one is nearest in the other.
template <class V>
CSPACE_INLINE VelocityChangeOf<V> mirror_change(const VelocityChangeOf<V>& q) {
    const AxisLimitsOf<V>& l = q.limits;
    return {-q.v0, -q.a0, -q.vf, -q.af, {-l.v_min, -l.v_max, -l.a_min, -l.a_max, l.jerk}};
}

template <class V>
CSPACE_INLINE VelocityChangeOf<V> select_change(mask_of<V> m, const VelocityChangeOf<V>& a,
                                                const VelocityChangeOf<V>& b) {
    const AxisLimitsOf<V>&k = a.limits, &l = b.limits;
    return {select_lanes(m, a.v0, b.v0),
            select_lanes(m, a.a0, b.a0),
            select_lanes(m, a.vf, b.vf),
            select_lanes(m, a.af, b.af),
            {select_lanes(m, k.v_max, l.v_max), select_lanes(m, k.v_min, l.v_min),
             select_lanes(m, k.a_max, l.a_max), select_lanes(m, k.a_min, l.a_min),
             select_lanes(m, k.jerk, l.jerk)}};
}

template <class V>
CSPACE_INLINE AxisStateOf<V> advance_axis(const AxisStateOf<V>& s, const PhaseOf<V>& f) {
    const V h = f.h;
    return {s.p + h * (s.v + h * (f.a / 2 + h * f.j / 6)), s.v + h * (f.a + h * f.j / 2), f.a + h * f.j};
}

// The state before a phase, from that after it.
inline AxisState retreat_axis(const AxisState& s, const Phase& f) {
    const double h = f.h, v = s.v - h * (f.a + h * f.j / 2);
    return {s.p - h * (v + h * (f.a / 2 + h * f.j / 6)), v, f.a};
}

}  // namespace cspace::trajectory::inline CSPACE_ISA
