// The fastest motion along a path within limits of its joints, jerks included.
#pragma once

#include "trajectory_timing.hpp"

namespace cspace::trajectory {

// The launch from rest over the first and the last part of the path, outside of the grid: s = jerk t³ / 6.
struct Launch {
    double length, jerk;  // the largest path jerk
};

struct JerkOptions {
    Launch start, end;
    double duration;   // of a motion to begin with; a slower one is found if it exceeds limits
    double tolerance;  // of the duration
    // Intervals from which on a path is made window by window, in less memory. The first windows are a
    // sixteenth of it.
    std::size_t at_once = 20000;
};

// X (intervals, 3): Bernstein coefficients of the squared path speed, and the path jerks of the launches.
struct JerkTiming {
    bool found;
    std::vector<double> squares;
    double start_jerk, end_jerk, duration;
};

// samples: of the grid, or empty.
JerkTiming time_path_with_jerk(const TimingPath& path, const TimingLimits& limits,
                               std::span<const double> jerk, const TimingGrid& grid,
                               const JerkOptions& options, const TimingSamples& samples);

}  // namespace cspace::trajectory
