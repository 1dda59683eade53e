// The kernels of inverse kinematics, file by file. A solver belongs to the instruction set that made it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cspace/ik/solution.hpp"
#include "dispatch.hpp"

namespace cspace::ik {
enum class CurveEnd;
struct Arm;
struct DescentRows;
struct LimitArms;
struct LockedArm;
struct PathRows;
struct PositionSolutions;
struct Redundant;
struct SweptRows;
struct SwivelArm;
struct Track;
struct Trail;
}  // namespace cspace::ik

// --- ik_closed_form.cpp --------------------------------------------------------------------------------
// One goal, 16 numbers in row-major order; q takes up to max_branches rows of 6 and branch their numbers.
CSPACE_KERNEL(cspace::ik, FastPath, ik_one,
              (const Arm& arm, const double* T, double* q, std::int8_t* branch, int* count))
// n goals of 16 numbers each, of a batch of `batch`; q (n, room, dof), room from max_branches to
// max_solutions, is filled up with NaN behind the solutions. `quick` takes a verdict per goal.
CSPACE_KERNEL(cspace::ik, void, ik_many,
              (const Arm& arm, const double* T, std::size_t n, std::size_t batch, int room, double* q,
               std::int64_t* count, FastPath* quick))

// --- ik_general.cpp ------------------------------------------------------------------------------------
// The arm points to the solver of its general part, in the copy that made it.
CSPACE_KERNEL(cspace::ik, void, ik_make_arm, (const Chain& chain, Arm& arm))

// --- ik_pose.cpp ---------------------------------------------------------------------------------------
// Every solution of a pose, by whatever the arm needs; unconstrained: null, or values of the joints that the
// goal leaves free.
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_pose,
                     (const Arm& arm, const Posed& goal, const double* unconstrained, Solutions& out))
// The configuration that comes nearest to a pose; weight: of a radian, in lengths of the arm.
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_nearest_miss,
                     (const Arm& arm, const Posed& goal, double weight, NearestPose& out))
// Every configuration of up to three joints that brings the tip to a point, and the nearest one if there is
// none.
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_position,
                     (const Chain& chain, const Vec3d& goal, bool with_nearest, PositionSolutions& out))

// --- ik_locked.cpp: plans of a redundant arm and of an arm with joints locked ------------------------------
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_make_redundant,
                     (const Chain& chain, const double* lower, const double* upper, const double* weight,
                      Redundant& arm))
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_lock_joints,
                     (const Redundant& arm, const int* joints, int count, LockedArm& out))
// Every solution for the joints that move, those locked at their values `at`; unconstrained: as of ik_pose.
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_locked,
                     (const LockedArm& locked, const Posed& goal, const double* at,
                      const double* unconstrained, Solutions& out))

// --- ik_locked_rows.cpp --------------------------------------------------------------------------------
// The goals (rows, 16) of the joints that move, where those locked are the first or the last; at: the values
// of all joints, rows `stride` apart.
CSPACE_KERNEL(cspace::ik, void, locked_goals,
              (const LockedArm& locked, const double* goals, const double* at, std::size_t stride,
               std::size_t rows, double* moved))
// Rows (count, 6) of the joints that move together with the locked ones, in `room` rows, NaN behind them.
CSPACE_KERNEL(cspace::ik, void, locked_rows,
              (const LockedArm& locked, const double* at, const double* q, std::int64_t count,
               std::size_t room, double* rows))

// --- ik_nearest.cpp ------------------------------------------------------------------------------------
// The configuration on the self-motion of a goal nearest to a seed; false where nothing reaches the goal.
CSPACE_NARROW_KERNEL(cspace::ik, bool, ik_nearest,
                     (const Redundant& arm, const Posed& goal, const double* seed, double* q))
// The same, where it is proven to be the nearest; false elsewhere.
CSPACE_NARROW_KERNEL(cspace::ik, bool, ik_nearest_proven,
                     (const Redundant& arm, const Posed& goal, const double* seed, double* q))
// The same within limits; false where none was found. arms: null unless one joint is redundant. trail: memory
// to follow arcs in, where samples of that joint are too few; null without.
CSPACE_NARROW_KERNEL(cspace::ik, bool, ik_nearest_within,
                     (const Redundant& arm, const LimitArms* arms, const Posed& goal, const double* seed,
                      Trail* trail, double* q))
// The nearest within limits that a configuration `start` within limits leads to.
CSPACE_NARROW_KERNEL(cspace::ik, bool, ik_nearest_from,
                     (const Redundant& arm, const Posed& goal, const double* seed, const double* start,
                      double* q))

// --- ik_intervals.cpp: the feasible intervals of joint `parameter`, which `locked` locks -------------------
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_make_limit_arms, (const Redundant& arm, LimitArms& out))
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_intervals,
                     (const Redundant& arm, const LockedArm& locked, int parameter, const LimitArms& arms,
                      const Posed& goal, Trail& trail, Intervals& out))

// --- ik_sweep.cpp --------------------------------------------------------------------------------------
// All solutions at n values of joint `parameter`, the other locked joints at their values `at`.
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_sweep,
                     (const LockedArm& locked, int parameter, const Posed& goal, const double* at,
                      const double* values, int n, SweptRows* rows))

// --- ik_arm_angle.cpp ----------------------------------------------------------------------------------
// All solutions of a goal at n swivels: q (n, 8, 7), NaN in rows without a solution.
CSPACE_NARROW_KERNEL(cspace::ik, void, swivel_solutions,
                     (const SwivelArm& arm, const Posed& goal, const double* swivels, int n, double* q))

// --- ik_numeric.cpp ------------------------------------------------------------------------------------
// Descents on the pose error: see cspace/ik/numeric/descent.hpp.
CSPACE_KERNEL(cspace::ik, void, ik_descend, (const DescentRows& rows))

// --- ik_self_motion.cpp --------------------------------------------------------------------------------
// The unit direction of the self-motion through q; false where there is none.
CSPACE_KERNEL(cspace::ik, bool, ik_self_motion_direction,
              (const Chain& chain, const double* q, bool whole_pose, double* direction))
// The curve through q, from there in a direction: calls visit(data, q, tangent) at its points.
CSPACE_KERNEL(cspace::ik, CurveEnd, ik_follow_self_motion,
              (const Chain& chain, const double* q, const double* direction, bool whole_pose,
               void (*visit)(void* data, const double* q, const double* tangent), void* data))
// Brings k rows onto the curve through q; their tangents on entry say which way it runs. NaN in rows that do
// not arrive.
CSPACE_KERNEL(cspace::ik, void, ik_project_on_self_motion,
              (const Chain& chain, const double* q, bool whole_pose, int k, double* rows, double* tangents))

// --- ik_tracking.cpp -----------------------------------------------------------------------------------
// Branches along a path of poses: see cspace/ik/tracking/follow.hpp.
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_track, (const Track& track))
// Configurations along a Cartesian path: see cspace/ik/tracking/along.hpp.
CSPACE_NARROW_KERNEL(cspace::ik, void, ik_path_rows, (const PathRows& rows))
