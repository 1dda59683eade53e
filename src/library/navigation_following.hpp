// The simulator of vehicles that follow paths: what the bindings call.
#pragma once

#include <span>
#include <vector>

#include "maps_grid.hpp"

namespace cspace::navigation {

// A run of a path begins at a row of its points and ends where the next begins; direction: ±1.
struct FollowRun {
    std::size_t first;
    int direction;
};

inline constexpr std::size_t follow_width = 7;  // x, y, theta, speed, turn, offset, progress

// The numbers of Vehicle, of a start (x, y, theta, speed, turn), of FollowSettings, of a controller and of
// Footprint. A controller: 0 pure pursuit (lookahead), 1 Stanley (gain, softening), 2 dynamic window (seven).
struct FollowTask {
    const double *vehicle, *start, *settings;
    int controller;
    const double* numbers;
    const maps::GridWorld* world;  // or null
    const double* footprint;
};

// Appends a row of follow_width numbers per step and returns the number of the outcome. Throws
// std::invalid_argument for runs of fewer than two points, or none.
int follow_path(std::span<const Point> points, std::span<const FollowRun> runs, const FollowTask& task,
                std::vector<double>& rows);

// Ranges from points at angles.
void cast_rays(const maps::GridWorld& world, std::span<const Point> from, const double* angles, double most,
               double* ranges);

}  // namespace cspace::navigation
