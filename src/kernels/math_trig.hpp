#pragma once
#include <cstddef>

#include "dispatch.hpp"

// Element-wise over n values; the tests measure the error of exactly these.
CSPACE_KERNEL(cspace, void, sincos_n, (const double* x, double* s, double* c, std::size_t n))
CSPACE_KERNEL(cspace, void, atan2_n, (const double* y, const double* x, double* angle, std::size_t n))
CSPACE_KERNEL(cspace, void, acos_n, (const double* x, double* angle, std::size_t n))
CSPACE_KERNEL(cspace, void, asin_n, (const double* x, double* angle, std::size_t n))
