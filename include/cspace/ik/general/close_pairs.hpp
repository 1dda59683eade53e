// Solutions that share the hidden angle or nearly do: there the twelve equations lose two ranks, and the two
// solutions are told apart inside the plane of the two weakest vectors.
#pragma once

#include "cspace/ik/general/recover.hpp"

namespace cspace {

struct WeakPlane {
    double z[2][12];  // orthonormal
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

inline double dot12(const double* a, const double* b) {
    double sum = 0;
    for (int i = 0; i < 12; ++i) sum += a[i] * b[i];
    return sum;
}
inline void make_unit(double* y) {
    const double scale = 1 / std::sqrt(max(dot12(y, y), 1e-300));
    for (int i = 0; i < 12; ++i) y[i] *= scale;
}

// The singular vectors of the two smallest singular values, by subspace iteration with the inverse of R Rᵀ
// (Golub & Van Loan 2013, section 8.2); the triangle is read from a reduction of the transposed equations.
inline WeakPlane weak_plane(const ReducedEquations<double>& r) {
    double floor = 0;
    for (const double d : r.diagonal) floor = max(floor, std::fabs(d));
    floor *= 1e-15;
    const auto pivot = [&](int k) {
        return std::fabs(r.diagonal[k]) > floor ? r.diagonal[k] : std::copysign(floor, r.diagonal[k]);
    };
    double y[2][12] = {};
    y[0][11] = y[1][10] = 1;
    for (int step = 0; step < 4; ++step) {
        for (auto& v : y) {
            for (int k = 11; k >= 0; --k) {  // R w = v
                for (int j = k + 1; j < 12; ++j) v[k] -= r.A[k][j] * v[j];
                v[k] /= pivot(k);
            }
            make_unit(v);
            for (int k = 0; k < 12; ++k) {  // Rᵀ z = w
                for (int j = 0; j < k; ++j) v[k] -= r.A[j][k] * v[j];
                v[k] /= pivot(k);
            }
            make_unit(v);
        }
        const double along = dot12(y[0], y[1]);
        for (int i = 0; i < 12; ++i) y[1][i] -= along * y[0][i];
        make_unit(y[1]);
    }
    WeakPlane out;
    for (int k = 0; k < 2; ++k) {
        double turned[12];
        for (int i = 0; i < 12; ++i) turned[i] = y[k][i];
        turn_back(r, turned);
        for (int i = 0; i < 12; ++i) out.z[k][i] = turned[i];
    }
    return out;
}

// Vectors Z u of the plane with (upper nine) = t (lower nine): t is an eigenvalue of the 2 × 2 pencil that
// the plane makes of the two. Returns how many real ones there are.
inline int split_plane(const WeakPlane& plane, Monomials<double> (&out)[2]) {
    // Normal equations of  upper u = t lower u,  the better of the two halves inverted.
    double ll[2][2] = {}, lu[2][2] = {}, uu[2][2] = {};
    for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b)
            for (int i = 0; i < 9; ++i) {
                const double lower_a = plane.z[a][i + 3], lower_b = plane.z[b][i + 3];
                const double upper_a = plane.z[a][i], upper_b = plane.z[b][i];
                ll[a][b] += lower_a * lower_b;
                uu[a][b] += upper_a * upper_b;
                lu[a][b] += lower_a * upper_b;
            }
    const double det_l = ll[0][0] * ll[1][1] - ll[0][1] * ll[1][0];
    const double det_u = uu[0][0] * uu[1][1] - uu[0][1] * uu[1][0];
    const bool by_lower = det_l >= det_u;
    const double (&g)[2][2] = by_lower ? ll : uu;
    const double det = by_lower ? det_l : det_u;
    if (!(det > 0)) return 0;
    double h[2][2];
    for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) h[a][b] = by_lower ? lu[a][b] : lu[b][a];
    const double m[2][2] = {
        {(g[1][1] * h[0][0] - g[0][1] * h[1][0]) / det, (g[1][1] * h[0][1] - g[0][1] * h[1][1]) / det},
        {(g[0][0] * h[1][0] - g[1][0] * h[0][0]) / det, (g[0][0] * h[1][1] - g[1][0] * h[0][1]) / det}};
    const double mean = 0.5 * (m[0][0] + m[1][1]);
    const double inside = mean * mean - (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
    const double root = inside > 0 ? std::sqrt(inside) : 0;
    int count = 0;
    for (const double t : {mean + root, mean - root}) {
        const double a = m[0][0] - t, d = m[1][1] - t;
        const bool first = a * a + m[0][1] * m[0][1] > d * d + m[1][0] * m[1][0];
        const double u0 = first ? -m[0][1] : -d, u1 = first ? a : m[1][0];
        const double size = std::sqrt(u0 * u0 + u1 * u1);
        if (!(size > 1e-12)) continue;
        for (int i = 0; i < 12; ++i) out[count].x[i] = (u0 * plane.z[0][i] + u1 * plane.z[1][i]) / size;
        ++count;
        if (root == 0) break;
    }
    return count;
}

}  // namespace cspace::inline CSPACE_ISA
