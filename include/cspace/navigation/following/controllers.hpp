// What steers a vehicle along a run: pure pursuit and Stanley.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "cspace/math/plane.hpp"
#include "cspace/mobile/vehicle.hpp"

namespace cspace::navigation {

using mobile::CarPose;
using mobile::Command;
using mobile::Motion;
using mobile::Vehicle;

// A path to be followed: a chain of points, cut into runs where the direction of driving changes.

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

inline Point place_of(const CarPose& pose) { return {pose.x, pose.y}; }
inline Point heading_of(const CarPose& pose) { return {std::cos(pose.theta), std::sin(pose.theta)}; }

// A fast speed from which a vehicle, after one more step at it, still stops within a distance.
inline double speed_to_stop(double distance, double acceleration, double time) {
    const double d = std::max(distance, 0.0);
    return acceleration * (std::sqrt(time * time + 2 * d / acceleration) - time);
}

// The speed of a car close to the end of a run: who cuts a bend comes there sooner than along the run.
inline double speed_to_end(const Vehicle& vehicle, Point here, const Run& run, const Run::Place& at,
                           double far, double speed, double time) {
    if (run.length() - at.s > far) return speed;
    return std::min(speed, speed_to_stop(distance(here, run.end()), vehicle.acceleration, time));
}

// Steers along the arc that meets the run a lookahead away (Coulter 1992): its curvature is 2 y / d² for a
// point at distance d, y to the left. A point behind is turned to as tightly as the vehicle can. The end of
// the run is that point as soon as it is no farther away: the lookahead shrinks with what is left.
struct PurePursuit {
    double lookahead;  // [m], at least
    double seconds;    // of way at the present speed

    // A vehicle that turns on the spot comes back to an end that it has missed.
    static bool leaves_path(const Vehicle& vehicle) { return !vehicle.steers(); }
    Point guided(const Vehicle&, const Motion& now) const { return place_of(now.pose); }
    double far(const Motion& now) const { return std::max(lookahead, seconds * std::fabs(now.speed)); }
    Point target(const Motion& now, const Run& run, const Run::Place& at) const {
        const Point here = place_of(now.pose);
        const double far = this->far(now);
        const bool ends = at.s + far >= run.length() && distance(here, run.end()) <= far;
        return ends || at.s >= run.length() ? run.end() : run.ahead(here, at.s, far);
    }

    Command operator()(const Vehicle& vehicle, const Motion& now, const Run& run, const Run::Place& at,
                       double speed, double time) const {
        const Point way = target(now, run, at) - place_of(now.pose);
        const Point along = heading_of(now.pose);
        const double x = run.direction() * dot(along, way), y = cross(along, way);
        const double d = squared_norm(way);
        const bool behind = x < 0;
        const double curvature = d > 0 ? 2 * y / d : 0;
        if (vehicle.steers()) {
            const double wanted =
                behind ? std::copysign(std::numbers::pi / 2, y) : std::atan(vehicle.wheelbase * curvature);
            const double steering = std::clamp(wanted, -vehicle.max_turn, vehicle.max_turn);
            // Slow enough that the wheels have turned within a quarter of the way to the point.
            const double wait = std::fabs(steering - now.turn) / vehicle.turn_change;
            const double slow = wait > time ? 0.25 * std::sqrt(d) / wait : speed;
            const double stops =
                speed_to_end(vehicle, place_of(now.pose), run, at, 2 * far(now), speed, time);
            return {run.direction() * std::min(stops, slow), steering};
        }
        // Backwards the same turn rate points the other way.
        if (behind) return {0, run.direction() * std::copysign(vehicle.max_turn, y)};
        double slow = speed;
        if (std::fabs(curvature) * slow > vehicle.max_turn) slow = vehicle.max_turn / std::fabs(curvature);
        const double made = within_limits(vehicle, now, {run.direction() * slow, 0}, time).speed;
        return {run.direction() * slow, curvature * made};
    }
};

// Steers the front wheels of a car along the run and towards it (Hoffmann, Tomlin, Montemerlo & Thrun 2007):
// the angle to the run's heading, and the arc tangent of gain · offset / speed.
struct Stanley {
    static bool leaves_path(const Vehicle&) { return false; }
    double gain;     // [1/s]
    double softest;  // [m/s] added to the speed

    Point guided(const Vehicle& vehicle, const Motion& now) const {
        return place_of(now.pose) + vehicle.wheelbase * heading_of(now.pose);
    }

    Command operator()(const Vehicle& vehicle, const Motion& now, const Run& run, const Run::Place& at,
                       double speed, double time) const {
        const Point along = heading_of(now.pose);
        const double far = 4 * vehicle.wheelbase;
        speed = speed_to_end(vehicle, place_of(now.pose), run, at, far, speed, time);
        const double error = std::atan2(cross(along, at.heading), dot(along, at.heading));
        return {speed, error - std::atan2(gain * at.offset, softest + std::fabs(now.speed))};
    }
};

}  // namespace cspace::navigation
