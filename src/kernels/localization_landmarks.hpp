#pragma once
#include <cstddef>

#include "dispatch.hpp"

namespace cspace::localization {
struct WeightedVectors;
}

// See cspace/localization/landmarks/covariance_panels.hpp.
CSPACE_NARROW_KERNEL(cspace::localization, void, add_panel_products,
                     (double* panels, int first, int last, const double* X, const double* Y,
                      std::ptrdiff_t stride, int rank))
CSPACE_NARROW_KERNEL(cspace::localization, void, add_weighted_vectors,
                     (double* const* to, int count, const WeightedVectors& from))
