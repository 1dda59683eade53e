// Dense matrices of any size, row by row.
#pragma once

#include <cstddef>
#include <vector>

namespace check {

using Dense = std::vector<std::vector<double>>;

// The inverse by Gauss–Jordan elimination.
inline Dense invert_dense(Dense A) {
    const std::size_t n = A.size();
    Dense B(n, std::vector<double>(n, 0.0));
    for (std::size_t i = 0; i < n; ++i) B[i][i] = 1;
    for (std::size_t k = 0; k < n; ++k) {
        const double pivot = A[k][k];
        for (std::size_t j = 0; j < n; ++j) A[k][j] /= pivot, B[k][j] /= pivot;
        for (std::size_t i = 0; i < n; ++i) {
            if (i == k) continue;
            const double f = A[i][k];
            for (std::size_t j = 0; j < n; ++j) A[i][j] -= f * A[k][j], B[i][j] -= f * B[k][j];
        }
    }
    return B;
}

}  // namespace check
