// The singular value decomposition of a small matrix by one-sided Jacobi rotations (Hestenes 1958): the
// columns of A are turned against each other until they are orthogonal, A V = U Σ. Small singular values keep
// their relative accuracy (Demmel & Veselić 1992), which is what a look near a singularity needs.
#pragma once

#include <cmath>

#include "cspace/math/isa.hpp"
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

// Turns the pairs (a[k], b[k]) by the angle with cosine c and sine s.
inline void turn_columns(double* a, double* b, int n, double c, double s) {
    for (int k = 0; k < n; ++k) {
        const double x = a[k], y = b[k];
        a[k] = c * x - s * y;
        b[k] = s * x + c * y;
    }
}

inline double dot_n(const double* a, const double* b, int n) {
    double sum = 0;
    for (int k = 0; k < n; ++k) sum += a[k] * b[k];
    return sum;
}

// The projection of v onto the span of the orthonormal vectors basis[0 … k), of unit length. Returns its
// length before that.
inline double project(const double* const* basis, int k, int n, double* v) {
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

// On entry us contains the columns of A.
template <int R, int C>
void decompose(SmallSvd<R, C>& m) {
    for (int j = 0; j < m.columns; ++j)
        for (int k = 0; k < m.columns; ++k) m.v[j][k] = j == k;
    constexpr double noise2 = 1e-36;  // the square of rounding on a column that is itself rounding
    // A column this small against the largest is rounding noise, whose direction never settles.
    double largest2 = 0;
    for (int j = 0; j < m.columns; ++j) largest2 = std::fmax(largest2, dot_n(m.us[j], m.us[j], m.rows));
    const double nothing = noise2 * largest2;
    bool moved = true;
    for (int sweep = 0; moved && sweep < 40; ++sweep) {
        moved = false;
        for (int i = 0; i + 1 < m.columns; ++i)
            for (int j = i + 1; j < m.columns; ++j) {
                const double aa = dot_n(m.us[i], m.us[i], m.rows), bb = dot_n(m.us[j], m.us[j], m.rows);
                const double ab = dot_n(m.us[i], m.us[j], m.rows);
                if (!(std::fabs(ab) > tolerance::last_digits * std::sqrt(aa * bb)) ||
                    std::fmin(aa, bb) <= nothing)
                    continue;
                const double zeta = (bb - aa) / (2 * ab);
                const double t = std::copysign(1.0, zeta) / (std::fabs(zeta) + std::sqrt(1 + zeta * zeta));
                const double c = 1 / std::sqrt(1 + t * t), s = c * t;
                turn_columns(m.us[i], m.us[j], m.rows, c, s);
                turn_columns(m.v[i], m.v[j], m.columns, c, s);
                moved = true;
            }
    }
    for (int j = 0; j < m.columns; ++j) m.sigma[j] = std::sqrt(dot_n(m.us[j], m.us[j], m.rows));
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
