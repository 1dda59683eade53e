#include "trajectory_timing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cspace/math/interrupts.hpp"
#include "kernels/trajectory_timing.hpp"
#include "trajectory_aligned.hpp"
#include "trajectory_halving.hpp"

namespace cspace::trajectory {

using std::size_t;

// 1 / limit, 0 where there is none and where the joint may not move.
std::vector<double> invert_limits(std::span<const double> limits, int padded) {
    std::vector<double> made(size_t(padded), 0.0);
    for (size_t j = 0; j < limits.size(); ++j) made[j] = limits[j] > 0.0 ? 1.0 / limits[j] : 0.0;
    return made;
}

// Bernstein coefficients of dq/ds of every piece, raised to degree 2 or 4, as TimedRows has them.
Aligned find_slopes(const TimingPath& path, int degree, int padded) {
    const int own = path.degree - 1, n = path.joints;
    const size_t width = size_t(padded);
    Aligned slopes(path.lengths.size() * size_t(degree + 1) * width);
    for (size_t piece = 0; piece < path.lengths.size(); ++piece) {
        const double* q = path.controls.data() + piece * size_t((path.degree + 1) * n);
        double* d = slopes.data() + piece * size_t(degree + 1) * width;
        const double scale = path.degree / path.lengths[piece];
        for (int k = 0; k <= own; ++k)
            for (int j = 0; j < n; ++j) d[k * padded + j] = scale * (q[(k + 1) * n + j] - q[k * n + j]);
        for (int m = own; m < degree; ++m) {  // one degree more
            for (int j = 0; j < n; ++j) d[(m + 1) * padded + j] = d[m * padded + j];
            for (int k = m; k > 0; --k) {
                const double share = double(k) / (m + 1);
                for (int j = 0; j < n; ++j)
                    d[k * padded + j] += share * (d[(k - 1) * padded + j] - d[k * padded + j]);
            }
        }
    }
    return slopes;
}

namespace {

std::vector<double> pad_rows(std::span<const double> rows, int width, int padded) {
    std::vector<double> made(rows.size() / size_t(width) * size_t(padded), 0.0);
    for (size_t r = 0; r * size_t(width) < rows.size(); ++r)
        std::copy_n(rows.begin() + std::ptrdiff_t(r) * width, width,
                    made.begin() + std::ptrdiff_t(r) * padded);
    return made;
}

}  // namespace

TimingSamples pad_samples(TimingSamples samples, int joints, int padded) {
    if (samples.along.empty()) return samples;
    for (auto* rows : {&samples.along, &samples.across, &samples.offset, &samples.margin})
        *rows = pad_rows(*rows, joints, padded);
    samples.limit.resize(size_t(padded), no_end);  // what pads the joints has none
    return samples;
}

SampledLimits show_samples(const TimingSamples& samples) {
    const auto data = [](const std::vector<double>& rows) { return rows.empty() ? nullptr : rows.data(); };
    return {data(samples.along),  data(samples.across), data(samples.offset),
            data(samples.margin), data(samples.limit),  data(samples.inverse_square)};
}

namespace {

constexpr size_t intervals_between_polls = 256;  // some fifty microseconds
constexpr size_t many_intervals = 1 << 16;       // memory is given back where it counts
constexpr int first_parts = 4;                   // of a piece: halved once before anything is known of it
constexpr int most_rounds = 24;
constexpr int blocked_rounds = 6;      // in which there may be no motion yet
constexpr double series_below = 0.01;  // argument below which six terms of a series are exact
constexpr size_t least_parts = 2;      // of a piece: with stops at both its ends it has to move between
// Where all slopes vanish the path speed is bounded by their rounding alone, relative to the largest slopes
// of the piece: multiples of squared speed at which it is a hundredth of what a limit may be exceeded by.
constexpr double noise_of_velocity = 1e-8, noise_of_acceleration = 1e-4;

// artanh(√z) / √z, which is arctan(√−z) / √−z for negative z.
double inverse_tangent(double z) {
    if (std::fabs(z) < series_below)
        return 1.0 + z * (1.0 / 3 + z * (1.0 / 5 + z * (1.0 / 7 + z * (1.0 / 9 + z * (1.0 / 11 + z / 13)))));
    const double root = std::sqrt(std::fabs(z));
    return (z > 0.0 ? std::atanh(root) : std::atan(root)) / root;
}

// The time D ∫ dσ / √X of an interval of length D, with the sum of the speeds at its ends and its rise.
double pass_seconds(double length, double speeds, double rise) {
    const double ratio = 1.0 / speeds;
    return 2.0 * length * ratio * (rise == 0.0 ? 1.0 : inverse_tangent(-2.0 * rise * ratio * ratio));
}

// A path that is timed on one grid after another.
class PathTimer {
  public:
    PathTimer(const TimingPath& path, const TimingLimits& limits, const TimingOptions& options)
        : path_(path),
          start_(options.start * options.start),
          end_(options.end * options.end),
          padded_(padded_joints(path.joints)),
          slopes_(find_slopes(path, slope_degree(path), padded_)),
          acceleration_(invert_limits(limits.acceleration, padded_)),
          velocity_(invert_limits(limits.velocity, padded_)),
          least_inverse_square_(path.lengths.size(), 0.0) {
        rows_.degree = slope_degree(path);
        rows_.joints = path.joints;
        rows_.padded = padded_;
        rows_.slopes = slopes_.data();
        rows_.lengths = path.lengths.data();
        rows_.inverse_acceleration = acceleration_.data();
        rows_.inverse_velocity = velocity_.data();
        bound_noise();
        rows_.least_inverse_square = least_inverse_square_.data();
        memory_ = Aligned(size_t(3 * row_capacity(rows_)));
    }

