// The damped least-squares step on lanes: (JᵀJ + λ I) dx = Jᵀ e (Levenberg 1944; Wampler 1986).
#pragma once

#include "cspace/ik/numeric/error.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// dx (n,) for m rows. loose[j] is 1, or 0 for a coordinate that must not move. Of two equivalent systems the
// smaller is solved: (JᵀJ + λ I) dx = Jᵀ e, or dx = Jᵀ y with (J Jᵀ + λ I) y = e.
template <class V>
CSPACE_INLINE void damped_step(int m, int n, const V (&J)[6][max_joints], const V (&e)[6], const V* loose,
                               V damping, V* dx) {
    V M[6][6], b[6];
    if (n <= m) {
        for (int i = 0; i < n; ++i) {
            for (int j = i; j < n; ++j) {
                V sum = fill<V>(0.0);
                for (int r = 0; r < m; ++r) sum = mul_add(J[r][i], J[r][j], sum);
                M[i][j] = loose[i] * loose[j] * sum;
            }
            M[i][i] = M[i][i] + damping + (1.0 - loose[i]);
            b[i] = fill<V>(0.0);
            for (int r = 0; r < m; ++r) b[i] = mul_add(J[r][i], e[r], b[i]);
            b[i] = loose[i] * b[i];
        }
        solve_positive(M, n, b);
        for (int i = 0; i < n; ++i) dx[i] = b[i];
        return;
    }
    for (int r = 0; r < m; ++r) {
        for (int t = r; t < m; ++t) {
            V sum = fill<V>(0.0);
            for (int j = 0; j < n; ++j) sum = mul_add(loose[j] * J[r][j], J[t][j], sum);
            M[r][t] = sum;
        }
        M[r][r] = M[r][r] + damping;
        b[r] = e[r];
    }
    solve_positive(M, m, b);
    for (int j = 0; j < n; ++j) {
        dx[j] = fill<V>(0.0);
        for (int r = 0; r < m; ++r) dx[j] = mul_add(J[r][j], b[r], dx[j]);
        dx[j] = loose[j] * dx[j];
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
