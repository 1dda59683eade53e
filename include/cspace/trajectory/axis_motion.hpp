// The motion of one axis between two moving states: phases of constant jerk, under limits of velocity,
// acceleration and jerk. An infinite jerk limit makes them phases of constant acceleration.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace cspace::trajectory {

// min < 0 < max; any of them may be infinite, but not acceleration and jerk together.
struct AxisLimits {
    double v_max, v_min, a_max, a_min, jerk;
    bool has_jerk() const { return jerk < std::numeric_limits<double>::infinity(); }
};

struct AxisState {
    double p, v, a;
};

// A change of velocity and acceleration. How far an axis gets meanwhile depends on the time that it takes.
struct VelocityChange {
    double v0, a0, vf, af;
    AxisLimits limits;
};

// The change seen in a mirror: what is farthest in one is nearest in the other.
inline VelocityChange mirror_change(const VelocityChange& q) {
    const AxisLimits& l = q.limits;
    return {-q.v0, -q.a0, -q.vf, -q.af, {-l.v_min, -l.v_max, -l.a_min, -l.a_max, l.jerk}};
}

// A phase of h seconds that begins with acceleration a and has jerk j. Accelerations may jump between phases.
struct Phase {
    double h, a, j;
};

inline AxisState advance_axis(const AxisState& s, const Phase& f) {
    const double h = f.h;
    return {s.p + h * (s.v + h * (f.a / 2 + h * f.j / 6)), s.v + h * (f.a + h * f.j / 2), f.a + h * f.j};
}

// The state before a phase, from that after it.
inline AxisState retreat_axis(const AxisState& s, const Phase& f) {
    const double h = f.h, v = s.v - h * (f.a + h * f.j / 2);
    return {s.p - h * (v + h * (f.a / 2 + h * f.j / 6)), v, f.a};
}

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
