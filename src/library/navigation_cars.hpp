// Curves for cars, and cars on grids: what the bindings call.
#pragma once

#include <array>
#include <span>

#include "cspace/navigation/curves/curve.hpp"
#include "cspace/navigation/route.hpp"
#include "maps_grid.hpp"

namespace cspace::navigation {

// The shortest Dubins curve, or Reeds–Shepp curve of a car that reverses, and its length [m].
Curve find_shortest_curve(bool reverses, const CarPose& start, const CarPose& goal, double radius);
double curve_length(bool reverses, const CarPose& start, const CarPose& goal, double radius);
// One length per row.
void list_lengths(bool reverses, std::span<const CarPose> starts, std::span<const CarPose> goals,
                  double radius, std::span<double> lengths);
// Poses at the lengths s [m] along a curve of pieces (turn, length [m]).
void list_poses(const CarPose& start, std::span<const std::array<double, 2>> pieces, double radius,
                std::span<const double> s, std::span<CarPose> poses);

using BodyNumbers = std::array<double, 4>;  // of Footprint
// Writes whether a vehicle touches no blocked cell at poses.
void check_poses(const maps::GridWorld& world, const BodyNumbers& body, std::span<const CarPose> poses,
                 std::span<bool> is_clear);

// Hybrid A*. settings: turning radius, box, headings, reverse cost, gear cost, most nodes, weight.
CarRoute find_car_route(const maps::GridWorld& world, const BodyNumbers& body, const CarPose& start,
                        const CarPose& goal, bool reverses, const std::array<double, 7>& settings);

}  // namespace cspace::navigation
