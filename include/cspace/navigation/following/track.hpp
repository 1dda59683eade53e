// A path to be followed: a chain of points, cut into runs where the direction of driving changes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "cspace/math/plane.hpp"

namespace cspace::navigation {

// One run: points without repetition, driven forwards (+1) or backwards (−1).
class Run {
  public:
    Run(const Point* points, std::size_t count, int direction)
        : points_(points, points + count), s_(count), direction_(direction) {
        for (std::size_t i = 1; i < count; ++i) s_[i] = s_[i - 1] + distance(points_[i - 1], points_[i]);
    }

    struct Place {
        double s;       // along the run [m]
        double offset;  // of the given point, positive to the left of the run [m]
        Point heading;  // of the run there, a unit vector
    };

    int direction() const { return direction_; }
    double length() const { return s_.back(); }
    Point end() const { return points_.back(); }
    Point begin() const { return points_.front(); }

    // The place nearest to a point, among those from one length along the run to another; beyond its end the
    // last segment goes on straight.
    Place nearest(Point p, double from, double to) const {
        double least = std::numeric_limits<double>::infinity();
        Place best{};
        for (std::size_t i = segment_at(from); i + 1 < points_.size() && s_[i] <= to; ++i) {
            const double length = s_[i + 1] - s_[i];
            const Point along = (1 / length) * (points_[i + 1] - points_[i]), way = p - points_[i];
            const double last = i + 2 == points_.size() ? to - s_[i] : std::min(length, to - s_[i]);
            const double first = std::max(0.0, from - s_[i]);
            const double t = std::clamp(dot(way, along), std::min(first, last), last);
            const double far = norm(way - t * along);
            if (far < least) least = far, best = {s_[i] + t, std::copysign(far, cross(along, way)), along};
        }
        return best;
    }

    // The point at a length; beyond the end the last segment goes on straight.
    Point at(double s) const {
        const std::size_t i = segment_at(s);
        return points_[i] + ((s - s_[i]) / (s_[i + 1] - s_[i])) * (points_[i + 1] - points_[i]);
    }

    // The first point after a length that is `far` from p; the last segment goes on beyond the end. Where
    // the run is farther than that all along, the point at that length.
    Point ahead(Point p, double s, double far) const {
        if (distance(p, at(s)) >= far) return at(s);
        for (std::size_t i = segment_at(s); i + 1 < points_.size(); ++i) {
            const bool last = i + 2 == points_.size();
            if (!last && distance(p, points_[i + 1]) < far) continue;
            const Point a = points_[i], along = (1 / (s_[i + 1] - s_[i])) * (points_[i + 1] - a);
            const double middle = dot(p - a, along), off = cross(along, p - a);
            const double t = middle + std::sqrt(std::max(0.0, far * far - off * off));
            return a + t * along;
        }
        return end();
    }

  private:
    std::size_t segment_at(double s) const {
        const auto after = std::upper_bound(s_.begin() + 1, s_.end() - 1, s);
        return std::size_t(after - s_.begin()) - 1;
    }

    std::vector<Point> points_;
    std::vector<double> s_;
    int direction_;
};

using Track = std::vector<Run>;

}  // namespace cspace::navigation
