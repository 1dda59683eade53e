// The dynamic window approach (Fox, Burgard & Thrun 1997): of all speeds and turn rates that the next step
// can reach and from which the robot can stop before what its sensor sees, the one that best weighs heading
// for a point of the path, free way and speed.
//
// A disc that turns on the spot is always safe, and one that brakes along its arc is safe as long as it was
// when it chose the arc: so there is always something to choose.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "cspace/maps/rays.hpp"
#include "cspace/math/wrapping.hpp"
#include "cspace/navigation/following/controllers.hpp"

namespace cspace::navigation {

struct WindowSettings {
    double radius;                  // of the robot, with the distance that it keeps [m]
    double lookahead;               // of the point that it heads for [m]
    double range;                   // of the sensor [m]
    int rays;                       // all around
    double heading, way, velocity;  // weights
};

class DynamicWindow {
  public:
    static bool leaves_path(const Vehicle&) { return true; }

    DynamicWindow(const maps::BitGrid* grid, const maps::GridFrame& frame, const WindowSettings& settings)
        : grid_(grid), frame_(frame), set_(settings) {}

    Point guided(const Vehicle&, const Motion& now) const { return place_of(now.pose); }

    Command operator()(const Vehicle& vehicle, const Motion& now, const Run& run, const Run::Place& at,
                       double speed, double time) {
        look_around(now.pose);
        const bool near = at.s + set_.lookahead >= run.length();
        const Point target = near ? run.end() : run.ahead(place_of(now.pose), at.s, set_.lookahead);
        const double slow = std::max(0.0, now.speed - vehicle.acceleration * time);
        const double most_speed = near ? std::min(speed, speed_towards(vehicle, now.pose, target)) : speed;
        const double fast = std::max(slow, std::min(most_speed, now.speed + vehicle.acceleration * time));
        const double left = std::max(-vehicle.max_turn, now.turn - vehicle.turn_change * time);
        const double right = std::min(vehicle.max_turn, now.turn + vehicle.turn_change * time);
        Command best = braked(vehicle, now, time);
        double most = value(vehicle, now, best, target, time, true);
        for (int i = 0; i <= speeds; ++i)
            for (int j = 0; j <= turns; ++j) {
                const Command one{slow + (fast - slow) * i / speeds, left + (right - left) * j / turns};
                const double worth = value(vehicle, now, one, target, time, false);
                if (worth > most) most = worth, best = one;
            }
        return best;
    }

  private:
    static constexpr int speeds = 8, turns = 20;
    static constexpr double standing = 1e-9;  // [m/s]
    static constexpr double straight = 1e-6;  // [1/m] an arc that leaves its tangent by a hair within a hall
    static constexpr double horizon = 0.5;    // how far ahead the heading is judged [s]

    void look_around(const CarPose& pose) {
        seen_.clear();
        if (grid_ == nullptr) return;
        for (int k = 0; k < set_.rays; ++k) {
            const double angle = pose.theta + 2 * std::numbers::pi * k / set_.rays;
            const Point direction{std::cos(angle), std::sin(angle)};
            const double range = maps::cast_ray(*grid_, frame_, place_of(pose), direction, set_.range);
            if (range < set_.range)
                seen_.push_back(range * Point{std::cos(angle - pose.theta), std::sin(angle - pose.theta)});
        }
    }

    // The fastest at which an arc leads to a point: faster, the robot would circle around it.
    static double speed_towards(const Vehicle& vehicle, const CarPose& from, Point target) {
        const Point way = target - place_of(from), along = heading_of(from);
        const double beside = std::fabs(cross(along, way));
        if (dot(along, way) < 0) return 0;
        return beside > 0 ? vehicle.max_turn * squared_norm(way) / (2 * beside) : vehicle.max_speed;
    }

    // How hard the robot can brake so that it stays on its arc.
    static double braking(const Vehicle& vehicle, const Command& c) {
        const double curvature = std::fabs(c.turn) / std::max(c.speed, standing);
        return std::min(vehicle.acceleration, vehicle.turn_change / std::max(curvature, standing));
    }
    static Command braked(const Vehicle& vehicle, const Motion& now, double time) {
        if (now.speed <= standing) return {0, 0};
        const double speed = std::max(0.0, now.speed - braking(vehicle, {now.speed, now.turn}) * time);
        return {speed, now.turn * speed / now.speed};
    }

    // What a choice is worth; below everything where it cannot be stopped in time.
    double value(const Vehicle& vehicle, const Motion& now, const Command& c, Point target, double time,
                 bool safe) const {
        const double free = free_way(c);
        const double stop = c.speed * time + 0.5 * c.speed * c.speed / braking(vehicle, c);
        if (!safe && c.speed > standing && free < stop) return -std::numeric_limits<double>::infinity();
        const CarPose then =
            advance_pose(now.pose, c.speed, c.turn, std::min(horizon, free / std::max(c.speed, standing)));
        const Point way = target - place_of(then), along = heading_of(then);
        const double off = std::fabs(std::atan2(cross(along, way), dot(along, way))) / std::numbers::pi;
        const double far =
            std::min(distance(place_of(now.pose), target), set_.range);  // what lies beyond is no use
        const double clear = far > 0 ? std::min(free, far) / far : 1;
        return set_.heading * (1 - off) + set_.way * clear + set_.velocity * c.speed / vehicle.max_speed;
    }

    // How far the disc goes along its arc before it touches something seen [m]. Points are in its frame.
    double free_way(const Command& c) const {
        double least = set_.range;
        if (c.speed <= standing) return least;
        const double curvature = c.turn / c.speed;
        for (const Point p : seen_) {
            const double hit = std::fabs(curvature) < straight ? ahead(p) : along_arc(p, 1 / curvature);
            least = std::min(least, hit);
        }
        return least;
    }
    // A point nearer than it should be stops the robot only if it would come nearer still.
    bool is_too_near(Point p) const { return squared_norm(p) < set_.radius * set_.radius; }
    double ahead(Point p) const {
        if (is_too_near(p)) return p.x > 0 ? 0 : set_.range;
        const double half = set_.radius * set_.radius - p.y * p.y;
        return p.x > 0 && half > 0 ? p.x - std::sqrt(half) : set_.range;
    }
    double along_arc(Point p, double turn) const {
        if (is_too_near(p)) return p.x > 0 ? 0 : set_.range;
        const double radius = std::fabs(turn);
        const Point from_center{p.x, turn > 0 ? p.y - radius : -p.y - radius};  // as if turning left
        const double far = norm(from_center);
        if (std::fabs(far - radius) >= set_.radius || far == 0) return set_.range;
        const double cosine = (radius * radius + far * far - set_.radius * set_.radius) / (2 * radius * far);
        const double angle = wrap_above(std::atan2(from_center.x, -from_center.y), 0);
        return radius * std::max(0.0, angle - std::acos(std::clamp(cosine, -1.0, 1.0)));
    }

    const maps::BitGrid* grid_;
    maps::GridFrame frame_;
    WindowSettings set_;
    std::vector<Point> seen_;
};

}  // namespace cspace::navigation
