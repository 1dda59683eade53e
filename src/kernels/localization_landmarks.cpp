#include "localization_landmarks.hpp"

#include "cspace/localization/landmarks/covariance_panels.hpp"

namespace cspace::localization::inline CSPACE_ISA {

void add_panel_products(double* panels, int first, int last, const double* X, const double* Y,
                        std::ptrdiff_t stride, int rank) {
    add_products(panels, first, last, X, Y, stride, rank);
}

void add_weighted_vectors(double* const* to, int count, const WeightedVectors& from) {
    add_weighted(to, count, from);
}

}  // namespace cspace::localization::inline CSPACE_ISA
