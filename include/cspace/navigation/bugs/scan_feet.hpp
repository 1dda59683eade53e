// Where walls are nearest in a scan with noise: runs of beams that read little more than the least.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/bugs/clearance_sensor.hpp"
#include "cspace/navigation/bugs/walls.hpp"
#include "cspace/search/draws.hpp"

namespace cspace::navigation {

// A range sensor with noise: distances along beams all around, averaged over repeated scans.

// Standard deviation of one reading [m], and the seed of the draws.
struct Noise {
    double deviation = 0;
    std::uint64_t seed = 0;
};

// A run of beams that read about the same, the nearest there are around; beam numbers continue past a full
// circle.
struct Near {
    int first, last;
    Point towards;  // unit
};

// Unit vectors all around, one for each beam.
inline std::vector<Point> list_directions(int beams, double first) {
    std::vector<Point> made;
    for (int k = 0; k < beams; ++k) {
        const double angle = 2 * std::numbers::pi * k / beams + first;
        made.push_back({std::cos(angle), std::sin(angle)});
    }
    return made;
}

// What the beams read from one place: the middle of beam k lies at angle k / beams of a full circle. Numbers
// of beams may lie outside 0 … beams − 1.
class Scan {
  public:
    static constexpr int beams = 720;
    static constexpr double slack = 0.03, trust = 3.5;  // of the distance, and of a reading's deviation
    static constexpr double grazing = 8;      // a wall is seen at up to this secant of the angle of incidence
    static constexpr double level = 1e-3;     // of the distance: gives beams that read just that a weight
    static constexpr int apart = beams / 12;  // runs of one wall lie no farther from each other

    double range = std::numeric_limits<double>::infinity();
    std::vector<double> reading;  // the range where nothing returned
    double deviation = 0;         // of a reading, after averaging
    double least = 0;

    double at(int beam) const { return reading[std::size_t(wrapped(beam))]; }
    double tolerance(double distance) const { return slack * distance + trust * deviation; }
    static Point direction(int beam) {
        static const std::vector<Point> all = list_directions(beams, 0);
        return all[std::size_t(wrapped(beam))];
    }
    static int wrapped(int beam) { return (beam % beams + beams) % beams; }
    static int beam_of(Point towards) {
        const double turns = std::atan2(towards.y, towards.x) / (2 * std::numbers::pi);
        return wrapped(int(std::lround(turns * beams)));
    }
    // How many beams it is from one counterclockwise to another.
    static int ahead(int from, int to) { return wrapped(to - from); }

    bool returns(int beam) const { return at(beam) < range; }

    // Whether between two beams, counterclockwise, there is nothing that the scan does not show.
    bool is_closed(int first, int last) const {
        for (int k = first; k < last; ++k)
            if (jumps(k)) return false;
        return true;
    }

    // The beam that reads least, of some.
    int nearest(int first, int last) const {
        int best = first;
        for (int k = first; k <= last; ++k)
            if (smooth(k) < smooth(best)) best = k;
        return best;
    }
    // The mean of neighbours where the view does not jump: less noise, and less of the luck of the least.
    double smooth(int beam) const {
        double sum = at(beam), count = 1;
        if (!jumps(beam)) sum += at(beam + 1), ++count;
        if (!jumps(beam - 1)) sum += at(beam - 1), ++count;
        return sum / count;
    }
    double smooth(Point towards) const { return smooth(beam_of(towards)); }

    // Counterclockwise, all walls within a distance. Runs are one unless they lie far apart or the view opens
    // between them.
    std::vector<Near> within(double distance) const {
        std::vector<Near> runs;
        int begin = 0;
        while (begin < beams && is_near(begin, distance)) ++begin;
        if (begin == beams) return {{0, beams - 1, direction_of(0, beams - 1, distance)}};
        for (int k = begin; k < begin + beams; ++k) {
            if (!is_near(k, distance)) continue;
            if (!runs.empty() && is_one(runs.back().last, k))
                runs.back().last = k;
            else
                runs.push_back({k, k, {}});
        }
        if (runs.size() > 1 && is_one(runs.back().last, runs.front().first + beams)) {
            runs.front().first = runs.back().first - beams;
            runs.pop_back();
        }
        for (Near& run : runs) run.towards = direction_of(run.first, run.last, distance);
        return runs;
    }

  private:
    bool is_near(int beam, double distance) const { return returns(beam) && at(beam) <= distance; }
    bool is_one(int last, int next) const { return next - last < apart && is_closed(last, next); }
    // Whether the view opens between a beam and the next one.
    bool jumps(int beam) const {
        if (!returns(beam) || !returns(beam + 1)) return true;
        const double a = at(beam), b = at(beam + 1);
        const double step = 2 * std::numbers::pi / beams * std::min(a, b);
        return std::abs(a - b) > grazing * step + 2 * trust * deviation;
    }
    Point direction_of(int first, int last, double distance) const {
        Point sum;
        for (int k = first; k <= last; ++k)
            if (at(k) <= distance) sum = sum + (distance - at(k) + level * distance) * direction(k);
        const double size = norm(sum);
        return size > 0 ? (1 / size) * sum : direction((first + last) / 2);
    }
};

// Beams are as wide as they lie apart, so no corner hides between two of them. Each reading is the distance
// to the nearest wall in the beam plus a normal deviate, clipped to [0, range]. A beam that meets no wall
// within the range reads the range. Deviates are independent of each other.
class Scanner {
  public:
    static constexpr int beams = Scan::beams, first_scans = 16, most_scans = 400;
    // Scans are repeated until their mean deviates by this share of the least reading.
    static constexpr double wanted = 0.01;
    static constexpr double touching = 1e-3;  // of the noise: walls read as nearer are as good as touched
    static constexpr double at_wall = 1e-12;  // of its reach: a wall so little behind is the one it stands on

