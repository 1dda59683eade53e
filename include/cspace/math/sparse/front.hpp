// Dense fronts of a sparse Cholesky factorisation: the lower factor of the pivot columns, the Schur
// complement on the rows below, and the triangular solves (Duff & Reid 1983; register blocks as in Goto & van
// de Geijn 2008).
//
// A panel holds the pivot columns of a front, column by column, `stride` numbers each: first the rows of the
// pivots, then the others, filled with zeros up to a multiple of four. The Schur complement is a square of
// such a multiple. What stands above the diagonals is undefined.
#pragma once

#include <cstddef>
#include <cstring>

#include "cspace/math/lanes.hpp"

namespace cspace::inline CSPACE_ISA {

inline constexpr int front_lanes = 4;        // rows per pack, and columns per register block
inline constexpr int front_strip_packs = 3;  // a strip of 12 rows and 4 columns fills sixteen registers

using FrontPack = Pack<front_lanes>;

CSPACE_INLINE FrontPack load_pack(const double* from) {
    FrontPack pack;
    std::memcpy(&pack, from, sizeof pack);
    return pack;
}
CSPACE_INLINE void store_pack(double* to, FrontPack pack) { std::memcpy(to, &pack, sizeof pack); }

// C(r, c) −= Σ_k A(r, k) B(c, k) for `packs` packs of rows and so many columns.
template <int packs, int columns>
CSPACE_INLINE void subtract_block(double* C, std::ptrdiff_t stride_c, const double* A, const double* B,
                                  std::ptrdiff_t stride, int count) {
    FrontPack sum[columns][packs];
    for (int c = 0; c < columns; ++c) {
        for (int i = 0; i < packs; ++i) sum[c][i] = fill_lanes<FrontPack>(0.0);
    }
    for (int k = 0; k < count; ++k, A += stride, B += stride) {
        FrontPack a[packs];
        for (int i = 0; i < packs; ++i) a[i] = load_pack(A + front_lanes * i);
        for (int c = 0; c < columns; ++c) {
            const FrontPack b = fill_lanes<FrontPack>(B[c]);
            for (int i = 0; i < packs; ++i) sum[c][i] = mul_add(a[i], b, sum[c][i]);
        }
    }
    for (int c = 0; c < columns; ++c) {
        for (int i = 0; i < packs; ++i) {
            double* const to = C + c * stride_c + front_lanes * i;
            store_pack(to, load_pack(to) - sum[c][i]);
        }
    }
}

// The same for a number of rows that is a multiple of four.
template <int columns>
CSPACE_INLINE void subtract_rows(double* C, std::ptrdiff_t stride_c, const double* A, const double* B,
                                 std::ptrdiff_t stride, int rows, int count) {
    constexpr int strip = front_lanes * front_strip_packs;
    int r = 0;
    for (; r + strip <= rows; r += strip)
        subtract_block<front_strip_packs, columns>(C + r, stride_c, A + r, B, stride, count);
    if (rows - r >= 2 * front_lanes) {
        subtract_block<2, columns>(C + r, stride_c, A + r, B, stride, count);
        r += 2 * front_lanes;
    }
    if (r < rows) subtract_block<1, columns>(C + r, stride_c, A + r, B, stride, count);
}

// Factors the square at the head of so many updated columns; false where a pivot is not positive. The rows of
// `head` below its diagonal, and the inverses of the pivots.
template <int columns>
CSPACE_INLINE bool factor_head(double* block, std::ptrdiff_t stride, double (&head)[columns][columns],
                               double (&inverse)[columns]) {
    for (int c = 0; c < columns; ++c) {
        for (int r = c; r < columns; ++r) {
            double sum = block[c * stride + r];
            for (int k = 0; k < c; ++k) sum -= head[r][k] * head[c][k];
            if (r == c) {
                if (!(sum > 0)) return false;
                head[c][c] = std::sqrt(sum);
                inverse[c] = 1 / head[c][c];
            } else {
                head[r][c] = sum * inverse[c];
            }
            block[c * stride + r] = head[r][c];
        }
    }
    return true;
}

// X Lᵀ = A in place, for the rows of one scalar or pack.
template <class V, int columns, class Load, class Store>
CSPACE_INLINE void solve_head(const double (&head)[columns][columns], const double (&inverse)[columns],
                              const Load& load, const Store& store) {
    V x[columns];
    for (int c = 0; c < columns; ++c) {
        V sum = load(c);
        for (int k = 0; k < c; ++k) sum = mul_add(fill_lanes<V>(-head[c][k]), x[k], sum);
        x[c] = sum * fill_lanes<V>(inverse[c]);
        store(c, x[c]);
    }
}

template <int columns>
CSPACE_INLINE bool factor_columns_of(double* panel, int stride, int first) {
    const std::ptrdiff_t step = std::ptrdiff_t(stride);
    double* const block = panel + first * step;
    if (first > 0) {
        // Rows above the diagonal complete the last pack; they are undefined anyway.
        const int rows = (stride - first + front_lanes - 1) / front_lanes * front_lanes;
        const int begin = stride - rows;
        subtract_rows<columns>(block + begin, step, panel + begin, panel + first, step, rows, first);
    }
    double head[columns][columns], inverse[columns];
    if (!factor_head<columns>(block + first, step, head, inverse)) return false;
    int r = first + columns;
    for (; (stride - r) % front_lanes; ++r) {
        solve_head<double, columns>(
            head, inverse, [&](int c) { return block[c * step + r]; },
            [&](int c, double x) { block[c * step + r] = x; });
    }
    for (; r < stride; r += front_lanes) {
        solve_head<FrontPack, columns>(
            head, inverse, [&](int c) { return load_pack(block + c * step + r); },
            [&](int c, FrontPack x) { store_pack(block + c * step + r, x); });
    }
    return true;
}

// Factors up to four columns of a panel from `first`, a multiple of four, after all columns before them.
// False where the front is not positive definite.
CSPACE_INLINE bool factor_columns(double* panel, int stride, int pivots, int first) {
    switch (pivots - first) {
        case 1:
            return factor_columns_of<1>(panel, stride, first);
        case 2:
            return factor_columns_of<2>(panel, stride, first);
        case 3:
            return factor_columns_of<3>(panel, stride, first);
        default:
            return factor_columns_of<4>(panel, stride, first);
    }
}

// Subtracts the product of the rows below the pivots from one strip of up to twelve rows of the Schur
// complement, a square of `size` rows, a multiple of four; row: the first of the strip, a multiple of twelve.
CSPACE_INLINE void update_strip(double* schur, int size, const double* panel, int stride, int pivots,
                                int row) {
    const std::ptrdiff_t step = std::ptrdiff_t(size);
    const double* const below = panel + pivots;
    const int left = size - row;
    const int packs = left < front_lanes * front_strip_packs ? left / front_lanes : front_strip_packs;
    for (int c = 0; c < row + packs * front_lanes; c += front_lanes) {
        double* const C = schur + c * step + row;
        if (packs == front_strip_packs)
            subtract_block<3, 4>(C, step, below + row, below + c, std::ptrdiff_t(stride), pivots);
        else if (packs == 2)
            subtract_block<2, 4>(C, step, below + row, below + c, std::ptrdiff_t(stride), pivots);
        else
            subtract_block<1, 4>(C, step, below + row, below + c, std::ptrdiff_t(stride), pivots);
    }
}

// L x = b of one front: x has the pivots, then the rows below, which lose their part.
CSPACE_INLINE void solve_lower(const double* panel, int stride, int pivots, double* x) {
    for (int k = 0; k < pivots; ++k) {
        const double* const column = panel + std::ptrdiff_t(k) * std::ptrdiff_t(stride);
        const double pivot = x[k] / column[k];
        x[k] = pivot;
        int r = k + 1;
        for (; (stride - r) % front_lanes; ++r) x[r] -= pivot * column[r];
        const FrontPack factor = fill_lanes<FrontPack>(-pivot);
        for (; r < stride; r += front_lanes)
            store_pack(x + r, mul_add(factor, load_pack(column + r), load_pack(x + r)));
    }
}

// Lᵀ x = b of one front: the rows below the pivots are known.
CSPACE_INLINE void solve_upper(const double* panel, int stride, int pivots, double* x) {
    for (int k = pivots - 1; k >= 0; --k) {
        const double* const column = panel + std::ptrdiff_t(k) * std::ptrdiff_t(stride);
        double sum = x[k];
        int r = k + 1;
        for (; (stride - r) % front_lanes; ++r) sum -= column[r] * x[r];
        FrontPack part = fill_lanes<FrontPack>(0.0);
        for (; r < stride; r += front_lanes) part = mul_add(load_pack(column + r), load_pack(x + r), part);
        for (int i = 0; i < front_lanes; ++i) sum -= get_lane(part, i);
        x[k] = sum / column[k];
    }
}

}  // namespace cspace::inline CSPACE_ISA
