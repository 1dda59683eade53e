// Vehicles of the plane: their limits, and exact steps along arcs.
#pragma once

#include <algorithm>
#include <cmath>

#include "cspace/mobile/car_pose.hpp"

namespace cspace::mobile {

// A vehicle of the simulator: a unicycle that is told how fast to turn, or a car that is told how far to
// steer.
//
// Unicycle: theta' = w. Car, at the middle of its rear axle: theta' = v tan(delta) / wheelbase (the bicycle
// model). Speed and turn change by no more than their rates allow, then stay for a step, so that a step is an
// arc and its end exact.
struct Vehicle {
    double wheelbase;     // [m]; 0 for a unicycle
    double max_speed;     // [m/s] forwards
    double max_reverse;   // [m/s] backwards, not below zero
    double acceleration;  // [m/s²], in both directions
    double max_turn;      // of a unicycle the turn rate [rad/s], of a car the steering angle [rad]
    double turn_change;   // how fast that changes [rad/s²] or [rad/s]
    bool steers() const { return wheelbase > 0; }
};

struct Motion {
    CarPose pose;
    double speed, turn;  // turn as in Vehicle
};

struct Command {
    double speed, turn;
};

inline double step_toward(double from, double to, double step) {
    return from + std::clamp(to - from, -step, step);
}

// The curvature that a turn means at a speed.
inline double turn_rate(const Vehicle& vehicle, double speed, double turn) {
    return vehicle.steers() ? speed * std::tan(turn) / vehicle.wheelbase : turn;
}

// A step along the arc of constant speed and turn rate.
inline CarPose advance_pose(const CarPose& from, double speed, double rate, double time) {
    constexpr double straight = 1e-8;  // [rad] whose square is below rounding
    const double half = 0.5 * rate * time;
    const double chord = speed * time * (std::fabs(half) < straight ? 1.0 : std::sin(half) / half);
    return {from.x + chord * std::cos(from.theta + half), from.y + chord * std::sin(from.theta + half),
            from.theta + 2 * half};
}

// What a vehicle makes of a command within a step.
inline Command within_limits(const Vehicle& vehicle, const Motion& now, const Command& wanted, double time) {
    const double speed = std::clamp(wanted.speed, -vehicle.max_reverse, vehicle.max_speed);
    const double turn = std::clamp(wanted.turn, -vehicle.max_turn, vehicle.max_turn);
    return {step_toward(now.speed, speed, vehicle.acceleration * time),
            step_toward(now.turn, turn, vehicle.turn_change * time)};
}

inline Motion step_vehicle(const Vehicle& vehicle, const Motion& now, const Command& wanted, double time) {
    const Command made = within_limits(vehicle, now, wanted, time);
    const double rate = turn_rate(vehicle, made.speed, made.turn);
    return {advance_pose(now.pose, made.speed, rate, time), made.speed, made.turn};
}

}  // namespace cspace::mobile
