// M = Lᵀ D L of a mass matrix, from the last coordinate to the first, and systems with many right sides.
//
// An entry of M is zero where two joints do not carry each other. So is that of L where every joint stands
// behind those that carry it: then no entry fills in (Featherstone 2005; 2008, section 6.5). Zeros are looked
// for and left out, in whatever order the coordinates are.
#pragma once

#include "cspace/math/rows.hpp"

namespace cspace::dynamics {
// L left of the diagonal and D⁻¹ on it, row by row. Where L has entries: those of row i are at before[i n]
// and so on, n_before[i] of them; those of column i at behind[i n] and so on. used: memory for n numbers.
template <class V>
struct SparseFactor {
    int n;
    V* L;
    int *before, *n_before, *behind, *n_behind, *used;
};
}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

// factor.L, which is M, becomes L and D⁻¹; the upper triangle is neither read nor written. True where every
// pivot is above `least` of its entry in M.
template <class V>
CSPACE_INLINE mask_of<V> factor_sparse(const SparseFactor<V>& factor, double least) {
    const int n = factor.n;
    V* L = factor.L;
    mask_of<V> regular = fill_lanes<V>(1.0) > 0.0;
    for (int i = 0; i < n; ++i) {
        factor.n_before[i] = factor.n_behind[i] = 0;
        if (i < n - 1) L[i * n + n - 1] = L[i * n + i];  // the last column keeps the diagonal of M
    }
    for (int k = n - 1; k >= 0; --k) {
        V* row = L + k * n;
        int *before = factor.before + k * n, &count = factor.n_before[k];
        for (int i = 0; i < k; ++i) {
            if (all(row[i] == 0.0)) continue;
            before[count++] = i;
            factor.behind[i * n + factor.n_behind[i]++] = k;
        }
        const mask_of<V> positive = row[k] > least * row[n - 1];
        regular = regular && positive;
        row[k] = 1.0 / select_lanes(positive, row[k], fill_lanes<V>(1.0));
        for (int a = count - 1; a >= 0; --a) {
            const int i = before[a];
            const V multiple = row[i] * row[k];
            for (int b = 0; b <= a; ++b) {
                V& entry = L[i * n + before[b]];
                entry = mul_add(-multiple, row[before[b]], entry);
            }
            row[i] = multiple;
        }
    }
    return regular;
}

// w columns of B (n, columns) from column c on, row by row: those of M⁻¹ B take their place. W: V, or a pack
// of columns where V is one number. Rows of zeros, as of joints that do not carry each other, add nothing.
template <int w, class V, class W>
CSPACE_INLINE void solve_columns(const SparseFactor<V>& factor, W* B, int columns, int c) {
    const int n = factor.n;
    const auto number = [](V x) -> W {
        if constexpr (Lanes<V>::count == 1)
            return fill_lanes<W>(x);
        else
            return x;
    };
    const auto take_off = [&](const V& multiple, int k, W(&sum)[w]) {
        const W minus = number(-multiple);
        for (int j = 0; j < w; ++j) sum[j] = mul_add(minus, B[k * columns + c + j], sum[j]);
    };
    for (int i = n - 1; i >= 0; --i) {  // Lᵀ
        W sum[w];
        for (int j = 0; j < w; ++j) sum[j] = B[i * columns + c + j];
        for (int b = 0; b < factor.n_behind[i]; ++b) {
            const int k = factor.behind[i * n + b];
            if (factor.used[k]) take_off(factor.L[k * n + i], k, sum);
        }
        W bits = sum[0];
        for (int j = 1; j < w; ++j) bits = bit_or(bits, sum[j]);
        factor.used[i] = !all(bits == 0.0);
        for (int j = 0; j < w; ++j) B[i * columns + c + j] = sum[j];
    }
    for (int i = 0; i < n; ++i) {  // D L
        const W inverse = number(factor.L[i * (n + 1)]);
        W sum[w];
        for (int j = 0; j < w; ++j) sum[j] = B[i * columns + c + j] * inverse;
        for (int b = 0; b < factor.n_before[i]; ++b) {
            const int k = factor.before[i * n + b];
            take_off(factor.L[i * n + k], k, sum);
        }
        for (int j = 0; j < w; ++j) B[i * columns + c + j] = sum[j];
    }
}
// B (n, columns) becomes M⁻¹ B.
template <class V, class W>
CSPACE_INLINE void solve_sparse(const SparseFactor<V>& factor, W* B, int columns) {
    // L in packs and eight columns stay in the fastest cache together only where both are small.
    const bool both_fit = Lanes<V>::count == 1 || factor.n <= 16;
    int c = 0;
    for (; c + 8 <= columns && both_fit; c += 8) solve_columns<8>(factor, B, columns, c);
    for (; c + 4 <= columns; c += 4) solve_columns<4>(factor, B, columns, c);
    for (; c < columns; ++c) solve_columns<1>(factor, B, columns, c);
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
