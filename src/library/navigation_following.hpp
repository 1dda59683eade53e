// The simulator of vehicles that follow paths: what the bindings call.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "cspace/mobile/car_pose.hpp"
#include "maps_grid.hpp"
#include "table.hpp"

namespace cspace::navigation {

// A run of a path: the row of its points at which it begins, and its direction, ±1. It ends where the next
// begins.
using FollowRun = std::pair<std::size_t, int>;
using FollowRow = std::array<double, 7>;  // x, y, theta, speed, turn, offset, progress

// Where a vehicle takes itself to be at a time when it is at a pose.
using Belief = std::function<mobile::CarPose(double, const mobile::CarPose&)>;

// The numbers of Vehicle, of Motion at the start, of FollowSettings, of a controller (0 pure pursuit:
// lookahead; 1 Stanley: gain, softening; 2 dynamic window: WindowSettings) and of Footprint; a world or null;
// a belief, empty for a vehicle that knows where it is. Returns the number of the outcome and a row per step.
// Throws std::invalid_argument for runs of fewer than two points, or none.
std::pair<int, Table<FollowRow>> follow_path(
    std::span<const Point> points, const std::vector<FollowRun>& runs, const std::array<double, 6>& vehicle,
    const std::array<double, 5>& start, const std::array<double, 6>& settings, int controller,
    const std::array<double, 7>& numbers, const maps::GridWorld* world,
    const std::array<double, 4>& footprint, const Belief& belief);

}  // namespace cspace::navigation
