// The singular values of matrices, one per lane, by rotations that make their vectors orthogonal. In
// small_svd.hpp the lanes are the columns of one matrix.
//
// One-sided Jacobi (Hestenes 1958): each rotation makes two vectors orthogonal; when all are, their lengths
// are the singular values. Small ones keep their relative digits (Demmel and Veselić 1992), which a
// distance to singularity needs. Lanes that are done take the rotation by zero.
#pragma once

#include <limits>

#include "cspace/math/lanes.hpp"

namespace cspace::inline CSPACE_ISA {

// Rotates the vectors a and b of n entries, `step` apart, so that they become orthogonal; true where they
// were not.
template <class V>
CSPACE_INLINE bool make_orthogonal(V* a, V* b, int n, int step) {
    V aa = fill_lanes<V>(0.0), bb = fill_lanes<V>(0.0), ab = fill_lanes<V>(0.0);
    for (int k = 0; k < n; ++k) {
        aa = aa + a[k * step] * a[k * step];
        bb = bb + b[k * step] * b[k * step];
        ab = ab + a[k * step] * b[k * step];
    }
    const V limit = (8.0 * std::numeric_limits<double>::epsilon()) * sqrt(aa * bb);
    const auto turns = abs(ab) > limit;
    if (!any(turns)) return false;
    const V zeta = (bb - aa) / (2.0 * select_lanes(turns, ab, 1.0));
    const V tangent = copysign(fill_lanes<V>(1.0), zeta) / (abs(zeta) + sqrt(1.0 + zeta * zeta));
    const V t = select_lanes(turns, tangent, 0.0);
    const V c = 1.0 / sqrt(1.0 + t * t), s = c * t;
    for (int k = 0; k < n; ++k) {
        const V x = a[k * step], y = b[k * step];
        a[k * step] = c * x - s * y;
        b[k * step] = s * x + c * y;
    }
    return true;
}

// The min(rows, columns) singular values of J (rows, columns), largest first, into sigma. J is destroyed.
template <class V>
CSPACE_INLINE void singular_values(V* J, int rows, int columns, V* sigma) {
    const bool wide = columns >= rows;
    const int count = wide ? rows : columns, length = wide ? columns : rows;
    const int next = wide ? columns : 1, step = wide ? 1 : columns;
    constexpr int most_sweeps = 40;  // six to eight are usual
    bool moved = count > 1;
    for (int sweep = 0; moved && sweep < most_sweeps; ++sweep) {
        moved = false;
        for (int i = 0; i < count; ++i) {
            for (int j = i + 1; j < count; ++j) {
                moved = make_orthogonal(J + i * next, J + j * next, length, step) || moved;
            }
        }
    }
    for (int i = 0; i < count; ++i) {
        V square = fill_lanes<V>(0.0);
        for (int k = 0; k < length; ++k) square = square + J[i * next + k * step] * J[i * next + k * step];
        V value = sqrt(square);
        for (int j = 0; j < i; ++j) {
            const V larger = max(sigma[j], value);
            value = min(sigma[j], value);
            sigma[j] = larger;
        }
        sigma[i] = value;
    }
}

}  // namespace cspace::inline CSPACE_ISA
