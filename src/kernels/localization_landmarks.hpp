#pragma once
#include <cstddef>

#include "dispatch.hpp"

// See cspace/localization/landmarks/covariance_panels.hpp.
CSPACE_NARROW_KERNEL(cspace::localization, void, add_panel_products,
                     (double* panels, int first, int last, const double* X, const double* Y,
                      std::ptrdiff_t stride, int rank))
