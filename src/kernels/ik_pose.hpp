#pragma once

#include "cspace/ik/solution.hpp"
#include "dispatch.hpp"

namespace cspace::ik {
struct Arm;
struct NearestPose;
struct PositionSolutions;
}  // namespace cspace::ik

// The solver of an arm; it belongs to the instruction set that made it.
CSPACE_NARROW_KERNEL(void, ik_make_arm, (const cspace::ik::Chain& chain, cspace::ik::Arm& arm))

// Every solution of a pose, by whatever the arm needs; idle: null, or values of the joints that the goal
// leaves free.
CSPACE_NARROW_KERNEL(void, ik_pose,
                     (const cspace::ik::Arm& arm, const cspace::Posed& goal, const double* unconstrained,
                      cspace::ik::Solutions& out))

// The configuration that comes nearest to a pose; weight: of a radian, in lengths of the arm.
CSPACE_NARROW_KERNEL(void, ik_nearest_miss,
                     (const cspace::ik::Arm& arm, const cspace::Posed& goal, double weight,
                      cspace::ik::NearestPose& out))

// Every configuration of up to three joints that brings the tip to a point, and the nearest one if there is
// none.
CSPACE_NARROW_KERNEL(void, ik_position,
                     (const cspace::ik::Chain& chain, const cspace::Vec3d& goal, bool with_nearest,
                      cspace::ik::PositionSolutions& out))
