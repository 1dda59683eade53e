// Eigenvalues and eigenvectors of a symmetric matrix by cyclic Jacobi rotations (Golub & Van Loan 2013,
// section 8.5).
//
// Not for kernels: it uses the standard library.
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace cspace {

// Row k of `vectors` (n × n) is the unit eigenvector of values[k]; in no order.
struct SymmetricEigen {
    std::vector<double> values, vectors;
};

// A: n × n, both triangles.
inline SymmetricEigen decompose_symmetric(std::vector<double> A, std::size_t n) {
    constexpr int most_sweeps = 30;       // six are enough, for they converge quadratically
    constexpr double negligible = 1e-32;  // of the sum of squares: what rounding leaves off the diagonal
    std::vector<double> V(n * n, 0.0);
    for (std::size_t k = 0; k < n; ++k) V[k * n + k] = 1;
    const auto turn = [n](double* x, double* y, std::size_t stride, double c, double s) {
        for (std::size_t k = 0; k < n; ++k, x += stride, y += stride) {
            const double a = *x, b = *y;
            *x = c * a - s * b;
            *y = s * a + c * b;
        }
    };
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
        double off = 0, all = 0;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) (i == j ? all : off) += A[i * n + j] * A[i * n + j];
        if (!(off > negligible * (all + off))) break;
        for (std::size_t p = 0; p + 1 < n; ++p)
            for (std::size_t q = p + 1; q < n; ++q) {
                if (A[p * n + q] == 0) continue;
                const double tau = (A[q * n + q] - A[p * n + p]) / (2 * A[p * n + q]);
                const double t = std::copysign(1.0, tau) / (std::fabs(tau) + std::hypot(1.0, tau));
                const double c = 1 / std::hypot(1.0, t), s = t * c;
                turn(&A[p * n], &A[q * n], 1, c, s);
                turn(&A[p], &A[q], n, c, s);
                turn(&V[p * n], &V[q * n], 1, c, s);
            }
    }
    SymmetricEigen found = {std::vector<double>(n), std::move(V)};
    for (std::size_t k = 0; k < n; ++k) found.values[k] = A[k * n + k];
    return found;
}

}  // namespace cspace
