#pragma once

#include "cspace/ik/redundant/arcs.hpp"
#include "cspace/ik/redundant/nearest_search.hpp"
#include "dispatch.hpp"

// The configuration on the manifold of a goal nearest to a seed; false where nothing reaches the goal.
CSPACE_KERNEL(bool, redundant_nearest,
              (const cspace::ik::Redundant& arm, const cspace::Posed& goal, const double* seed, double* q))

// The feasible intervals of joint `parameter`, which `locked` holds.
CSPACE_KERNEL(void, redundant_intervals,
              (const cspace::ik::Redundant& arm, const cspace::ik::LockedArm& locked, int parameter,
               const cspace::ik::LimitArms& arms, const cspace::Posed& goal, cspace::Trail& trail,
               cspace::ik::Intervals& out))

// All solutions at n values of joint `parameter`, the other held joints standing at their values `at`.
CSPACE_KERNEL(void, redundant_sweep,
              (const cspace::ik::LockedArm& locked, int parameter, const cspace::Posed& goal,
               const double* at, const double* values, int n, cspace::SweptRows* rows))

// Every solution for the joints that move, those held standing at their values `at`; idle: null, or the
// values of joints that the goal leaves free.
CSPACE_KERNEL(void, redundant_locked,
              (const cspace::ik::LockedArm& locked, const cspace::Posed& goal, const double* at,
               const double* idle, cspace::ik::Solutions& out))