    Scanner(const Walls& walls, double range, Noise noise)
        : walls_(walls),
          range_(range),
          noise_(noise.deviation),
          draws_(noise.seed),
          far_(beams),
          sides_(list_directions(beams, std::numbers::pi / beams)) {}

    std::int64_t scans() const { return scans_; }

    void look(Point from, Scan& scan) {
        sweep(from);
        read(first_scans, scan);
        const double more = noise_ / (wanted * std::max(scan.least, touching * noise_));
        if (more * more > first_scans) read(int(std::min<double>(most_scans, std::ceil(more * more))), scan);
    }
    // A single direction, read as often as the last scan was.
    double read(Point from, Point towards) { return mean_of(cast(from, towards, range_), last_); }

  private:
    const Walls& walls_;
    double range_, noise_;
    search::Draws draws_;
    std::vector<double> far_;
    std::vector<Point> sides_;  // the left side of each beam
    std::int64_t scans_ = 0;
    int last_ = first_scans;

    // How far the nearest wall in each beam is.
    void sweep(Point from) {
        double before = cast(from, sides_.back(), range_);
        InterruptPoll poll(64);
        for (int k = 0; k < beams; ++k) {
            poll.step();
            const double after = cast(from, sides_[std::size_t(k)], range_);
            far_[std::size_t(k)] = std::min(before, after);
            before = after;
        }
        for (int wall = 0; wall < walls_.size(); ++wall) {
            const Point to = walls_.begin(wall) - from;
            const double away = norm(to);
            if (!(away > 0 && away <= range_)) continue;
            const double turns = std::atan2(to.y, to.x) / (2 * std::numbers::pi);
            double& nearest = far_[std::size_t((std::lround(turns * beams) + beams) % beams)];
            if (away < nearest) nearest = std::min(nearest, cast(from, (1 / away) * to, away));
            if (away < nearest) nearest = away;
        }
    }

    void read(int count, Scan& scan) {
        scan.range = range_;
        scan.reading.resize(beams);
        last_ = noise_ > 0 ? count : 1;
        scans_ += last_;
        InterruptPoll poll(64);
        for (int k = 0; k < beams; ++k) {
            poll.step();
            scan.reading[std::size_t(k)] = mean_of(far_[std::size_t(k)], last_);
        }
        scan.deviation = noise_ / std::sqrt(double(last_));
        scan.least = *std::min_element(scan.reading.begin(), scan.reading.end());
    }

    // Box and Muller's.
    double normal() {
        const double u = 1 - draws_.uniform(), v = draws_.uniform();
        return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
    }
    // The mean of so many readings, 16 or more, is normal to what can be told: it is drawn at once.
    double mean_of(double distance, int count) {
        if (distance >= range_ || noise_ == 0) return std::min(distance, range_);
        const double root = std::sqrt(double(count));
        if (distance > 7 * noise_ && range_ - distance > 7 * noise_)
            return distance + noise_ / root * normal();
        const auto below = [](double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); };
        const auto density = [](double z) {
            return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
        };
        const double a = -distance / noise_, b = std::min((range_ - distance) / noise_, 40.0);
        const double top = distance + b * noise_, inside = below(b) - below(a), past = below(-b);
        const double drop = density(a) - density(b);
        const double mean = top * past + distance * inside + noise_ * drop;
        const double square = top * top * past + distance * distance * inside + 2 * distance * noise_ * drop +
                              noise_ * noise_ * (inside + a * density(a) - b * density(b));
        const double deviation = std::sqrt(std::max(square - mean * mean, 0.0)) / root;
        return std::clamp(mean + deviation * normal(), 0.0, range_);
    }

    // How far it is to the first wall along a unit vector; infinity where that is more than `most`.
    double cast(Point from, Point along, double most) const {
        const double none = std::numeric_limits<double>::infinity(), reach = 4 * walls_.extent();
        const double end = std::min(most, reach + distance(from, walls_.size() ? walls_.begin(0) : from));
        double nearest = none;
        walls_.along(
            {from, from + end * along},
            [&](int wall) {
                const Point a = walls_.begin(wall), d = walls_.end(wall) - a;
                if (a == from || walls_.end(wall) == from) return;  // of a corner it touches no more is seen
                const double right = cross(along, a - from), left = cross(along, walls_.end(wall) - from);
                if (right > 0 || left < 0 || right == left) return;  // aside, or its back
                const double t = cross(a - from, d) / cross(along, d);
                if (t > -at_wall * reach && t < nearest) nearest = std::max(t, 0.0);
            },
            [&](auto covered) { return nearest < none && covered(from + nearest * along); });
        return nearest <= most ? nearest : none;
    }
};

}  // namespace cspace::navigation
