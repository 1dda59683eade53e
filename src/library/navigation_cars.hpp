// Curves for cars, and cars on grids: what the bindings call.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "cspace/navigation/curves/curve.hpp"
#include "maps_grid.hpp"

namespace cspace::navigation {

// The shortest Dubins curve, or Reeds–Shepp curve of a car that reverses, and its length [m].
Curve find_shortest_curve(bool reverses, const CarPose& start, const CarPose& goal, double radius);
double curve_length(bool reverses, const CarPose& start, const CarPose& goal, double radius);
// One length per row.
Table<double> list_lengths(bool reverses, std::span<const CarPose> starts, std::span<const CarPose> goals,
                           double radius);
// Poses at the lengths s [m] along a curve of pieces (turn, length [m]).
Table<CarPose> list_poses(const CarPose& start, std::span<const std::array<double, 2>> pieces, double radius,
                          std::span<const double> s);

using BodyNumbers = std::array<double, 4>;  // of Footprint
// Whether a vehicle touches no blocked cell.
bool is_pose_clear(const maps::GridWorld& world, const BodyNumbers& body, const CarPose& pose);

// Hybrid A*. settings: turning radius, box, headings, reverse cost, gear cost, most nodes, weight. Returns
// status, reason, pieces (turn, length [m]), nodes and edges.
std::tuple<int, int, std::vector<std::pair<int, double>>, std::int64_t, std::int64_t> find_car_route(
    const maps::GridWorld& world, const BodyNumbers& body, const CarPose& start, const CarPose& goal,
    bool reverses, const std::array<double, 7>& settings);

}  // namespace cspace::navigation