    // The grid has to last as long as it is timed.
    void set_grid(const TimingGrid& grid, const Sampler& sample) {
        count_ = grid.size();
        stops_.assign(count_ + 1, 0);
        visit_range(0, count_, [&](size_t i) {
            if (grid.from[i] == 0.0) stops_[i] = path_.stops[size_t(grid.piece[i])];
        });
        rows_.intervals = grid.view();
        rows_.stops = stops_.data();
        rows_.sampled = {};
        if (!sample) return;
        samples_ = pad_samples(sample(grid), path_.joints, padded_);
        rows_.sampled = show_samples(samples_);
    }

    // The fastest motion whose squared speed rises above a line as given (intervals,).
    Timing solve(std::vector<double> rises) {
        Timing timing{TimingOutcome::timed, 0, 0.0, 0.0, {}, {}, std::move(rises), true};
        rows_.rises = timing.rises.data();
        const std::ptrdiff_t blocked = bound({end_, end_});
        if (blocked >= 0) {
            if (end_ > 0.0) return explain_end(timing);
            timing.outcome = TimingOutcome::blocked;
            timing.where = size_t(blocked);
            return timing;
        }
        if (start_ < range_[0].low && end_ > 0.0) return explain_end(timing);
        if (!(range_[0].low <= start_ && start_ <= range_[0].high))
            return report(timing, TimingOutcome::start, range_[0]);
        timing.squared_speed.assign(count_ + 1, 0.0);
        raise(timing.squared_speed);
        if (count_ > many_intervals) range_ = {};
        return timing;
    }

    // The same, or without rises where those leave no motion.
    Timing solve_or_flatten(std::vector<double> rises) {
        const bool is_flat = std::all_of(rises.begin(), rises.end(), [](double rise) { return rise == 0.0; });
        Timing timing = solve(std::move(rises));
        if (is_flat || timing.outcome == TimingOutcome::timed) return timing;
        return solve(std::vector<double>(count_, 0.0));
    }

    // The seconds of every interval.
    Passing measure(const Timing& timing) const {
        Passing passing;
        passing.seconds.resize(count_);
        visit_range(0, count_, [&](size_t i) {
            const double speeds = std::sqrt(timing.squared_speed[i]) + std::sqrt(timing.squared_speed[i + 1]);
            passing.stands |= speeds == 0.0;
            if (speeds > 0.0) passing.seconds[i] = pass_seconds(rows_.length(i), speeds, timing.rises[i]);
            passing.total += passing.seconds[i];
        });
        return passing;
    }

