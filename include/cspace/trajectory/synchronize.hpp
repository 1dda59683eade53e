// Motions of several axes between two states: each in its shortest time, or all in the same one.
//
// The common time is the longest of the shortest times, raised to the next time in which an axis that refuses
// it can attain its goal, until none refuses. A time that is given, or a multiple of a control cycle, is the
// same question.
#pragma once

#include <cstddef>

#include "cspace/trajectory/brake.hpp"
#include "cspace/trajectory/minimum_time.hpp"

namespace cspace::trajectory {

// Relative difference of two durations that are the same: the rounding of the sum of some phases.
inline constexpr double duration_rounding = 1e-12;

// Raises of a common duration, per axis: the durations that an axis refuses are a few intervals, and each is
// passed once.
inline constexpr std::size_t most_raises = 64;

// Largest part of a vector, relative to its largest entry, across a direction that it is parallel to: states
// that a program computed are parallel to rounding, those of files to nine digits.
inline constexpr double parallel_rounding = 1e-9;

// An axis from its start to its goal: what brings it within its limits, and the task after that.
struct Axis {
    Phases phases;  // those of the brake, later all
    double brake_time = 0;
    AxisTask task;
    double shortest = 0;
    ExtremeMotions last{};  // those for the duration that was asked last
};

// All but the shortest time.
inline void set_task(Axis& axis, const AxisState& start, const AxisState& goal, const AxisLimits& limits) {
    axis.phases.count = 0;
    axis.last.T = -1;
    const AxisState within = append_brake({0, start.v, start.a}, limits, axis.phases);
    axis.brake_time = axis.phases.duration();
    const double af = limits.has_jerk() ? goal.a : 0;
    const VelocityChange change{within.v, within.a, goal.v, af, limits};
    axis.task = make_axis_task(change, (goal.p - start.p) - within.p);
}

inline void set_axis(Axis& axis, const AxisState& start, const AxisState& goal, const AxisLimits& limits) {
    set_task(axis, start, goal, limits);
    axis.shortest = axis.brake_time + minimum_time(axis.task);
}

// The next time from T on in which the axis can attain its goal. An axis without motion can wait.
inline double next_duration(Axis& axis, double T) {
    const double next = axis.brake_time + next_time(axis.task, T - axis.brake_time, axis.last);
    return next <= T * (1 + 4 * crossing::epsilon) ? T : next;
}

// The least multiple of a cycle that is not less; the time itself without a cycle.
inline double round_up(double t, double cycle) {
    if (!(cycle > 0)) return t;
    return std::ceil(t / cycle * (1 - 4 * crossing::epsilon)) * cycle;
}

// The next duration from T on that no axis refuses; cycle: of which it is a multiple, or 0. Infinite where
// rounding leaves none, as with limits of velocity below the rounding of the velocities at the start.
inline double common_duration(Axis* axes, std::size_t n, double T, double cycle) {
    T = round_up(T, cycle);
    std::size_t raises = 0;
    for (std::size_t agreed = 0, i = 0; agreed < n; i = (i + 1) % n) {
        const double next = next_duration(axes[i], T);
        agreed = next > T ? 1 : agreed + 1;
        if (next > T) {
            if (++raises > most_raises * n) return never;
            const double rounded = round_up(next, cycle);
            if (rounded > next) agreed = 0;
            T = rounded;
        }
        if (!(T < never)) return never;
    }
    return T;
}

// The motion of the axis in `time`, after its brake; is_still: it has none.
inline Combination combine_axis(const Axis& axis, double time) {
    const AxisTask& x = axis.task;
    if (axis.last.T == time) return combine_motions(x, axis.last.up, axis.last.down);
    return combine_motions(x, find_farthest(x.up, time), find_farthest(x.down, time));
}

inline void finish_axis(Axis& axis, double T) {
    const double time = T - axis.brake_time;
    if (time > 0) append_motion(axis.task, time, combine_axis(axis, time), axis.phases);
}

}  // namespace cspace::trajectory
