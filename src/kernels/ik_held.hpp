#pragma once

#include <cstdint>

#include "cspace/ik/redundant/locked_arm.hpp"
#include "dispatch.hpp"

// The goals (rows, 16) of the joints that move, where those held stand at the ends; at: the values of all
// joints, rows `stride` apart.
CSPACE_KERNEL(void, held_goals,
              (const cspace::ik::LockedArm& locked, const double* goals, const double* at, std::size_t stride,
               std::size_t rows, double* moved))

// Rows (count, 6) of the joints that move together with the held ones, in `room` rows, NaN behind them.
CSPACE_KERNEL(void, held_rows,
              (const cspace::ik::LockedArm& locked, const double* at, const double* q, std::int64_t count,
               std::size_t room, double* rows))
