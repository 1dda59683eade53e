// Goals that leave freedom, many in one call: those of redundant arms, and partial goals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ik_solver.hpp"

namespace cspace::ik {

// The configuration of an arm from a row of its solver: joint j stands at row[column[j]], or is locked at
// value[j] where column[j] is negative.
struct RowMap {
    int n;
    const int* column;
    const double* value;
};

// n goals of 16 numbers. The solver lacks the joints that are locked, which `whole` puts back; for a partial
// goal the whole arm has virtual joints too, and the user's arm is `own` of its joints from `first` on.
struct GoalRequest {
    const double* goals;
    std::size_t n;
    RowMap whole;
    int first, own;
    bool is_partial;
    const double* seeds;  // near=, rows of the arm's joints; null without
    bool seed_each;
    int samples;  // values of one redundant joint at which branches are listed
    // locked= for all redundant joints: their plan and values, rows of the solver's joints; null without.
    const LockedArm* locked;
    const double* at;
    bool at_each;
    int threads;
};

// One answer per goal.
std::vector<GoalAnswer> answer_goals(Solver& solver, const GoalRequest& request);

}  // namespace cspace::ik
