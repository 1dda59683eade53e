// Every solution of arms of up to six joints: what the bindings call. The solver is opaque here; a goal is
// the 16 numbers of a pose, row by row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "cspace/ik/solution.hpp"

namespace cspace::ik {

struct Arm;
struct ReachBounds;

struct BuiltArm {
    std::shared_ptr<const Arm> arm;
    int dof;
    int room;             // rows that the solutions of a goal may need; 0 where nothing solves the arm
    bool has_few_joints;  // up to three joints: it answers points too
    std::shared_ptr<const ReachBounds> reach;
};
BuiltArm build_arm(const Chain& chain);

// Rows q, `stride` numbers apart, each with a branch number and a flag.
struct SolutionRows {
    int count;
    const double* q;
    int stride;
    const std::int8_t* branch;
    const char* self_motion;  // which rows stand for a self-motion; null: none
    Status status;
    bool complete = true;

    void copy_rows(int first, int dof, double* to) const;  // `first` rows of dof numbers
};
inline SolutionRows rows_of(const Solutions& found) {
    const auto* self_motion = reinterpret_cast<const char*>(found.self_motion);
    return {found.count, found.q[0], max_arm, found.branch, self_motion, found.status, found.complete};
}

// The memory of the rows of one goal.
struct SolutionStore {
    double q[max_solutions * max_joints];
    std::int8_t branch[max_branches];
    Solutions found;
};
// Every solution of a goal: by the closed form alone where nothing is in doubt. unconstrained: null, or
// values of the joints that the goal leaves free. False for a goal that is not a pose.
bool list_solutions(const BuiltArm& built, const double* goal, const double* unconstrained,
                    SolutionStore& store, SolutionRows& rows);

Solutions solve_point(const BuiltArm& built, const Vec3d& goal);

// In a verdict as a number: solutions may be missing.
inline constexpr int incomplete = 8;

// n goals, poses of 16 numbers or points of 3: q (n, room, dof) is padded with NaN, one count and one verdict
// per goal. Returns the first goal refused, or n.
struct GoalRows {
    const double* goals;
    std::size_t n;
    double* q;
    std::int64_t* count;
    unsigned char* status;
    int threads;
};
std::size_t solve_goals(const BuiltArm& built, const GoalRows& rows);
std::size_t solve_points(const BuiltArm& built, const GoalRows& rows);

// The configuration that comes nearest to a goal out of reach.
NearestPose nearest_to_goal(const BuiltArm& built, const double* goal, double stiffness);
// The configurations alone, q (n, dof).
void nearest_to_goals(const BuiltArm& built, const double* goals, std::size_t n, double stiffness, double* q,
                      int threads);
NearestPose nearest_to_point(const BuiltArm& built, const Vec3d& goal);

// Whether the lengths and directions of the axes alone rule the goal out.
bool is_ruled_out(const BuiltArm& built, const double* goal);

// Among solutions that stand alone the one within limits that is nearest to a seed. False where none is
// within limits, or the list is not settled.
bool nearest_listed(const BuiltArm& built, const double* lower, const double* upper, const double* goal,
                    const double* seed, double* q, std::int8_t* branch);

// Moves the revolute joints of q by multiples of 2π as close to the seed as the limits allow, if they allow
// any; any joint onto a limit that rounding takes it past. Returns the largest
// distance from the limits that is left.
double turn_to_seed(const bool* prismatic, int n, const double* lower, const double* upper,
                    const double* seed, double* q);

}  // namespace cspace::ik
