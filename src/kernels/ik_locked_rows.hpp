#pragma once

#include <cstddef>
#include <cstdint>

#include "dispatch.hpp"

namespace cspace::ik {
struct LockedArm;
}

// The goals (rows, 16) of the joints that move, where those locked are the first or the last; at: the values
// of all joints, rows `stride` apart.
CSPACE_KERNEL(cspace::ik, void, locked_goals,
              (const LockedArm& locked, const double* goals, const double* at, std::size_t stride,
               std::size_t rows, double* moved))

// Rows (count, 6) of the joints that move together with the locked ones, in `room` rows, NaN behind them.
CSPACE_KERNEL(cspace::ik, void, locked_rows,
              (const LockedArm& locked, const double* at, const double* q, std::int64_t count,
               std::size_t room, double* rows))
