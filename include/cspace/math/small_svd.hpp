// The singular value decomposition of a small matrix by one-sided Jacobi rotations (Hestenes 1958): the
// columns of A are turned against each other until they are orthogonal, A V = U Σ. Small singular values keep
// their relative accuracy (Demmel & Veselić 1992), which is what a look near a singularity needs.
#pragma once

#include <cmath>
#include <utility>

#include "cspace/math/linear.hpp"
#include "cspace/tolerances.hpp"

namespace cspace {

// A (rows × columns) as columns of U Σ; the singular values are unsorted.
template <int max_rows, int max_columns>
struct SmallSvd {
    int rows, columns;
    double us[max_columns][max_rows];    // column j of U times sigma[j]
    double v[max_columns][max_columns];  // column j of V
    double sigma[max_columns];
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

// The projection of v onto the span of the orthonormal vectors basis[0 … k), of unit length. Returns its
// length before that.
inline double project_vector(const double* const* basis, int k, int n, double* v) {
    double part[16];
    for (int j = 0; j < k; ++j) part[j] = dot_n(basis[j], v, n);
    for (int i = 0; i < n; ++i) {
        v[i] = 0;
        for (int j = 0; j < k; ++j) v[i] += part[j] * basis[j][i];
    }
    const double size = std::sqrt(dot_n(v, v, n));
    for (int i = 0; i < n; ++i) v[i] = size > 0 ? v[i] / size : 0;
    return size;
}

// The columns of A, and of V below them, as lanes: row k is entry k of every column.
template <int W, int R>
struct SvdLanes {
    Pack<W> row[R + W];
    int height, rows;  // of A, of A and V together
    int span;          // a power of two that is not below the number of columns
};

// Turns every column i against column i ^ s. Returns whether a pair was not orthogonal yet.
template <int s, int W, int R>
bool turn_pairs(SvdLanes<W, R>& m, double nothing) {
    constexpr double tolerance2 = tolerance::last_digits * tolerance::last_digits;
    const int height = R <= W ? R : m.height;  // a constant for small matrices; the rows past A are zero
    Pack<W> other[R], own2 = fill_lanes<Pack<W>>(0), both = own2, order = own2;
    for (int k = 0; k < height; ++k) {
        other[k] = swap_lanes<s>(m.row[k]);
        own2 = mul_add(m.row[k], m.row[k], own2);
        both = mul_add(m.row[k], other[k], both);
    }
    const Pack<W> other2 = swap_lanes<s>(own2);
    const Mask<W> apart = both * both > tolerance2 * (own2 * other2) && min(own2, other2) > nothing;
    if (!any(apart)) return false;
    // The tangent p / (d + √(d² + p²)) of the smaller angle; the two of a pair have opposite signs.
    for (int i = 0; i < W; ++i) set_lane(order, i, (i ^ s) > i ? 1 : -1);
    const Pack<W> difference = other2 - own2, p = both + both;
    const Pack<W> sign = sign_bit(select_lanes(difference == 0.0, order, difference)), d = abs(difference);
    const Pack<W> t = keep_lanes(apart, bit_xor(p / (d + sqrt(mul_add(d, d, p * p))), sign));
    const Pack<W> c = 1.0 / sqrt(mul_add(t, t, fill_lanes<Pack<W>>(1))), sine = c * t;
    for (int k = 0; k < height; ++k) m.row[k] = c * m.row[k] - sine * other[k];
    for (int k = height; k < m.rows; ++k) m.row[k] = c * m.row[k] - sine * swap_lanes<s>(m.row[k]);
    return true;
}
template <int W, int R, int... rounds>
bool turn_all_pairs(SvdLanes<W, R>& m, double nothing, std::integer_sequence<int, rounds...>) {
    bool moved = false;
    ((moved |= rounds + 1 < m.span && turn_pairs<rounds + 1>(m, nothing)), ...);
    return moved;
}

// At most eight columns.
template <int R, int C>
void decompose_on_lanes(SmallSvd<R, C>& m, bool from_v) {
    constexpr int W = 8;
    constexpr double noise2 = 1e-36;  // the square of rounding on a column that is itself rounding
    SvdLanes<W, R> lanes;
    const int height = lanes.height = R <= W ? R : m.rows;
    lanes.rows = height + m.columns;
    lanes.span = m.columns > 4 ? W : 4;
    for (int k = 0; k < lanes.rows; ++k) lanes.row[k] = fill_lanes<Pack<W>>(0);
    double largest2 = 0;
    for (int j = 0; j < m.columns; ++j) {
        Pack<W>& v = lanes.row[height + j];
        if (from_v) {
            for (int i = 0; i < m.columns; ++i) set_lane(v, i, m.v[i][j]);
        } else {
            set_lane(v, j, 1);
        }
        for (int k = 0; k < m.rows; ++k)
            lanes.row[k] = mul_add(fill_lanes<Pack<W>>(m.us[j][k]), v, lanes.row[k]);
        largest2 = max(largest2, dot_n(m.us[j], m.us[j], m.rows));
    }
    // A column this small against the largest is rounding noise, whose direction never settles.
    const double nothing = noise2 * largest2;
    for (int sweep = 0; sweep < 40; ++sweep)
        if (!turn_all_pairs(lanes, nothing, std::make_integer_sequence<int, W - 1>())) break;
    for (int j = 0; j < m.columns; ++j) {
        for (int k = 0; k < m.rows; ++k) m.us[j][k] = get_lane(lanes.row[k], j);
        for (int k = 0; k < m.columns; ++k) m.v[j][k] = get_lane(lanes.row[height + k], j);
        m.sigma[j] = std::sqrt(dot_n(m.us[j], m.us[j], m.rows));
    }
}
// More columns than rows: Aᵀ = Q L', so that A V = U Σ with V = Q V' and L'ᵀ V' = U Σ (Chan 1982).
template <int R, int C>
void decompose_wide(SmallSvd<R, C>& m) {
    static_assert(R <= 8, "the triangle has as many columns as A has rows");
    double A[C][R] = {}, diagonal[R], factor[R];
    const int columns = m.columns;
    for (int j = 0; j < columns; ++j)
        for (int k = 0; k < R; ++k) A[j][k] = k < m.rows ? m.us[j][k] : 0;
    for (int k = 0; k < m.rows; ++k) linear::reduce_column(A, columns, m.rows, k, diagonal[k], factor[k]);
    for (int j = 0; j < m.rows; ++j)
        for (int k = 0; k < m.rows; ++k) m.us[j][k] = k < j ? 0 : k == j ? diagonal[k] : A[j][k];
    m.columns = m.rows;
    decompose_on_lanes(m, false);
    m.columns = columns;
    for (int j = 0; j < columns; ++j) {
        const bool null = j >= m.rows;
        for (int k = 0; k < columns; ++k) m.v[j][k] = null ? k == j : k < m.rows ? m.v[j][k] : 0;
        for (int k = m.rows - 1; k >= 0; --k) linear::reflect_vector(A, columns, k, factor[k], m.v[j]);
        for (int k = 0; k < m.rows && null; ++k) m.us[j][k] = 0;
        if (null) m.sigma[j] = 0;
    }
}
// On entry us contains the columns of A. from_v: v contains those of a similar matrix, with which it takes
// fewer turns.
template <int R, int C>
CSPACE_NOINLINE void decompose_matrix(SmallSvd<R, C>& m, bool from_v = false) {
    if constexpr (C > 8) {
        if (m.columns > 8) return decompose_wide(m);
    }
    decompose_on_lanes(m, from_v);
}

template <int R, int C>
int weakest_direction(const SmallSvd<R, C>& m) {
    int k = 0;
    for (int j = 1; j < m.columns; ++j)
        if (m.sigma[j] < m.sigma[k]) k = j;
    return k;
}

// The x of least |A x − e|² + damping |x|² without a part along the directions whose singular values are at
// most `floor`, nor along direction `skipped` (−1: none). A is decomposed.
template <int R, int C>
void least_norm_step(const SmallSvd<R, C>& m, const double* e, double damping, double floor, int skipped,
                     double* x) {
    for (int i = 0; i < m.columns; ++i) x[i] = 0;
    for (int j = 0; j < m.columns; ++j) {
        if (j == skipped || m.sigma[j] <= floor) continue;
        const double along = dot_n(m.us[j], e, m.rows) / (m.sigma[j] * m.sigma[j] + damping);
        for (int i = 0; i < m.columns; ++i) x[i] += along * m.v[j][i];
    }
}

}  // namespace cspace::inline CSPACE_ISA
