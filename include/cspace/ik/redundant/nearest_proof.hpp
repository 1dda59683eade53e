// A configuration that Newton's method found close to a seed, and the proof that none is nearer.
//
// Let a be on the manifold, d = |a − s| its distance from the seed s, and the way from s to a square to the
// manifold: a − s = Jᵀ λ. Every other solution b has f(b) = f(a), so with x = b − a
//   0 = λ · (f(b) − f(a)) = (a − s) · x + ½ xᵀ (λ · f″) x + λ · (third order),
//   |b − s|² = d² + 2 (a − s) · x + |x|² ≥ d² + |x|² (1 − ‖λ · f″‖ − third |x| / 3).
// A nearer b would have |x| ≤ 2 d: where the bracket is positive for that, there is none, on no branch.
#pragma once

#include "cspace/ik/redundant/nearest.hpp"

namespace cspace::inline CSPACE_ISA {

// The Frobenius norm of λ · f″ for the position and half the sum of cross products (see tip_motion) at a goal
// that is met: the entry of joints i ≤ j is force · (axis i × column j) + ½ moment · (axis i × axis j).
template <int N>
inline double curvature_of(const ik::Chain& chain, const TipMotion<double>& motion, const double* lambda) {
    const int n = size_or<N>(chain.n);
    const Vec3d force = {lambda[0], lambda[1], lambda[2]};
    const Vec3d moment = {0.5 * lambda[3], 0.5 * lambda[4], 0.5 * lambda[5]};
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const double* a = motion.column[i];
        const Vec3d h = {a[3], a[4], a[5]};
        const Vec3d lever = cross(force, h), twist = cross(moment, h);
        for (int j = i; j < n; ++j) {
            const double* c = motion.column[j];
            const double entry = lever.x * c[0] + lever.y * c[1] + lever.z * c[2] + twist.x * c[3] +
                                 twist.y * c[4] + twist.z * c[5];
            sum += (i == j ? 1 : 2) * entry * entry;
        }
    }
    return std::sqrt(sum);
}

// Whether nothing is nearer to the seed than what was found at this distance. Third derivatives are the axes'
// cross products with a column, or with the rotation's: as the joints move by x in all, no column grows by
// more than the factor e^(Σ |x|) ≤ 1 / (1 − Σ |x|), and Σ |x| ≤ √n |x|.
template <int N>
inline bool is_proven_nearest(const ik::Chain& chain, const TipMotion<double>& motion, const double* lambda,
                              double distance) {
    constexpr double margin = 0.02;  // what the last step, and rounding, may change
    const int n = size_or<N>(chain.n);
    const double root = std::sqrt(double(n)), farthest = 2 * distance, moved = root * farthest;
    if (!(moved < 0.9)) return false;
    double longest2 = 0;
    for (int i = 0; i < n; ++i) {
        const double* c = motion.column[i];
        longest2 = max(longest2, c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    }
    const double force = std::sqrt(dot_n(lambda, lambda, 3)),
                 moment = std::sqrt(dot_n(lambda + 3, lambda + 3, 3));
    const double third = n * root * (force * std::sqrt(longest2) / (1 - moved) + moment);
    return curvature_of<N>(chain, motion, lambda) + third * farthest / 3 < 1 - margin;
}

// Newton's method from a seed close to the manifold, and the proof; false where either fails. All joints must
// count alike.
template <int N>
inline bool nearest_by_proof(const ik::Chain& chain, int rank, const Posed& goal, double length,
                             const double* seed, const double* weight, double* q) {
    constexpr double close = 0.25, settled = 1e-6;
    constexpr int most_steps = 6;
    const int n = size_or<N>(chain.n);
    for (int i = 0; i < n; ++i) {
        if (weight[i] != 1) return false;
        q[i] = seed[i];
    }
    TipMotion<double> motion;
    double lambda[6], largest = 1;
    for (int k = 0; k < most_steps && largest > settled; ++k) {
        largest = step_to_nearest<N>(chain, rank, goal, length, seed, weight, q, motion, lambda);
        if (!(largest < close) || !(motion.aligned > 2)) return false;
    }
    if (!(largest <= settled)) return false;
    double distance2 = 0;
    for (int i = 0; i < n; ++i) distance2 += (q[i] - seed[i]) * (q[i] - seed[i]);
    if (!is_proven_nearest<N>(chain, motion, lambda, std::sqrt(distance2))) return false;
    return pose_difference(forward(chain, q), goal, length) < tolerance::reached;
}

}  // namespace cspace::inline CSPACE_ISA
