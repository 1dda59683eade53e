// Solutions that share the hidden angle or nearly do: there the twelve equations lose two ranks, and the two
// solutions are distinguished inside the plane of the two weakest vectors.
#pragma once

#include "cspace/ik/general/recover.hpp"

namespace cspace::ik {

template <class V>
struct WeakPlane {
    V z[2][12];  // orthonormal
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE V dot12(const V* a, const V* b) {
    V sum = a[0] * b[0];
    for (int i = 1; i < 12; ++i) sum = mul_add(a[i], b[i], sum);
    return sum;
}
template <class V>
CSPACE_INLINE void make_unit(V* y) {
    const V scale = 1.0 / sqrt(max(dot12(y, y), fill<V>(1e-300)));
    for (int i = 0; i < 12; ++i) y[i] = scale * y[i];
}

// The singular vectors of the two smallest singular values, by subspace iteration with the inverse of R Rᵀ
// (Golub & Van Loan 2013, section 8.2); the triangle is read from a reduction of the transposed equations.
template <class V>
CSPACE_NOINLINE void weak_plane(const ReducedEquations<V>& r, WeakPlane<V>& out) {
    constexpr int steps = 2;
    V floor = fill<V>(0.0), inverse[12], y[2][12];
    for (const V& d : r.diagonal) floor = max(floor, abs(d));
    floor = 1e-15 * floor;
    for (int k = 0; k < 12; ++k) {
        inverse[k] = 1.0 / copysign(max(abs(r.diagonal[k]), floor), r.diagonal[k]);
        y[0][k] = fill<V>(k == 11 ? 1.0 : 0.0);
        y[1][k] = fill<V>(k == 10 ? 1.0 : 0.0);
    }
    for (int step = 0; step < steps; ++step) {
        for (auto& v : y) {
            for (int k = 11; k >= 0; --k) {  // R w = v
                for (int j = k + 1; j < 12; ++j) v[k] = mul_add(-r.A[k][j], v[j], v[k]);
                v[k] = v[k] * inverse[k];
            }
            make_unit(v);
            for (int k = 0; k < 12; ++k) {  // Rᵀ z = w
                for (int j = 0; j < k; ++j) v[k] = mul_add(-r.A[j][k], v[j], v[k]);
                v[k] = v[k] * inverse[k];
            }
            make_unit(v);
        }
        const V along = dot12(y[0], y[1]);
        for (int i = 0; i < 12; ++i) y[1][i] = mul_add(-along, y[0][i], y[1][i]);
        make_unit(y[1]);
    }
    for (int k = 0; k < 2; ++k) {
        turn_back(r, y[k]);
        for (int i = 0; i < 12; ++i) out.z[k][i] = y[k][i];
    }
}

// Vectors Z u of the plane with (upper nine) = t (lower nine): t is an eigenvalue of the 2 × 2 pencil that
// the plane makes of the two. Both, one twice where they coincide; true where they are real.
template <class V>
CSPACE_NOINLINE mask_of<V> split_plane(const WeakPlane<V>& plane, Monomials<V> (&out)[2]) {
    // Normal equations of  upper u = t lower u,  the better of the two halves inverted.
    V ll[2][2], lu[2][2], uu[2][2];
    for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) {
            ll[a][b] = uu[a][b] = lu[a][b] = fill<V>(0.0);
            for (int i = 0; i < 9; ++i) {
                ll[a][b] = mul_add(plane.z[a][i + 3], plane.z[b][i + 3], ll[a][b]);
                uu[a][b] = mul_add(plane.z[a][i], plane.z[b][i], uu[a][b]);
                lu[a][b] = mul_add(plane.z[a][i + 3], plane.z[b][i], lu[a][b]);
            }
        }
    const V det_l = ll[0][0] * ll[1][1] - ll[0][1] * ll[1][0];
    const V det_u = uu[0][0] * uu[1][1] - uu[0][1] * uu[1][0];
    const mask_of<V> by_lower = det_l >= det_u;
    const V det = max(det_l, det_u), g01 = select(by_lower, ll[0][1], uu[0][1]);
    const V g00 = select(by_lower, ll[0][0], uu[0][0]), g11 = select(by_lower, ll[1][1], uu[1][1]);
    const V h01 = select(by_lower, lu[0][1], lu[1][0]), h10 = select(by_lower, lu[1][0], lu[0][1]);
    const V inverse = 1.0 / max(det, fill<V>(1e-300));
    const V m00 = (g11 * lu[0][0] - g01 * h10) * inverse, m01 = (g11 * h01 - g01 * lu[1][1]) * inverse;
    const V m10 = (g00 * h10 - g01 * lu[0][0]) * inverse, m11 = (g00 * lu[1][1] - g01 * h01) * inverse;
    const V mean = 0.5 * (m00 + m11), half = 0.5 * (m00 - m11);
    const V root = sqrt(max(half * half + m01 * m10, fill<V>(0.0)));
    for (int k = 0; k < 2; ++k) {
        const V t = k == 0 ? mean + root : mean - root;
        const V a = m00 - t, d = m11 - t;
        const mask_of<V> first = a * a + m01 * m01 > d * d + m10 * m10;
        V u0 = select(first, -m01, -d), u1 = select(first, a, m10);
        const V size = sqrt(u0 * u0 + u1 * u1);
        const mask_of<V> any_vector = !(size > 1e-12);  // a multiple of the unit matrix
        u0 = select(any_vector, fill<V>(k == 0 ? 1.0 : 0.0), u0);
        u1 = select(any_vector, fill<V>(k == 0 ? 0.0 : 1.0), u1);
        for (int i = 0; i < 12; ++i) out[k].x[i] = u0 * plane.z[0][i] + u1 * plane.z[1][i];
    }
    return det > 0.0;
}

}  // namespace cspace::ik::inline CSPACE_ISA
