#pragma once

#include "cspace/ik/solution.hpp"
#include "dispatch.hpp"

namespace cspace::ik {
struct Arm;
struct NearestPose;
struct PositionSolutions;
}  // namespace cspace::ik

// The solver of an arm; it belongs to the instruction set that made it.
CSPACE_KERNEL(cspace::ik, void, ik_make_arm, (const Chain& chain, Arm& arm))

// Every solution of a pose, by whatever the arm needs; idle: null, or values of the joints that the goal
// leaves free.
CSPACE_KERNEL(cspace::ik, void, ik_pose,
              (const Arm& arm, const Posed& goal, const double* unconstrained, Solutions& out))

// The configuration that comes nearest to a pose; weight: of a radian, in lengths of the arm.
CSPACE_KERNEL(cspace::ik, void, ik_nearest_miss,
              (const Arm& arm, const Posed& goal, double weight, NearestPose& out))

// Every configuration of up to three joints that brings the tip to a point, and the nearest one if there is
// none.
CSPACE_KERNEL(cspace::ik, void, ik_position,
              (const Chain& chain, const Vec3d& goal, bool with_nearest, PositionSolutions& out))
