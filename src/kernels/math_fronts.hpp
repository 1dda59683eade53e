#pragma once
#include "dispatch.hpp"

// See cspace/math/sparse/front.hpp.
CSPACE_NARROW_KERNEL(cspace, bool, factor_front_columns, (double* panel, int stride, int pivots, int first))
CSPACE_NARROW_KERNEL(cspace, void, update_front_strip,
                     (double* schur, int size, const double* panel, int stride, int pivots, int row))
CSPACE_NARROW_KERNEL(cspace, void, solve_front_lower,
                     (const double* panel, int stride, int pivots, double* x))
CSPACE_NARROW_KERNEL(cspace, void, solve_front_upper,
                     (const double* panel, int stride, int pivots, double* x))
