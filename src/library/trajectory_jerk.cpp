#include "trajectory_jerk.hpp"

#include <algorithm>
#include <cmath>

#include "trajectory_jerk_window.hpp"

namespace cspace::trajectory {
namespace {

using std::size_t;

constexpr size_t least_window = 16;
constexpr double unchanged = 1e-3;  // of the seconds of a stretch
constexpr double slower = 1.5;      // factor from one trial of a first motion to the next
constexpr int most_trials = 60;     // of first motions: ten orders of magnitude

// x(s) = C s^(4/3) of the motion s = jerk t³ / 6.
double launch_factor(double jerk) { return 0.25 * jerk * jerk * std::pow(6.0 / jerk, 4.0 / 3.0); }

// x = C s^(4/3) and x' = (4/3) C s^(1/3) at the end of the launch; the middle coefficient is x + x' D / 2.
SectionEnd find_end(const Launch& launch, double length) {
    const double x = std::pow(launch.length, 4.0 / 3.0);
    const double middle = x + (2.0 / 3.0) * std::cbrt(launch.length) * length;
    return {x / middle, launch_factor(launch.jerk) * middle};
}

// Middle coefficients of the law s = r³(10 − 15r + 6r²), which takes one second.
std::vector<double> make_first_motion(const JerkSection& section, const JerkOptions& options) {
    double whole = options.start.length + options.end.length;
    for (const double each : section.length) whole += each;
    std::vector<double> shape;
    double s = options.start.length, r = 0.0;
    for (const double length : section.length) {
        const double share = (s + 0.5 * length) / whole;
        double low = r, high = 1.0;
        for (int k = 0; k < 60; ++k) {
            const double mid = 0.5 * (low + high);
            (mid * mid * mid * (10.0 - mid * (15.0 - 6.0 * mid)) < share ? low : high) = mid;
        }
        r = low;
        const double speed = 30.0 * r * r * (1.0 - r) * (1.0 - r) * whole;
        shape.push_back(speed * speed);
        s += length;
    }
    return shape;
}

// Slows a first motion until it keeps all limits on a window, after those on which it does.
bool slow_down(JerkSection& section, JerkWindow& window, int& trials) {
    window.touch_middles();
    for (; !window.is_within(); ++trials) {
        if (trials == most_trials) return false;
        for (double& middle : section.middle) middle /= slower * slower;
        for (double& touched : section.touched) touched /= slower * slower;
    }
    return true;
}

// Slows the first motion until it keeps all limits everywhere.
bool find_first_motion(JerkSection& section, const JerkOptions& options, size_t first_window) {
    section.middle = make_first_motion(section, options);
    for (double& middle : section.middle) middle /= options.duration * options.duration;
    section.touched.resize(section.size());
    int trials = 0;
    for (size_t begin = 0; begin < section.size(); begin += first_window) {
        JerkWindow window(section, begin, std::min(section.size(), begin + first_window));
        if (!slow_down(section, window, trials)) return false;
    }
    return true;
}

// Minimizes a window, and whether it ends with the section.
bool minimize_window(JerkSection& section, size_t begin, size_t size, double tolerance) {
    const size_t end = section.size() - begin > size ? begin + size : section.size();
    JerkWindow window(section, begin, end);
    if (window.is_within()) window.minimize(tolerance);
    return end == section.size();
}

double sum_seconds(const JerkSection& section, size_t begin, size_t end) {
    double sum = 0.0;
    for (size_t i = begin; i < end; ++i) sum += gauss_seconds(section.length[i], section.squares(i));
    return sum;
}

// A long section window by window, each half a window after the one before it. At the end of a window the
// motion brakes to the slow one to begin with. If the next window changes more than that braking, the window
// was too short: it is made longer.
void minimize_by_windows(JerkSection& section, size_t size, double tolerance) {
    size_t begin = 0;
    bool is_last = minimize_window(section, begin, size, tolerance);
    while (!is_last) {
        const size_t next = begin + size / 2;
        const double last = sum_seconds(section, next, next + size / 4);
        is_last = minimize_window(section, next, size, tolerance);
        const double now = sum_seconds(section, next, next + size / 4);
        if (last > (1.0 + unchanged) * now) {
            size *= 2;
            is_last = minimize_window(section, begin, size, tolerance);
        } else {
            begin = next;
        }
    }
}

}  // namespace

JerkTiming time_path_with_jerk(const TimingPath& path, const TimingLimits& limits,
                               std::span<const double> jerk, const TimingGrid& grid,
                               const JerkOptions& options, const TimingSamples& samples) {
    const int padded = padded_joints(path.joints), degree = slope_degree(path);
    const TimingSamples own = pad_samples(samples, path.joints, padded);
    const Aligned slopes = find_slopes(path, degree, padded);
    const auto velocity = invert_limits(limits.velocity, padded);
    const auto acceleration = invert_limits(limits.acceleration, padded);
    const auto jerks = invert_limits(jerk, padded);
    JerkSection section;
    section.path = {degree,           padded,
                    slopes.data(),    path.lengths.data(),
                    velocity.data(),  acceleration.data(),
                    jerks.data(),     grid.view(),
                    show_samples(own)};
    for (size_t i = 0; i < grid.size(); ++i) section.length.push_back(section.path.length(i));
    section.start = find_end(options.start, section.length.front());
    section.end = find_end(options.end, section.length.back());
    const size_t window =
        section.size() <= options.at_once ? section.size() : std::max(least_window, options.at_once / 16);
    if (!find_first_motion(section, options, window)) return {false, {}, 0.0, 0.0, 0.0};
    minimize_by_windows(section, window, options.tolerance);
    JerkTiming timing{true, {}, 0.0, 0.0, 0.0};
    timing.start_jerk = options.start.jerk * std::pow(section.middle.front() / section.start.largest, 1.5);
    timing.end_jerk = options.end.jerk * std::pow(section.middle.back() / section.end.largest, 1.5);
    timing.duration = std::cbrt(6.0 * options.start.length / timing.start_jerk) +
                      std::cbrt(6.0 * options.end.length / timing.end_jerk);
    timing.duration += sum_seconds(section, 0, section.size());
    timing.squares.reserve(3 * section.size());
    for (size_t i = 0; i < section.size(); ++i) {
        const Squares x = section.squares(i);
        timing.squares.insert(timing.squares.end(), x.at, x.at + 3);
    }
    return timing;
}

}  // namespace cspace::trajectory
