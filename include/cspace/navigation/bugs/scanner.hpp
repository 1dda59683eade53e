// A range sensor with noise: distances along beams all around, averaged over repeated scans.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "cspace/navigation/bugs/walls.hpp"
#include "cspace/search/draws.hpp"

namespace cspace::navigation {

// Standard deviation of one reading [m], and the seed of the draws.
struct Noise {
    double deviation = 0;
    std::uint64_t seed = 0;
};

// What the beams read from one place: the middle of beam k lies at angle k / size of a full circle.
struct Scan {
    std::vector<double> reading;  // the range where nothing returned
    double deviation = 0;         // of a reading, after averaging
    double least = 0;
};

// Beams are as wide as they lie apart, so no corner hides between two of them. Each reading is the distance
// to the nearest wall in the beam plus a normal deviate, clipped to [0, range]. A beam that meets no wall
// within the range reads the range. Deviates are independent of each other.
class Scanner {
  public:
    static constexpr int beams = 720, first_scans = 16, most_scans = 400;
    // Scans are repeated until their mean deviates by this share of the least reading.
    static constexpr double wanted = 0.01;

    Scanner(const Walls& walls, double range, Noise noise)
        : walls_(walls), range_(range), noise_(noise.deviation), draws_(noise.seed), far_(beams) {
        for (int k = 0; k < beams; ++k) {
            const double angle = 2 * std::numbers::pi * k / beams, half = std::numbers::pi / beams;
            directions_.push_back({std::cos(angle), std::sin(angle)});
            sides_.push_back({std::cos(angle + half), std::sin(angle + half)});
        }
    }

    double range() const { return range_; }
    double noise() const { return noise_; }
    std::int64_t scans() const { return scans_; }
    Point direction(int beam) const { return directions_[std::size_t((beam % beams + beams) % beams)]; }

    void look(Point from, Scan& scan) {
        sweep(from);
        read(first_scans, scan);
        const double more = noise_ / (wanted * std::max(scan.least, 1e-3 * noise_));
        if (more * more > first_scans) read(int(std::min<double>(most_scans, std::ceil(more * more))), scan);
    }
    // A single direction, read as often as the last scan was.
    double read(Point from, Point towards) { return mean_of(cast(from, towards, range_), last_); }

  private:
    const Walls& walls_;
    double range_, noise_;
    search::Draws draws_;
    std::vector<double> far_;
    std::vector<Point> directions_, sides_;  // of each beam its middle and its left side
    std::int64_t scans_ = 0;
    int last_ = first_scans;

    // How far the nearest wall in each beam is.
    void sweep(Point from) {
        double before = cast(from, sides_.back(), range_);
        for (int k = 0; k < beams; ++k) {
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
        scan.reading.resize(beams);
        last_ = noise_ > 0 ? count : 1;
        scans_ += last_;
        for (int k = 0; k < beams; ++k) scan.reading[std::size_t(k)] = mean_of(far_[std::size_t(k)], last_);
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
                if (t > -1e-12 * reach && t < nearest) nearest = std::max(t, 0.0);
            },
            [&](auto covered) { return nearest < none && covered(from + nearest * along); });
        return nearest <= most ? nearest : none;
    }
};

}  // namespace cspace::navigation
