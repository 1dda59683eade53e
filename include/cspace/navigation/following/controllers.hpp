// What steers a vehicle along a run: pure pursuit and Stanley.
#pragma once

#include "cspace/navigation/following/track.hpp"
#include "cspace/navigation/following/vehicle.hpp"

namespace cspace::navigation {

inline Point place(const CarPose& pose) { return {pose.x, pose.y}; }
inline Point heading(const CarPose& pose) { return {std::cos(pose.theta), std::sin(pose.theta)}; }

// A fast speed from which a vehicle, after one more step at it, still stops within a distance.
inline double speed_to_stop(double distance, double acceleration, double time) {
    const double d = std::max(distance, 0.0);
    return acceleration * (std::sqrt(time * time + 2 * d / acceleration) - time);
}

// Steers along the arc that meets the run a lookahead away (Coulter 1992): its curvature is 2 y / d² for a
// point at distance d, y to the left. A point behind is turned to as tightly as the vehicle can.
struct PurePursuit {
    static constexpr bool leaves_path = false;
    double lookahead;  // [m]

    Point guided(const Vehicle&, const Motion& now) const { return place(now.pose); }

    Command operator()(const Vehicle& vehicle, const Motion& now, const Run& run, const Run::Place& at,
                       double speed, double time) const {
        const Point here = place(now.pose), way = run.ahead(here, at.s, lookahead) - here;
        const Point along = heading(now.pose);
        const double x = run.direction() * dot(along, way), y = cross(along, way);
        const double d = squared_norm(way);
        const bool behind = x < 0;
        const double curvature = d > 0 ? 2 * y / d : 0;
        if (vehicle.steers()) {
            const double steering = std::atan(vehicle.wheelbase * curvature);
            return {run.direction() * speed, behind ? std::copysign(vehicle.max_turn, y) : steering};
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
    static constexpr bool leaves_path = false;
    double gain;     // [1/s]
    double softest;  // [m/s] added to the speed

    Point guided(const Vehicle& vehicle, const Motion& now) const {
        return place(now.pose) + vehicle.wheelbase * heading(now.pose);
    }

    Command operator()(const Vehicle&, const Motion& now, const Run&, const Run::Place& at, double speed,
                       double) const {
        const Point along = heading(now.pose);
        const double error = std::atan2(cross(along, at.heading), dot(along, at.heading));
        return {speed, error - std::atan2(gain * at.offset, softest + std::fabs(now.speed))};
    }
};

}  // namespace cspace::navigation
