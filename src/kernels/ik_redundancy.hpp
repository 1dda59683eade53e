#pragma once

#include "cspace/ik/solution.hpp"
#include "dispatch.hpp"

namespace cspace::ik {
struct Trail;
struct SweptRows;
struct Intervals;
struct LimitArms;
struct LockedArm;
struct Redundant;
}  // namespace cspace::ik

// ik_locked.cpp: plans of a redundant arm and of an arm with joints locked.
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_make_redundant,
                     (const Chain& chain, const double* lower, const double* upper, const double* weight,
                      Redundant& arm))
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_lock_joints,
                     (const Redundant& arm, const int* joints, int count, LockedArm& out))

// Every solution for the joints that move, those locked at their values `at`; idle: null, or the values of
// joints that the goal leaves free.
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_locked,
                     (const LockedArm& locked, const Posed& goal, const double* at,
                      const double* unconstrained, Solutions& out))

// ik_nearest.cpp: the configuration on the self-motion of a goal nearest to a seed; false where nothing
// reaches it.
CSPACE_NARROW_KERNEL(cspace::ik, bool, ik_nearest,
                     (const Redundant& arm, const Posed& goal, const double* seed, double* q))

// ik_intervals.cpp: the feasible intervals of joint `parameter`, which `locked` locks.
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_make_limit_arms, (const Redundant& arm, LimitArms& out))
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_intervals,
                     (const Redundant& arm, const LockedArm& locked, int parameter, const LimitArms& arms,
                      const Posed& goal, Trail& trail, Intervals& out))

// ik_sweep.cpp: all solutions at n values of joint `parameter`, the other locked joints at their values `at`.
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_sweep,
                     (const LockedArm& locked, int parameter, const Posed& goal, const double* at,
                      const double* values, int n, SweptRows* rows))
