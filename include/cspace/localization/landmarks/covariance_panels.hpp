// The covariance of many landmarks: the lower triangle of a symmetric matrix in panels of four rows, and its
// updates of low rank.
//
// Panel p holds the rows 4p to 4p + 3 column by column, columns 0 to 4p + 3: four numbers in a row are a pack.
// A matrix that grows appends panels and moves none. Row and column 2j and 2j + 1 belong to landmark j, so
// that a landmark fills half a panel; the rows of a half that is not there are zero.
#pragma once

#include <cstddef>

#include "cspace/math/sparse/front.hpp"

namespace cspace::localization {

inline constexpr int panel_rows = 4;

// Where a panel begins.
constexpr std::size_t panel_offset(std::size_t panel) { return 8 * panel * (panel + 1); }

}  // namespace cspace::localization

namespace cspace::localization::inline CSPACE_ISA {

// One panel of P += Σ X_k Y_kᵀ for `rank` vectors, each `stride` numbers after the one before.
template <int rank>
CSPACE_INLINE void add_to_panel(double* to, const double* X, const double* Y, std::ptrdiff_t stride, int row,
                                int columns) {
    FrontPack x[rank];
    for (int k = 0; k < rank; ++k) x[k] = load_pack(X + k * stride + row);
    for (int c = 0; c < columns; ++c) {
        FrontPack sum = load_pack(to + panel_rows * c);
        for (int k = 0; k < rank; ++k) sum = mul_add(x[k], fill<FrontPack>(Y[k * stride + c]), sum);
        store_pack(to + panel_rows * c, sum);
    }
}

// P += Σ X_k Y_kᵀ on the panels first to last − 1, of vectors padded with zeros to a multiple of four.
CSPACE_INLINE void add_products(double* panels, int first, int last, const double* X, const double* Y,
                                std::ptrdiff_t stride, int rank) {
    constexpr int block = 4;
    for (int p = first; p < last; ++p) {
        double* to = panels + panel_offset(std::size_t(p));
        const int row = panel_rows * p, columns = panel_rows * (p + 1);
        int k = 0;
        for (; k + block <= rank; k += block)
            add_to_panel<block>(to, X + k * stride, Y + k * stride, stride, row, columns);
        const double *x = X + k * stride, *y = Y + k * stride;
        if (rank - k == 3) add_to_panel<3>(to, x, y, stride, row, columns);
        if (rank - k == 2) add_to_panel<2>(to, x, y, stride, row, columns);
        if (rank - k == 1) add_to_panel<1>(to, x, y, stride, row, columns);
    }
}

}  // namespace cspace::localization::inline CSPACE_ISA
