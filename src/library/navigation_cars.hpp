// Curves for cars, and cars on grids: what the bindings call.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cspace/navigation/curves/curve.hpp"
#include "cspace/navigation/route.hpp"
#include "maps_grid.hpp"

namespace cspace::navigation {

// The shortest Dubins curve, or Reeds–Shepp curve of a car that reverses, and its length [m].
Curve find_shortest_curve(bool reverses, const CarPose& start, const CarPose& goal, double radius);
double curve_length(bool reverses, const CarPose& start, const CarPose& goal, double radius);
// Poses at the lengths s [m] along a curve of pieces (turn, length [m]).
void list_poses(const CarPose& start, std::span<const double> pieces, double radius,
                std::span<const double> s, CarPose* out);

// footprint: the numbers of Footprint. Writes whether a vehicle touches no blocked cell at poses.
void check_poses(const maps::GridWorld& world, const double* footprint, std::span<const CarPose> poses,
                 bool* is_clear);

// Hybrid A*. settings: turning radius, box, headings, reverse cost, gear cost, most nodes, weight.
CarRoute find_car_route(const maps::GridWorld& world, const double* footprint, const CarPose& start,
                        const CarPose& goal, bool reverses, const double* settings);

}  // namespace cspace::navigation
