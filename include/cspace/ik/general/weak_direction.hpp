// The direction in which an arm of six joints can hardly move its tip, by inverse iteration on the Jacobian.
#pragma once

#include "cspace/ik/refine.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::ik {

// The smallest singular value with its vectors: J v = σ u.
struct WeakDirection {
    double sigma, v[6], u[6];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline double make_unit6(double* v) {
    const double size = std::sqrt(dot_n(v, v, 6));
    for (int i = 0; i < 6; ++i) v[i] /= size > 0 ? size : 1;
    return size;
}

// Of six columns, as `measure` leaves them.
inline WeakDirection weak_direction(const double (*columns)[6]) {
    double A[6][6], diagonal[6], factor[6];
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) A[i][j] = columns[j][i];
    linear::factor_qr(A, diagonal, factor);
    double floor = 0;
    for (const double d : diagonal) floor = max(floor, 1e-15 * std::fabs(d));
    for (double& d : diagonal)
        if (std::fabs(d) < floor) d = std::copysign(floor, d);
    WeakDirection out{1, {0.41, -0.37, 0.43, 0.31, -0.47, 0.45}, {}};
    double growth = 1;
    for (int step = 0; step < 4; ++step) {
        double* v = out.v;
        make_unit6(v);
        for (int k = 0; k < 6; ++k) {  // Rᵀ y = v
            for (int j = 0; j < k; ++j) v[k] -= A[j][k] * v[j];
            v[k] /= diagonal[k];
        }
        for (int k = 5; k >= 0; --k) {  // R z = y
            for (int j = k + 1; j < 6; ++j) v[k] -= A[k][j] * v[j];
            v[k] /= diagonal[k];
        }
        growth = make_unit6(v);
    }
    out.sigma = 1 / std::sqrt(growth);
    for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 6; ++i) out.u[i] += columns[j][i] * out.v[j];
    make_unit6(out.u);
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
