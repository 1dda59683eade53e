// Rows of accelerations and jerks over the intervals of a path, and their barriers.
#pragma once

#include <cstddef>

#include "cspace/trajectory/jerk_rows.hpp"
#include "dispatch.hpp"

// rows: row_size numbers for each interval; the results of intervals begin … end − 1.
CSPACE_NARROW_KERNEL(cspace::trajectory, void, build_all_jerk_rows,
                     (const JerkPath& path, std::size_t begin, std::size_t end, double* rows,
                      double* largest))
CSPACE_NARROW_KERNEL(cspace::trajectory, void, sum_all_barriers,
                     (const JerkPath& path, std::size_t begin, std::size_t end, const double* rows,
                      const Squares* x, const Tangent* tangents, BarrierTerms* terms))
CSPACE_NARROW_KERNEL(cspace::trajectory, double, bound_all_steps,
                     (const JerkPath& path, std::size_t begin, std::size_t end, const double* rows,
                      const Squares* x, const Squares* change, const Tangent* tangents))
// most: degree + 1 numbers for each interval.
CSPACE_NARROW_KERNEL(cspace::trajectory, void, bound_all_jerks,
                     (const JerkPath& path, std::size_t begin, std::size_t end, const double* rows,
                      const Squares* x, double* most))
