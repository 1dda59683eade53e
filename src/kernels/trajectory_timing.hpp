// The fastest motion along a path: passes over the intervals of its grid, backwards and forwards.
#pragma once

#include <cstddef>

#include "cspace/trajectory/speed_bounds.hpp"
#include "dispatch.hpp"

// memory: three times row_capacity numbers, aligned to 64 bytes; what they compute stands beside
// bound_speeds and raise_speeds. The degree of the slopes is 2 or 4.
CSPACE_KERNEL(cspace::trajectory, std::ptrdiff_t, bound_path_speeds,
              (const TimedRows& path, std::size_t begin, std::size_t end, SpeedRange* range, Carry* carry,
               double* memory))
CSPACE_KERNEL(cspace::trajectory, void, raise_path_speeds,
              (const TimedRows& path, std::size_t begin, std::size_t end, const SpeedRange* range,
               double* speed, Carry* carry, double* memory))
