// Many axes from state to state at once.
#pragma once

#include <cstddef>

#include "cspace/trajectory/minimum_time.hpp"
#include "dispatch.hpp"

namespace cspace::trajectory {

// Numbers of a Combination.
inline constexpr std::size_t combination_numbers = 15;

// Tasks of axes, an array of `count` numbers for each of their numbers. Jerks are limited.
struct AxisRows {
    std::size_t count;
    const double *v0, *a0, *vf, *af, *P, *v_max, *v_min, *a_max, *a_min, *jerk;
};

}  // namespace cspace::trajectory

// The shortest time of each axis.
CSPACE_KERNEL(cspace::trajectory, void, find_shortest_times, (const AxisRows& axes, double* time))
// The motion of each axis in a time, and whether it is possible; the k-th number of a Combination goes to
// motions[k * stride + i].
CSPACE_KERNEL(cspace::trajectory, void, attain_times,
              (const AxisRows& axes, const double* time, double* motions, std::size_t stride, bool* possible))
