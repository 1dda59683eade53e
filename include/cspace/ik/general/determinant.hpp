// The determinant that vanishes where the hidden angle a0 belongs to a solution, and its null vector there.
//
// The six equations of the elimination, each times S1 and times C1, are twelve linear ones in the twelve
// products of (S1³, S1²C1, S1C1², C1³) and (S2², S2C2, C2²) (Raghavan & Roth 1993):
//   [E2 E1 E0  0 ]
//   [ 0 E2 E1 E0],  E2, E1, E0 the 6 × 3 blocks of S1², S1C1, C1².
// Reflections first take E0 out of the last block column, then what is left of it; no pivoting, no branches.
#pragma once

#include "cspace/ik/general/elimination.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::ik::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE V equation(const Elimination& e, int i, int monomial, V c, V s) {
    return mul_add(s, fill<V>(e.quarter[monomial][i]),
                   mul_add(c, fill<V>(e.across[monomial][i]), fill<V>(e.level[monomial][i])));
}

template <int reduced, class V>
CSPACE_INLINE V product_of(const V (&diagonal)[reduced]) {
    V out = diagonal[0];
    for (int k = 1; k < reduced; ++k) out = out * diagonal[k];
    return out;
}

// The determinant at the hidden angle with cosine c and sine s, up to a constant factor.
template <class V>
CSPACE_NOINLINE V determinant(const Elimination& e, V c, V s) {
    V A[6][9];  // [E0 E1 E2]
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 3; ++j)
            for (int block = 0; block < 3; ++block)
                A[i][3 * block + j] = equation(e, i, 3 * (2 - block) + j, c, s);
    V d3[3], d6[6], factor3[3], factor6[6];
    linear::factor_qr(A, d3, factor3);  // [R0 b1 b2; 0 a1 a2]
    const V zero = fill<V>(0.0);
    V out = product_of(d3);
    V B[6][9];  // [R0 b2 b1; a1 0 a2]
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            B[i][j] = j > i ? A[i][j] : j == i ? d3[i] : zero;
            B[i][3 + j] = A[i][6 + j];
            B[i][6 + j] = A[i][3 + j];
            B[3 + i][j] = A[3 + i][3 + j];
            B[3 + i][3 + j] = zero;
            B[3 + i][6 + j] = A[3 + i][6 + j];
        }
    linear::factor_qr(B, d3, factor3);
    out = out * product_of(d3);
    V D[6][6];  // [a2 a1; d2 d1]
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            D[i][j] = A[3 + i][6 + j];
            D[i][3 + j] = A[3 + i][3 + j];
            D[3 + i][j] = B[3 + i][3 + j];
            D[3 + i][3 + j] = B[3 + i][6 + j];
        }
    linear::factor_qr(D, d6, factor6);
    return out * product_of(d6);
}

}  // namespace cspace::ik::inline CSPACE_ISA
