#pragma once

#include "cspace/ik/solution.hpp"
#include "dispatch.hpp"

namespace cspace {
struct Trail;
struct SweptRows;
namespace ik {
struct Intervals;
struct LimitArms;
struct LockedArm;
struct Redundant;
}  // namespace ik
}  // namespace cspace

// ik_locked.cpp: plans of a redundant arm and of an arm with joints locked.
CSPACE_NARROW_KERNEL(void, ik_make_redundant,
                     (const cspace::ik::Chain& chain, const double* lower, const double* upper,
                      const double* weight, cspace::ik::Redundant& arm))
CSPACE_NARROW_KERNEL(void, ik_lock_joints,
                     (const cspace::ik::Redundant& arm, const int* joints, int count,
                      cspace::ik::LockedArm& out))

// Every solution for the joints that move, those locked at their values `at`; idle: null, or the values of
// joints that the goal leaves free.
CSPACE_NARROW_KERNEL(void, ik_locked,
                     (const cspace::ik::LockedArm& locked, const cspace::Posed& goal, const double* at,
                      const double* unconstrained, cspace::ik::Solutions& out))

// ik_nearest.cpp: the configuration on the self-motion of a goal nearest to a seed; false where nothing
// reaches it.
CSPACE_NARROW_KERNEL(bool, ik_nearest,
                     (const cspace::ik::Redundant& arm, const cspace::Posed& goal, const double* seed,
                      double* q))

// ik_intervals.cpp: the feasible intervals of joint `parameter`, which `locked` locks.
CSPACE_NARROW_KERNEL(void, ik_make_limit_arms, (const cspace::ik::Redundant& arm, cspace::ik::LimitArms& out))
CSPACE_NARROW_KERNEL(void, ik_intervals,
                     (const cspace::ik::Redundant& arm, const cspace::ik::LockedArm& locked, int parameter,
                      const cspace::ik::LimitArms& arms, const cspace::Posed& goal, cspace::Trail& trail,
                      cspace::ik::Intervals& out))

// ik_sweep.cpp: all solutions at n values of joint `parameter`, the other locked joints at their values `at`.
CSPACE_NARROW_KERNEL(void, ik_sweep,
                     (const cspace::ik::LockedArm& locked, int parameter, const cspace::Posed& goal,
                      const double* at, const double* values, int n, cspace::SweptRows* rows))