    // The rises of a law with these squared speeds, were it smooth: of the second derivatives at both ends of
    // an interval the smaller one, and none where they differ in sign. Where pieces meet there is none; the
    // next one inside the piece stands for it.
    std::vector<double> find_rises(const std::vector<double>& x) const {
        std::vector<double> second(count_ + 1, 0.0), rises(count_, 0.0);
        const Intervals& grid = rows_.intervals;
        visit_range(1, count_, [&](size_t i) {
            const double before = rows_.length(i - 1), after = rows_.length(i);
            const double bend = (x[i + 1] - x[i]) / after - (x[i] - x[i - 1]) / before;
            second[i] = 2.0 * bend / (before + after);
        });
        visit_range(0, count_, [&](size_t i) {
            const bool is_first = grid.from[i] == 0.0, is_last = grid.to[i] == 1.0;
            if ((is_first && is_last) || x[i] == 0.0 || x[i + 1] == 0.0) return;
            const double length = rows_.length(i);
            const double a = second[is_first ? i + 2 : i], b = second[is_last ? i - 1 : i + 1];
            if (a * b > 0.0) rises[i] = -0.25 * length * length * (std::fabs(a) < std::fabs(b) ? a : b);
        });
        return rises;
    }

    // How the squared speeds of the last motion depend on each other (intervals + 1,).
    std::vector<Carry> take_carry() { return std::move(carry_); }

  private:
    void bound_noise() {
        const size_t width = size_t(padded_), rows = size_t(rows_.degree + 1);
        for (size_t piece = 0; piece < least_inverse_square_.size(); ++piece) {
            double& least = least_inverse_square_[piece];
            for (size_t at = 0; at < rows * width; ++at) {
                const double slope = std::fabs(slopes_[piece * rows * width + at]);
                const double speed = slope * velocity_[at % width];
                const double per_length = slope * acceleration_[at % width] / rows_.lengths[piece];
                least = std::max({least, noise_of_velocity * speed * speed,
                                  noise_of_acceleration * rows_.degree * per_length});
            }
        }
    }

    std::ptrdiff_t bound(SpeedRange last) {
        range_.assign(count_ + 1, {0.0, no_end});
        range_[count_] = last;
        carry_.assign(count_ + 1, {0.0, true});
        for (size_t end = count_; end > 0;) {
            const size_t begin = end > intervals_between_polls ? end - intervals_between_polls : 0;
            const std::ptrdiff_t blocked =
                kernels::bound_path_speeds(rows_, begin, end, range_.data(), carry_.data(), memory_.data());
            if (blocked >= 0) return blocked;
            end = begin;
            poll_interrupts();
        }
        return -1;
    }

    void raise(std::vector<double>& speed) {
        speed[0] = start_;
        for (size_t begin = 0; begin < count_; begin += intervals_between_polls) {
            const size_t end = std::min(count_, begin + intervals_between_polls);
            kernels::raise_path_speeds(rows_, begin, end, range_.data(), speed.data(), carry_.data(),
                                       memory_.data());
            poll_interrupts();
        }
    }

    static Timing report(Timing& timing, TimingOutcome outcome, SpeedRange range) {
        timing.outcome = outcome;
        timing.least = std::sqrt(range.low);
        timing.most = std::sqrt(range.high);
        return timing;
    }

    // The greatest speed at the end that the start permits, or what blocks the path whatever the end.
    Timing explain_end(Timing& timing) {
        const std::ptrdiff_t blocked = bound({0.0, no_end});
        if (blocked >= 0) {
            timing.outcome = TimingOutcome::blocked;
            timing.where = size_t(blocked);
            return timing;
        }
        if (!(range_[0].low <= start_ && start_ <= range_[0].high))
            return report(timing, TimingOutcome::start, range_[0]);
        std::vector<double> speed(count_ + 1);
        raise(speed);
        return report(timing, TimingOutcome::end, {0.0, speed.back()});
    }

