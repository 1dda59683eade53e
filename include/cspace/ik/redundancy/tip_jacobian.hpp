// The tip Jacobian of a redundant arm. The configurations that reach a goal form a manifold. At each
// configuration: the pose error, and the Jacobian split into its row space, which corrects the error, and its
// null space, which moves along the manifold.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/math/lanes.hpp"

namespace cspace::ik {

// The pose error of q, and the tip Jacobian with columns [linear over the size of the arm; angular].
template <class V>
struct TipMotion {
    V error[6];
    V aligned;  // trace of the rotation that is left: 3 at the goal, −1 half a turn from it
    V column[max_joints][6];
};

// Jᵀ = Q R by Householder reflections. The first columns of Q span the row space, the others the null space.
// For a Jacobian of rank r < 6, the r pose coordinates with the largest remainders come first, in the order
// `chosen`; the others depend on them.
template <class V>
struct SplitJacobian {
    V reflector[max_joints][6];  // v_k below and on the diagonal
    V upper[6][6];               // R
    V factor[6];
    int rank = 6;
    int chosen[6] = {0, 1, 2, 3, 4, 5};
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The functions below are compiled for arms of `N` joints and rank 6, or with N = 0 for any number and rank.
// Unrolling loops of known length halves their time.
template <int N>
CSPACE_INLINE int size_or(int n) {
    return N ? N : n;
}
template <int N, class V>
CSPACE_INLINE int rank_in(const SplitJacobian<V>& split) {
    return N ? 6 : split.rank;
}

template <int N, class V>
CSPACE_INLINE void tip_motion(const Chain& chain, const Pose<V>& goal, double length, const V* q,
                              TipMotion<V>& out) {
    const int n = size_or<N>(chain.n);
    Vec3<V> axis[max_joints], point[max_joints];
    const auto keep_axis = [&](int i, const Vec3<V>& h, const Vec3<V>& p) { axis[i] = h, point[i] = p; };
    const Pose<V> T = move_joints(chain, n, q, keep_axis) * fill_pose<V>(chain.tip);
    const Vec3<V> dp = (1 / length) * (goal.t - T.t);
    const Vec3<V> w = spatial::sine_between(T.R, goal.R);
    out.aligned = spatial::trace_between(T.R, goal.R);
    const V error[6] = {dp.x, dp.y, dp.z, w.x, w.y, w.z};
    for (int k = 0; k < 6; ++k) out.error[k] = error[k];
    const V zero = fill<V>(0.0);
    for (int i = 0; i < n; ++i) {
        const bool slides = chain.prismatic[i];
        const Vec3<V> v = (1 / length) * (slides ? axis[i] : cross(axis[i], T.t - point[i]));
        const Vec3<V> h = slides ? Vec3<V>{zero, zero, zero} : axis[i];
        const V entries[6] = {v.x, v.y, v.z, h.x, h.y, h.z};
        for (int k = 0; k < 6; ++k) out.column[i][k] = entries[k];
    }
}

// Moves the coordinate with the largest remainder to place k.
inline void choose_coordinate(SplitJacobian<double>& out, int n, int k) {
    int best = k;
    double most = -1;
    for (int j = k; j < 6; ++j) {
        double square = 0;
        for (int i = k; i < n; ++i) square += out.reflector[i][j] * out.reflector[i][j];
        if (!(square > most)) continue;
        most = square;
        best = j;
    }
    for (int i = 0; i < n; ++i) {
        const double kept = out.reflector[i][k];
        out.reflector[i][k] = out.reflector[i][best];
        out.reflector[i][best] = kept;
    }
    const int kept = out.chosen[k];
    out.chosen[k] = out.chosen[best];
    out.chosen[best] = kept;
}

// rank: the number of pose coordinates that the joints move independently. A rank below six is supported on
// one lane only.
template <int N, class V>
CSPACE_INLINE void split_jacobian(const TipMotion<V>& motion, int size, int rank, SplitJacobian<V>& out) {
    const int n = size_or<N>(size);
    V(*A)[6] = out.reflector;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < 6; ++k) A[i][k] = motion.column[i][k];
    out.rank = rank;
    for (int k = 0; k < 6; ++k) out.chosen[k] = k;
    for (int k = 0; k < rank_in<N>(out); ++k) {
        if constexpr (N == 0 && Lanes<V>::count == 1)
            if (rank < 6) choose_coordinate(out, n, k);
        V square = A[k][k] * A[k][k];
        for (int i = k + 1; i < n; ++i) square = mul_add(A[i][k], A[i][k], square);
        const V diagonal = -copysign(sqrt(square), A[k][k]);
        for (int j = 0; j < k; ++j) out.upper[j][k] = A[j][k];
        out.upper[k][k] = diagonal;
        A[k][k] = A[k][k] - diagonal;
        const V scale = diagonal * A[k][k];
        out.factor[k] = -1.0 / select(scale == 0.0, fill<V>(1.0), scale);
        for (int j = k + 1; j < 6; ++j) {
            V along = A[k][k] * A[k][j];
            for (int i = k + 1; i < n; ++i) along = mul_add(A[i][k], A[i][j], along);
            along = along * out.factor[k];
            for (int i = k; i < n; ++i) A[i][j] = mul_add(-along, A[i][k], A[i][j]);
        }
    }
}

template <int N, class V>
CSPACE_INLINE void reflect_once(const SplitJacobian<V>& split, int size, int k, V* b) {
    const int n = size_or<N>(size);
    V along = split.reflector[k][k] * b[k];
    for (int i = k + 1; i < n; ++i) along = mul_add(split.reflector[i][k], b[i], along);
    along = along * split.factor[k];
    for (int i = k; i < n; ++i) b[i] = mul_add(-along, split.reflector[i][k], b[i]);
}
// b := Q b and b := Qᵀ b.
template <int N, class V>
CSPACE_INLINE void turn_out(const SplitJacobian<V>& split, int size, V* b) {
    const int n = size_or<N>(size);
    for (int k = rank_in<N>(split) - 1; k >= 0; --k) reflect_once<N>(split, n, k, b);
}
template <int N, class V>
CSPACE_INLINE void turn_in(const SplitJacobian<V>& split, int size, V* b) {
    const int n = size_or<N>(size);
    for (int k = 0; k < rank_in<N>(split); ++k) reflect_once<N>(split, n, k, b);
}

template <class V>
CSPACE_INLINE V away_from_zero(V x) {
    return select(abs(x) < 1e-14, copysign(fill<V>(1e-14), x), x);
}

// The shortest joint step that moves the tip by e: Rᵀ y = e, Q y.
template <int N, class V>
CSPACE_INLINE void shortest_step(const SplitJacobian<V>& split, int size, const V* e, V* step) {
    const int n = size_or<N>(size), rank = rank_in<N>(split);
    for (int i = rank; i < n; ++i) step[i] = fill<V>(0.0);
    for (int k = 0; k < rank; ++k) {
        step[k] = e[N ? k : split.chosen[k]];
        for (int j = 0; j < k; ++j) step[k] = mul_add(-split.upper[j][k], step[j], step[k]);
        step[k] = step[k] / away_from_zero(split.upper[k][k]);
    }
    turn_out<N>(split, n, step);
}
// Unit vector k (of n − rank) of the null space.
template <int N, class V>
CSPACE_INLINE void free_direction(const SplitJacobian<V>& split, int size, int k, V* direction) {
    const int n = size_or<N>(size);
    for (int i = 0; i < n; ++i) direction[i] = fill<V>(i == rank_in<N>(split) + k ? 1.0 : 0.0);
    turn_out<N>(split, n, direction);
}
// The λ that minimises |Jᵀ λ − g|.
template <int N, class V>
CSPACE_INLINE void multipliers(const SplitJacobian<V>& split, int size, const V* g, V* lambda) {
    const int n = size_or<N>(size), rank = rank_in<N>(split);
    V b[max_joints];
    for (int i = 0; i < n; ++i) b[i] = g[i];
    turn_in<N>(split, n, b);
    for (int k = rank; k < 6; ++k) lambda[N ? k : split.chosen[k]] = fill<V>(0.0);
    for (int k = rank - 1; k >= 0; --k) {
        for (int j = k + 1; j < rank; ++j) b[k] = mul_add(-split.upper[k][j], b[j], b[k]);
        b[k] = b[k] / away_from_zero(split.upper[k][k]);
        lambda[N ? k : split.chosen[k]] = b[k];
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
