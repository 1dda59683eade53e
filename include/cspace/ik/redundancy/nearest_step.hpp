// One step of Newton's method to the nearest configuration of the self-motion manifold.
#pragma once

#include <limits>

#include "cspace/ik/redundancy/target.hpp"
#include "cspace/ik/redundancy/tip_jacobian.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::ik {

// The best configuration so far.
struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    double q[max_joints];
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The configuration of the self-motion manifold that is nearest to a seed: sequential quadratic programming
// with exact second derivatives (Nocedal & Wright 2006, chapter 18). It converges quadratically from a start
// in the basin of the minimum.

// The weighted gaps from the seed.
template <int N = 0, class V>
CSPACE_INLINE void from_seed(const Chain& chain, const Target& target, const double* weight, const V* q,
                             V* gap) {
    const int n = size_or<N>(chain.n);
    for (int i = 0; i < n; ++i) gap[i] = weight[i] * gap_from_seed(chain, target, i, q[i]);
}

// H d for the Hessian of the Lagrangian ½ Σ w (q − seed)² − λ · pose(q). The pose's second derivative by q_i
// and q_j, i ≤ j, is [axis i × column j; ½ axis i × axis j].
template <int N, class V>
CSPACE_INLINE void lagrangian_times(const Chain& chain, const TipMotion<V>& motion, const double* weight,
                                    const V* lambda, const V* d, V* out) {
    const int n = size_or<N>(chain.n);
    const Vec3<V> force = {lambda[0], lambda[1], lambda[2]};
    const Vec3<V> moment = {0.5 * lambda[3], 0.5 * lambda[4], 0.5 * lambda[5]};
    // force · (h_i × v_j) = v_j · (force × h_i), so that one running sum serves the rows above and one those
    // below.
    const V zero = fill_lanes<V>(0.0);
    Vec3<V> lever[max_joints], twist[max_joints], turned = {zero, zero, zero}, twisted = turned;
    for (int j = 0; j < n; ++j) {
        const V* c = motion.column[j];
        const Vec3<V> v = {c[0], c[1], c[2]}, h = {c[3], c[4], c[5]};
        lever[j] = cross(force, h);
        twist[j] = cross(moment, h);
        out[j] = weight[j] * d[j] - dot(v, turned) - dot(h, twisted);
        turned = turned + d[j] * lever[j];
        twisted = twisted + d[j] * twist[j];
    }
    Vec3<V> linear = {zero, zero, zero}, angular = linear;
    for (int i = n - 1; i >= 0; --i) {
        const V* c = motion.column[i];
        const Vec3<V> v = {c[0], c[1], c[2]}, h = {c[3], c[4], c[5]};
        linear = linear + d[i] * v;
        out[i] = out[i] - dot(linear, lever[i]) - dot(angular, twist[i]);
        angular = angular + d[i] * h;
    }
}

inline constexpr int max_free = max_joints - 1;

// Joints that stay where they are move no tip. They have the seed at their own values.
template <class V>
CSPACE_INLINE void freeze_joints(TipMotion<V>& motion, int n, unsigned frozen) {
    for (int i = 0; frozen && i < n; ++i)
        for (int k = 0; k < 6 && frozen >> i & 1; ++k) motion.column[i][k] = fill_lanes<V>(0.0);
}

// One step of q to the nearest point. Returns the largest joint change of the full step. motion, lambda: the
// split Jacobian before the step, and its multipliers. frozen: joints that stay, one bit each.
template <int N, class V>
CSPACE_NOINLINE V step_to_nearest(const Chain& chain, int rank, const Pose<V>& goal, double length,
                                  const Target& target, const double* weight, V* q, TipMotion<V>& motion,
                                  V (&lambda)[6], unsigned frozen = 0) {
    constexpr double stride = 0.4;
    constexpr int room = N ? N : max_joints, most_free = N ? N - 6 : max_free;
    const int n = size_or<N>(chain.n), free = N ? N - 6 : n - rank;
    SplitJacobian<V> split;
    tip_motion<N>(chain, goal, length, q, motion);
    freeze_joints(motion, n, frozen);
    split_jacobian<N>(motion, n, rank, split);
    V gap[room], step[room], bent[room], along[most_free][room];
    V newton[max_free], plain[max_free], H[max_free][max_free], G[max_free][max_free];
    from_seed<N>(chain, target, weight, q, gap);
    find_multipliers<N>(split, n, gap, lambda);
    shortest_step<N>(split, n, motion.error, step);
    for (int k = 0; k < free; ++k) {
        free_direction<N>(split, n, k, along[k]);
        lagrangian_times<N>(chain, motion, weight, lambda, along[k], bent);
        newton[k] = plain[k] = fill_lanes<V>(0.0);
        for (int i = 0; i < n; ++i) {
            newton[k] = newton[k] - along[k][i] * gap[i] - bent[i] * step[i];
            plain[k] = plain[k] - along[k][i] * (gap[i] + weight[i] * step[i]);
        }
        for (int m = 0; m <= k; ++m) {
            H[m][k] = G[m][k] = fill_lanes<V>(0.0);
            for (int i = 0; i < n; ++i) {
                H[m][k] = mul_add(along[m][i], bent[i], H[m][k]);
                G[m][k] = mul_add(weight[i] * along[m][i], along[k][i], G[m][k]);
            }
        }
        G[k][k] = G[k][k] + 0.06;  // joints that do not count leave directions undecided
    }
    const mask_of<V> curved = solve_positive(H, free, newton, 0.05);
    if (!all(curved)) {
        solve_positive(G, free, plain);
        for (int k = 0; k < free; ++k) newton[k] = select_lanes(curved, newton[k], plain[k]);
    }
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < free; ++k) step[i] = mul_add(newton[k], along[k][i], step[i]);
    const V largest = largest_of(step, n), keep = shortening_factor(largest, stride);
    for (int i = 0; i < n; ++i) q[i] = mul_add(keep, step[i], q[i]);
    return largest;
}

inline double distance_from_seed(const Redundant& arm, const Target& target, const double* q) {
    double gap[max_joints], sum = 0;
    from_seed(arm.chain, target, arm.weight, q, gap);
    for (int i = 0; i < arm.chain.n; ++i) sum += gap[i] * gap[i];
    return std::sqrt(sum);
}

inline constexpr double settled_step = 1e-6;  // squared it is the error that Newton's method leaves
inline constexpr int most_nearest_steps = 25;

inline void keep_nearer(const Redundant& arm, const double* q, double distance, Nearest& best) {
    if (!(distance < best.distance)) return;
    best.distance = distance;
    for (int i = 0; i < arm.chain.n; ++i) best.q[i] = q[i];
}

}  // namespace cspace::ik::inline CSPACE_ISA
