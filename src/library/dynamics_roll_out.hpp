// Roll-outs of all rows: on threads, interruptible, up to a time limit.
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "kernels/dynamics_simulation.hpp"

namespace cspace::dynamics {

using Deadline = std::chrono::steady_clock::time_point;

// Rows of step k to k_end by steps of one length; those that run when the deadline passes are out of time.
// With k_end = steps + 1 the state at the end is looked at too. threads: at most so many (0: all).
void roll_out(const RollOut& task, std::size_t rows, long long k, long long k_end, int threads,
              Deadline deadline);

// The same by the adaptive method; the steps of each row that it took are added to `pieces` (rows,).
void roll_out_adaptively(const RollOut& task, std::size_t rows, long long k, long long k_end, int threads,
                         Deadline deadline, std::vector<std::vector<double>>& pieces);

}  // namespace cspace::dynamics
