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

// The columns first to last − 1 of one panel of P += Σ X_k Y_kᵀ, of `rank` vectors that are `stride` numbers
// apart.
template <int rank>
CSPACE_INLINE void add_to_panel(double* to, const double* X, const double* Y, std::ptrdiff_t stride, int first,
                                int last) {
    FrontPack x[rank];
    for (int k = 0; k < rank; ++k) x[k] = load_pack(X + k * stride);
    for (int c = first; c < last; ++c) {
        FrontPack sum = load_pack(to + panel_rows * c);
        for (int k = 0; k < rank; ++k) sum = mul_add(x[k], fill<FrontPack>(Y[k * stride + c]), sum);
        store_pack(to + panel_rows * c, sum);
    }
}
// Two panels in a row at once: each number of Y is read once for both.
template <int rank>
CSPACE_INLINE void add_to_two_panels(double* upper, double* lower, const double* X, const double* Y,
                                     std::ptrdiff_t stride, int columns) {
    FrontPack x[rank], z[rank];
    for (int k = 0; k < rank; ++k) {
        x[k] = load_pack(X + k * stride);
        z[k] = load_pack(X + k * stride + panel_rows);
    }
    for (int c = 0; c < columns; ++c) {
        FrontPack sum = load_pack(upper + panel_rows * c), next = load_pack(lower + panel_rows * c);
        for (int k = 0; k < rank; ++k) {
            const FrontPack y = fill<FrontPack>(Y[k * stride + c]);
            sum = mul_add(x[k], y, sum), next = mul_add(z[k], y, next);
        }
        store_pack(upper + panel_rows * c, sum), store_pack(lower + panel_rows * c, next);
    }
    add_to_panel<rank>(lower, X + panel_rows, Y, stride, columns, columns + panel_rows);
}
// The same on panel p, and on the next one where there are two.
template <int rank>
CSPACE_INLINE void add_to_panels(double* panels, int p, bool are_two, const double* X, const double* Y,
                                 std::ptrdiff_t stride) {
    double* upper = panels + panel_offset(std::size_t(p));
    const int columns = panel_rows * (p + 1);
    X += panel_rows * p;
    if (are_two)
        add_to_two_panels<rank>(upper, panels + panel_offset(std::size_t(p) + 1), X, Y, stride, columns);
    else
        add_to_panel<rank>(upper, X, Y, stride, 0, columns);
}

// P += Σ X_k Y_kᵀ on the panels first to last − 1, of vectors padded with zeros to a multiple of four.
CSPACE_INLINE void add_products(double* panels, int first, int last, const double* X, const double* Y,
                                std::ptrdiff_t stride, int rank) {
    constexpr int block = 4;
    for (int p = first; p < last; p += 2) {
        const bool are_two = p + 1 < last;
        int k = 0;
        for (; k + block <= rank; k += block)
            add_to_panels<block>(panels, p, are_two, X + k * stride, Y + k * stride, stride);
        const double *x = X + k * stride, *y = Y + k * stride;
        if (rank - k == 3) add_to_panels<3>(panels, p, are_two, x, y, stride);
        if (rank - k == 2) add_to_panels<2>(panels, p, are_two, x, y, stride);
        if (rank - k == 1) add_to_panels<1>(panels, p, are_two, x, y, stride);
    }
}

}  // namespace cspace::localization::inline CSPACE_ISA
