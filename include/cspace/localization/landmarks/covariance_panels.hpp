// The covariance of many landmarks: the lower triangle of a symmetric matrix in panels of four rows, and its
// updates of low rank.
//
// Panel p holds the rows 4p to 4p + 3 column by column, columns 0 to 4p + 3: four numbers in a row are a
// pack. A matrix that grows appends panels and moves none. Row and column 2j and 2j + 1 belong to landmark j,
// so that a landmark fills half a panel; the rows of a half that is not there are zero.
#pragma once

#include <cstddef>

#include "cspace/math/sparse/front.hpp"

namespace cspace::localization {

inline constexpr int panel_rows = 4;

// Where a panel begins.
constexpr std::size_t panel_offset(std::size_t panel) { return 8 * panel * (panel + 1); }

// Vectors that are `stride` numbers apart, with factors of each: factor i of vector k is factors[k step + i].
struct WeightedVectors {
    const double* X;
    std::ptrdiff_t stride;
    int rank;
    const double* factors;
    std::ptrdiff_t step;
};

}  // namespace cspace::localization

namespace cspace::localization::inline CSPACE_ISA {

// P += Σ X_k Y_kᵀ on four columns of so many panels in a row, of `rank` vectors that are `stride` numbers
// apart. The numbers stay in registers while all vectors are added. X: at the rows of the first panel; Y: at
// the columns; to: the columns of each panel.
template <int panels>
CSPACE_INLINE void add_to_tile(double* const (&to)[panels], const double* X, const double* Y,
                               std::ptrdiff_t stride, int rank) {
    FrontPack sum[panels][panel_rows];
    for (int i = 0; i < panels; ++i) {
        for (int c = 0; c < panel_rows; ++c) sum[i][c] = load_pack(to[i] + panel_rows * c);
    }
    for (int k = 0; k < rank; ++k, X += stride, Y += stride) {
        FrontPack x[panels];
        for (int i = 0; i < panels; ++i) x[i] = load_pack(X + panel_rows * i);
        for (int c = 0; c < panel_rows; ++c) {
            const FrontPack y = fill_lanes<FrontPack>(Y[c]);
            for (int i = 0; i < panels; ++i) sum[i][c] = mul_add(x[i], y, sum[i][c]);
        }
    }
    for (int i = 0; i < panels; ++i) {
        for (int c = 0; c < panel_rows; ++c) store_pack(to[i] + panel_rows * c, sum[i][c]);
    }
}
// The same on all columns of the panels p to p + panels − 1, each of which has four more than the last.
template <int panels>
CSPACE_INLINE void add_to_panels(double* all, int p, const double* X, const double* Y, std::ptrdiff_t stride,
                                 int rank) {
    double* to[panels];
    for (int i = 0; i < panels; ++i) to[i] = all + panel_offset(std::size_t(p + i));
    X += panel_rows * p;
    const int shared = panel_rows * (p + 1);
    for (int c = 0; c < shared; c += panel_rows, Y += panel_rows) {
        add_to_tile<panels>(to, X, Y, stride, rank);
        for (int i = 0; i < panels; ++i) to[i] += panel_rows * panel_rows;
    }
    for (int more = 1; more < panels; ++more, Y += panel_rows) {
        for (int i = more; i < panels; ++i) {
            double* const one[1] = {to[i]};
            add_to_tile<1>(one, X + panel_rows * i, Y, stride, rank);
            to[i] += panel_rows * panel_rows;
        }
    }
}

// P += Σ X_k Y_kᵀ on the panels first to last − 1, of vectors padded with zeros to a multiple of four.
CSPACE_INLINE void add_products(double* panels, int first, int last, const double* X, const double* Y,
                                std::ptrdiff_t stride, int rank) {
    int p = first;
    for (; p + 3 <= last; p += 3) add_to_panels<3>(panels, p, X, Y, stride, rank);
    if (last - p == 2) add_to_panels<2>(panels, p, X, Y, stride, rank);
    if (last - p == 1) add_to_panels<1>(panels, p, X, Y, stride, rank);
}

// to_i += Σ_k factor_ki X_k, whose lengths are the stride.
template <int count>
CSPACE_INLINE void add_weighted_to(double* const* to, const WeightedVectors& from) {
    for (std::ptrdiff_t c = 0; c < from.stride; c += panel_rows) {
        FrontPack sum[count];
        for (int i = 0; i < count; ++i) sum[i] = load_pack(to[i] + c);
        const double *x = from.X + c, *factor = from.factors;
        for (int k = 0; k < from.rank; ++k, x += from.stride, factor += from.step) {
            const FrontPack own = load_pack(x);
            for (int i = 0; i < count; ++i) sum[i] = mul_add(own, fill_lanes<FrontPack>(factor[i]), sum[i]);
        }
        for (int i = 0; i < count; ++i) store_pack(to[i] + c, sum[i]);
    }
}
// The same for two or three vectors to_i.
CSPACE_INLINE void add_weighted(double* const* to, int count, const WeightedVectors& from) {
    if (count == 2) add_weighted_to<2>(to, from);
    if (count == 3) add_weighted_to<3>(to, from);
}

}  // namespace cspace::localization::inline CSPACE_ISA
