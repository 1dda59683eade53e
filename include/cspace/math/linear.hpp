// Small dense systems on lanes: in place, without allocation, without branches where V is a pack.
//
// Each lane has separate unknowns and pivots. Singular lanes are reported by the mask that each
// function returns; their numbers are finite where the input is, and mean nothing.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "cspace/math/lanes.hpp"

namespace cspace {

// A matrix of run-time size by rows of n numbers.
template <class V>
struct MatrixRows {
    V* values;
    int n;
    CSPACE_INLINE V* operator[](int row) const { return values + row * n; }
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

inline double dot_n(const double* a, const double* b, int n) {
    double sum = 0;
    for (int k = 0; k < n; ++k) sum += a[k] * b[k];
    return sum;
}

namespace linear {

// Swaps the rows k and i, from column k on, of those lanes where row i has the larger entry in column k.
template <int n, class V>
CSPACE_INLINE void lift_pivot(V (&A)[n][n], V (&b)[n], int k, int i) {
    const auto larger = abs(A[i][k]) > abs(A[k][k]);
    if constexpr (Lanes<V>::count == 1) {
        if (!larger) return;
    }
    const auto swap = [&](V& upper, V& lower) {
        const V kept = upper;
        upper = select_lanes(larger, lower, upper);
        lower = select_lanes(larger, kept, lower);
    };
    for (int j = k; j < n; ++j) swap(A[k][j], A[i][j]);
    swap(b[k], b[i]);
}

// 1/x, and 1 in the lanes where x is zero.
template <class V>
CSPACE_INLINE V safe_inverse(V x) {
    return 1.0 / select_lanes(x == 0.0, fill_lanes<V>(1.0), x);
}
// Whether no diagonal entry is lost in the rounding of the largest.
template <int n, class V>
CSPACE_INLINE mask_of<V> full_rank(const V (&diagonal)[n]) {
    V largest = abs(diagonal[0]), smallest = largest;
    for (int k = 1; k < n; ++k) {
        largest = max(largest, abs(diagonal[k]));
        smallest = min(smallest, abs(diagonal[k]));
    }
    return smallest > (n * std::numeric_limits<double>::epsilon()) * largest;
}

// One step of factor_qr on the m rows and n columns of A, anything with rows A[i]: the reflection of column
// k.
template <class Matrix, class V>
CSPACE_INLINE void reduce_column(Matrix& A, int m, int n, int k, V& diagonal, V& factor) {
    V square = A[k][k] * A[k][k];
    for (int i = k + 1; i < m; ++i) square = mul_add(A[i][k], A[i][k], square);
    diagonal = -copysign(sqrt(square), A[k][k]);
    A[k][k] = A[k][k] - diagonal;
    factor = -safe_inverse(diagonal * A[k][k]);
    for (int j = k + 1; j < n; ++j) {
        V along = A[k][k] * A[k][j];
        for (int i = k + 1; i < m; ++i) along = mul_add(A[i][k], A[i][j], along);
        along = along * factor;
        for (int i = k; i < m; ++i) A[i][j] = mul_add(-along, A[i][k], A[i][j]);
    }
}
// The triangle and the reflections of A = Q R (Householder 1958; Golub & Van Loan 2013, section 5.2): R above
// the diagonal of A and in `diagonal`, the vectors v_k on and below it, I − factor_k v_k v_kᵀ. Of an A with
// more columns than `diagonal` the first ones are reduced, and the reflections reach the others.
template <int m, int n, int reduced, class V>
CSPACE_INLINE void factor_qr(V (&A)[m][n], V (&diagonal)[reduced], V (&factor)[reduced]) {
    for (int k = 0; k < reduced; ++k) reduce_column(A, m, n, k, diagonal[k], factor[k]);
}
// b := (I − factor v_k v_kᵀ) b, of m numbers.
template <class Matrix, class V>
CSPACE_INLINE void reflect_vector(const Matrix& A, int m, int k, V factor, V* b) {
    V along = A[k][k] * b[k];
    for (int i = k + 1; i < m; ++i) along = mul_add(A[i][k], b[i], along);
    along = along * factor;
    for (int i = k; i < m; ++i) b[i] = mul_add(-along, A[i][k], b[i]);
}

// A x = b by elimination with partial pivoting in each lane (Golub & Van Loan 2013, section 3.4). A is used
// up, b becomes x; `pivots` tell whether A is regular.
template <int n, class V>
CSPACE_INLINE void eliminate_lower(V (&A)[n][n], V (&b)[n], V (&pivots)[n]) {
    V inverse[n];
    for (int k = 0; k < n; ++k) {
        for (int i = k + 1; i < n; ++i) lift_pivot(A, b, k, i);
        pivots[k] = A[k][k];
        inverse[k] = safe_inverse(A[k][k]);
        for (int i = k + 1; i < n; ++i) {
            const V multiple = -A[i][k] * inverse[k];
            for (int j = k + 1; j < n; ++j) A[i][j] = mul_add(multiple, A[k][j], A[i][j]);
            b[i] = mul_add(multiple, b[k], b[i]);
        }
    }
    for (int k = n - 1; k >= 0; --k) {
        for (int j = k + 1; j < n; ++j) b[k] = mul_add(-A[k][j], b[j], b[k]);
        b[k] = b[k] * inverse[k];
    }
}

}  // namespace linear

// A x = b; A is used up, b becomes x. True where A is regular.
template <int n, class V>
CSPACE_INLINE mask_of<V> solve_linear(V (&A)[n][n], V (&b)[n]) {
    V pivots[n];
    linear::eliminate_lower(A, b, pivots);
    return linear::full_rank(pivots);
}

// A = L D Lᵀ for the leading n × n block of a symmetric A, of which the upper triangle is read (Golub & Van
// Loan 2013, section 4.1). D Lᵀ replaces it above the diagonal and D⁻¹ on it, with zeros for pivots that are
// not above `floor`. True where all pivots are. A: anything with rows A[i].
template <class Matrix>
CSPACE_INLINE auto factor_ldl(Matrix& A, int n, double floor = 0) {
    using V = std::remove_reference_t<decltype(A[0][0])>;
    mask_of<V> definite = fill_lanes<V>(1.0) > 0.0;
    for (int k = 0; k < n; ++k) {
        const mask_of<V> positive = A[k][k] > floor;
        definite = definite && positive;
        A[k][k] = keep_lanes(positive, linear::safe_inverse(A[k][k]));
        for (int i = k + 1; i < n; ++i) {
            const V multiple = -A[k][i] * A[k][k];
            for (int j = i; j < n; ++j) A[i][j] = mul_add(multiple, A[k][j], A[i][j]);
        }
    }
    return definite;
}
// A x = b from the factors; b becomes x. An unknown without a pivot becomes zero.
template <class Matrix, class V>
CSPACE_INLINE void solve_ldl(const Matrix& A, int n, V* b) {
    for (int k = 0; k < n; ++k) {
        const V y = b[k] * A[k][k];
        for (int i = k + 1; i < n; ++i) b[i] = mul_add(-A[k][i], y, b[i]);
    }
    for (int k = n - 1; k >= 0; --k) {
        for (int i = k + 1; i < n; ++i) b[k] = mul_add(-A[k][i], b[i], b[k]);
        b[k] = b[k] * A[k][k];
    }
}
// A x = b for a symmetric positive definite A, which is used up; b becomes x.
template <class Matrix, class V>
CSPACE_INLINE mask_of<V> solve_positive(Matrix& A, int n, V* b, double floor = 0) {
    const mask_of<V> definite = factor_ldl(A, n, floor);
    solve_ldl(A, n, b);
    return definite;
}

// L with L Lᵀ = A, row by row, for a symmetric A that is nowhere negative: its lower triangle is read.
// Columns whose pivot is not above a share of its diagonal entry are zero.
template <std::size_t n, std::size_t size>
std::array<double, size> factor_semidefinite(const std::array<double, size>& A, double share) {
    static_assert(size == n * n);
    std::array<double, size> L{};
    for (std::size_t c = 0; c < n; ++c) {
        double pivot = A[c * n + c];
        for (std::size_t k = 0; k < c; ++k) pivot -= L[c * n + k] * L[c * n + k];
        if (!(pivot > share * A[c * n + c])) continue;
        L[c * n + c] = std::sqrt(pivot);
        for (std::size_t r = c + 1; r < n; ++r) {
            double sum = A[r * n + c];
            for (std::size_t k = 0; k < c; ++k) sum -= L[r * n + k] * L[c * n + k];
            L[r * n + c] = sum / L[c * n + c];
        }
    }
    return L;
}

// The inverse of a symmetric 3 × 3 matrix times its determinant, row by row; the upper triangle is read.
struct Cofactors {
    std::array<double, 9> of;
    double determinant;
};
inline Cofactors find_cofactors(const std::array<double, 9>& M) {
    const double c00 = M[4] * M[8] - M[5] * M[5], c01 = M[2] * M[5] - M[1] * M[8];
    const double c02 = M[1] * M[5] - M[2] * M[4], c12 = M[1] * M[2] - M[0] * M[5];
    const double c11 = M[0] * M[8] - M[2] * M[2], c22 = M[0] * M[4] - M[1] * M[1];
    return {{c00, c01, c02, c01, c11, c12, c02, c12, c22}, M[0] * c00 + M[1] * c01 + M[2] * c02};
}

}  // namespace cspace::inline CSPACE_ISA
