#pragma once
#include <cstddef>
#include <cstdint>

#include "cspace/ik/solution.hpp"
#include "dispatch.hpp"

namespace cspace::ik {
struct Arm;
}

// One goal, 16 numbers in row-major order; q takes up to max_branches rows of 6 and branch their numbers.
CSPACE_KERNEL(cspace::ik, FastPath, ik_one,
              (const Arm& arm, const double* T, double* q, std::int8_t* branch, int* count))

// n goals of 16 numbers each; q (n, room, dof), room from max_branches to max_solutions, is filled up with
// NaN behind the solutions. `quick` takes a verdict per goal.
CSPACE_KERNEL(cspace::ik, void, ik_many,
              (const Arm& arm, const double* T, std::size_t n, int room, double* q, std::int64_t* count,
               FastPath* quick))