    const TimingPath& path_;
    double start_, end_;
    int padded_;
    Aligned slopes_, memory_{0};
    std::vector<double> acceleration_, velocity_, least_inverse_square_;
    TimingSamples samples_;
    TimedRows rows_{};
    size_t count_ = 0;  // of the intervals
    std::vector<signed char> stops_;
    std::vector<SpeedRange> range_;
    std::vector<Carry> carry_;
};

TimingGrid divide_pieces(const TimingPath& path, const std::vector<size_t>& parts) {
    TimingGrid grid;
    for (size_t piece = 0; piece < path.lengths.size(); ++piece) {
        const size_t count = parts[piece];
        for (size_t k = 0; k < count; ++k) {
            grid.piece.push_back(int(piece));
            grid.from.push_back(double(k) / double(count));
            grid.to.push_back(double(k + 1) / double(count));
        }
    }
    return grid;
}

// Whether the motion stands at both ends of an interval: it would never pass it.
void find_stand(Timing& timing) {
    const std::vector<double>& x = timing.squared_speed;
    const auto standing = std::adjacent_find(
        x.begin(), x.end(), [](double begin, double end) { return begin == 0.0 && end == 0.0; });
    if (standing == x.end()) return;
    timing.outcome = TimingOutcome::stands;
    timing.where = size_t(standing - x.begin());
}

}  // namespace

void sum_times(std::span<const double> lengths, std::span<const double> squared_speed,
               std::span<const double> rises, double* times) {
    double speed = std::sqrt(squared_speed[0]);
    times[0] = 0.0;
    for (size_t i = 0; i < lengths.size(); ++i) {
        const double last = speed;
        speed = std::sqrt(squared_speed[i + 1]);
        times[i + 1] = times[i] + pass_seconds(lengths[i], last + speed, rises[i]);
    }
}

TimingGrid divide_evenly(const TimingPath& path, std::size_t intervals) {
    double whole = 0.0;
    for (const double length : path.lengths) whole += length;
    std::vector<size_t> parts;
    for (const double length : path.lengths)
        parts.push_back(std::max(least_parts, size_t(std::round(double(intervals) * length / whole))));
    return divide_pieces(path, parts);
}

Timing time_on_grid(const TimingPath& path, const TimingLimits& limits, const TimingOptions& options,
                    const TimingGrid& grid, const Sampler& sample, std::vector<double> rises) {
    PathTimer timer(path, limits, options);
    timer.set_grid(grid, sample);
    rises.resize(grid.size(), 0.0);
    Timing timing = timer.solve_or_flatten(std::move(rises));
    find_stand(timing);
    return timing;
}

Timing time_path(const TimingPath& path, const TimingLimits& limits, const TimingOptions& options,
                 const Sampler& sample) {
    PathTimer timer(path, limits, options);
    Halved halved{divide_pieces(path, std::vector<size_t>(path.lengths.size(), first_parts)), {}};
    std::vector<double> rises(halved.grid.size(), 0.0), losses;
    GridMotion last;
    for (int round = 0;; ++round) {
        timer.set_grid(halved.grid, sample);
        Timing timing = timer.solve_or_flatten(std::move(rises));
        const bool timed = timing.outcome == TimingOutcome::timed;
        Passing now = timed ? timer.measure(timing) : Passing{};
        const bool known = timed && !last.seconds.empty();
        losses =
            known ? estimate_losses(std::move(last), timing.squared_speed, now.seconds, halved.parent, losses)
                  : std::vector<double>{};
        const double allowed = options.tolerance * now.total;
        timing.converged =
            known && !now.stands && std::accumulate(losses.begin(), losses.end(), 0.0) <= allowed;
        Halved next;
        if (!timing.converged && round < most_rounds && (timed || round < blocked_rounds)) {
            const double enough = allowed / double(halved.grid.size());
            // A motion that stands, or none at all, may come of a coarse grid.
            next = halve(halved.grid, [&](size_t i) {
                return !known || losses[i] > enough ||
                       timing.squared_speed[i] + timing.squared_speed[i + 1] == 0.0;
            });
        }
        if (next.grid.size() <= halved.grid.size()) {
            timing.grid = std::move(halved.grid);
            find_stand(timing);
            return timing;
        }
        const std::vector<double> own = timed ? timer.find_rises(timing.squared_speed) : timing.rises;
        rises = halve_rises(own, next.parent);
        last = {std::move(timing.squared_speed), std::move(now.seconds), timer.take_carry()};
        halved = std::move(next);
    }
}

}  // namespace cspace::trajectory
