// The fastest motion along a path of polynomials within limits of its joints.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "cspace/trajectory/path_rows.hpp"
#include "library/trajectory_path.hpp"

namespace cspace::trajectory {

// Largest magnitudes (joints,), inf where absent; a limit of 0 is one of a joint that does not move.
struct TimingLimits {
    std::span<const double> velocity, acceleration;
};

// Parts of pieces, in order; both arrays (intervals,), places within a piece in [0, 1].
struct TimingGrid {
    std::vector<int> piece;
    std::vector<double> from, to;

    std::size_t size() const { return piece.size(); }
    Intervals view() const { return {piece.data(), from.data(), to.data()}; }
};

// Limits that are sampled along the path, as of SampledLimits: along, across, offset (3 intervals, joints) or
// empty, margin (intervals, joints) or empty, limit (joints,), inverse_square (intervals, 3) or empty.
struct TimingSamples {
    std::vector<double> along, across, offset, margin, limit, inverse_square;
};
using Sampler = std::function<TimingSamples(const TimingGrid&)>;

struct TimingOptions {
    double start, end;  // path speeds
    // Of the duration: halving of intervals ends where it changes the duration less. Not used with a grid.
    double tolerance;
};

// What came of it: "timed" alone is a motion. blocked: no speed passes interval `where`. stands: it stands at
// both ends of interval `where`. start, end: the speed there is not in [least, most].
enum class TimingOutcome { timed, blocked, stands, start, end };

struct Timing {
    TimingOutcome outcome;
    std::size_t where;
    double least, most;                 // path speeds
    TimingGrid grid;                    // empty if one was given
    std::vector<double> squared_speed;  // (intervals + 1,)
    std::vector<double> rises;          // (intervals,)
    bool converged;                     // the halving ended before its limits
};

// About so many intervals, two or more in each piece.
TimingGrid divide_evenly(const TimingPath& path, std::size_t intervals);

// The fastest motion on a grid. sample may be empty. rises (intervals,): of the squared speeds, or empty.
Timing time_on_grid(const TimingPath& path, const TimingLimits& limits, const TimingOptions& options,
                    const TimingGrid& grid, const Sampler& sample, std::vector<double> rises);
// The same on a grid that is halved where this changes the duration.
Timing time_path(const TimingPath& path, const TimingLimits& limits, const TimingOptions& options,
                 const Sampler& sample);

// Seconds from the start to each place of a grid (intervals + 1,): intervals of these lengths between squared
// speeds (intervals + 1,), with rises (intervals,).
void sum_times(std::span<const double> lengths, std::span<const double> squared_speed,
               std::span<const double> rises, double* times);

}  // namespace cspace::trajectory
