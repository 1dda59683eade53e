// The tip Jacobian of a redundant arm. The configurations that reach a goal form a manifold. At each
// configuration: the pose error, and the Jacobian split into its row space, which corrects the error, and its
// null space, which moves along the manifold.
#pragma once

#include <utility>

#include "cspace/ik/chain.hpp"
#include "cspace/math/continuation.hpp"
#include "cspace/math/least_squares.hpp"
#include "cspace/math/linear.hpp"

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
    V A[max_joints][6], diagonal[6], factor[6];  // as of linear::factor_qr
    int rank = 6;
    int chosen[6] = {0, 1, 2, 3, 4, 5};
};

// A point of the curve of n = chain.n joints: q(s) = q + tangent s + ½ bend s² + …
template <class V>
struct CurvePoints {
    V q[max_joints], tangent[max_joints], bend[max_joints];
    V error;  // what is left of the goal [rad, m over the arm's length]
    TipMotion<V> motion;
    SplitJacobian<V> split;
};
using CurvePoint = CurvePoints<double>;

// How far Newton's method goes towards the manifold.
struct DescentRule {
    int most_steps = 60;
    double stride = 0.3;  // the longest change of a joint in a step [rad, m]
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
    out.aligned = tip_error(T, goal, length, out.error);
    for (int i = 0; i < n; ++i)
        write_twist(kinematics::joint_twist(chain.prismatic[i], axis[i], point[i], T.t), 1 / length,
                    out.column[i]);
}

// Moves the coordinate with the largest remainder to place k.
inline void choose_coordinate(SplitJacobian<double>& out, int n, int k) {
    int best = k;
    double most = -1;
    for (int j = k; j < 6; ++j) {
        double square = 0;
        for (int i = k; i < n; ++i) square += out.A[i][j] * out.A[i][j];
        if (!(square > most)) continue;
        most = square;
        best = j;
    }
    for (int i = 0; i < n; ++i) std::swap(out.A[i][k], out.A[i][best]);
    std::swap(out.chosen[k], out.chosen[best]);
}

// rank: the number of pose coordinates that the joints move independently. A rank below six is supported on
// one lane only.
template <int N, class V>
CSPACE_INLINE void split_jacobian(const TipMotion<V>& motion, int size, int rank, SplitJacobian<V>& out) {
    const int n = size_or<N>(size);
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < 6; ++k) out.A[i][k] = motion.column[i][k];
    out.rank = rank;
    for (int k = 0; k < 6; ++k) out.chosen[k] = k;
    for (int k = 0; k < rank_in<N>(out); ++k) {
        if constexpr (N == 0 && Lanes<V>::count == 1)
            if (rank < 6) choose_coordinate(out, n, k);
        linear::reduce_column(out.A, n, 6, k, out.diagonal[k], out.factor[k]);
    }
}

// b := Q b.
template <int N, class V>
CSPACE_INLINE void turn_out(const SplitJacobian<V>& split, int size, V* b) {
    const int n = size_or<N>(size);
    for (int k = rank_in<N>(split) - 1; k >= 0; --k)
        linear::reflect_vector(split.A, n, k, split.factor[k], b);
}

// A pivot of a Jacobian (lengths over the arm's length) that rounding alone leaves.
inline constexpr double least_pivot = 1e-14;

template <class V>
CSPACE_INLINE V away_from_zero(V x) {
    return select_lanes(abs(x) < least_pivot, copysign(fill_lanes<V>(least_pivot), x), x);
}

// The shortest joint step that moves the tip by e: Rᵀ y = e, Q y.
template <int N, class V>
CSPACE_INLINE void shortest_step(const SplitJacobian<V>& split, int size, const V* e, V* step) {
    const int n = size_or<N>(size), rank = rank_in<N>(split);
    for (int i = rank; i < n; ++i) step[i] = fill_lanes<V>(0.0);
    for (int k = 0; k < rank; ++k) {
        step[k] = e[N ? k : split.chosen[k]];
        for (int j = 0; j < k; ++j) step[k] = mul_add(-split.A[j][k], step[j], step[k]);
        step[k] = step[k] / away_from_zero(split.diagonal[k]);
    }
    turn_out<N>(split, n, step);
}
// Unit vector k (of n − rank) of the null space.
template <int N, class V>
CSPACE_INLINE void free_direction(const SplitJacobian<V>& split, int size, int k, V* direction) {
    const int n = size_or<N>(size);
    for (int i = 0; i < n; ++i) direction[i] = fill_lanes<V>(i == rank_in<N>(split) + k ? 1.0 : 0.0);
    turn_out<N>(split, n, direction);
}
// The λ that minimises |Jᵀ λ − g|.
template <int N, class V>
CSPACE_INLINE void find_multipliers(const SplitJacobian<V>& split, int size, const V* g, V* lambda) {
    const int n = size_or<N>(size), rank = rank_in<N>(split);
    V b[max_joints];
    for (int i = 0; i < n; ++i) b[i] = g[i];
    for (int k = 0; k < rank; ++k) linear::reflect_vector(split.A, n, k, split.factor[k], b);
    for (int k = rank; k < 6; ++k) lambda[N ? k : split.chosen[k]] = fill_lanes<V>(0.0);
    for (int k = rank - 1; k >= 0; --k) {
        for (int j = k + 1; j < rank; ++j) b[k] = mul_add(-split.A[k][j], b[j], b[k]);
        b[k] = b[k] / away_from_zero(split.diagonal[k]);
        lambda[N ? k : split.chosen[k]] = b[k];
    }
}

// The self-motion curve of an arm with one redundant joint: tangent, curvature, Newton's method back onto the
// curve, and the folds, where a joint reverses its direction.

template <int N, class V>
CSPACE_INLINE void step_onto_curve(const Chain& chain, int rank, const Pose<V>& goal, double length,
                                   CurvePoints<V>& at) {
    TipMotion<V>& motion = at.motion;
    SplitJacobian<V>& split = at.split;
    const int n = size_or<N>(chain.n);
    V step[max_joints];
    tip_motion<N>(chain, goal, length, at.q, motion);
    split_jacobian<N>(motion, n, rank, split);
    free_direction<N>(split, n, 0, at.tangent);
    // The pose's second derivative along the tangent; what bends the curve takes it back.
    const V zero = fill_lanes<V>(0.0);
    Vec3<V> linear = {zero, zero, zero}, angular = linear, turned = linear;
    for (int j = 0; j < n; ++j) {
        const V* c = motion.column[j];
        const V t = at.tangent[j];
        const Vec3<V> v = {c[0], c[1], c[2]}, h = {c[3], c[4], c[5]};
        linear = linear + t * cross(turned + turned + t * h, v);
        angular = angular + t * cross(turned, h);
        turned = turned + t * h;
    }
    const V back[6] = {-linear.x, -linear.y, -linear.z, -angular.x, -angular.y, -angular.z};
    shortest_step<N>(split, n, back, at.bend);
    shortest_step<N>(split, n, motion.error, step);
    at.error = largest_of(motion.error, 6);
    const V keep = shortening_factor(largest_of(step, n), 0.3);
    for (int i = 0; i < n; ++i) at.q[i] = mul_add(keep, step[i], at.q[i]);
}
// One Newton step from q back onto the curve, and the quantities of the curve at q before the step.
CSPACE_ONCE void onto_curve(const Chain& chain, int rank, const Posed& goal, double length, CurvePoint& at) {
    chain.n == 7 && rank == 6 ? step_onto_curve<7>(chain, rank, goal, length, at)
                              : step_onto_curve<0>(chain, rank, goal, length, at);
}

// Newton's method onto the manifold on lanes. A lane that has finished takes the next start.
template <int N, class V>
inline void descend_abreast(const Chain& chain, const Posed& goal, double length, double (*q)[max_joints],
                            int starts, bool* reached, const DescentRule& rule) {
    constexpr int lanes = Lanes<V>::count;
    const int n = size_or<N>(chain.n);
    const Pose<V> goals = fill_pose<V>(goal);
    V at[max_joints], step[max_joints];
    int start[lanes], steps[lanes] = {}, next = 0, active = 0;
    const auto take_next = [&](int l) {
        start[l] = next < starts ? next++ : -1;
        steps[l] = 0;
        active += start[l] >= 0;
        for (int i = 0; i < n; ++i) set_lane(at[i], l, q[start[l] < 0 ? 0 : start[l]][i]);
    };
    for (int i = 0; i < n; ++i) at[i] = fill_lanes<V>(0.0);
    for (int l = 0; l < lanes; ++l) take_next(l);
    while (active > 0) {
        TipMotion<V> motion;
        SplitJacobian<V> split;
        tip_motion<N>(chain, goals, length, at, motion);
        split_jacobian<N>(motion, n, 6, split);
        shortest_step<N>(split, n, motion.error, step);
        const V keep = shortening_factor(largest_of(step, n), rule.stride);
        for (int i = 0; i < n; ++i) at[i] = mul_add(keep, step[i], at[i]);
        const unsigned there = bits_of(largest_of(motion.error, 6) <= tolerance::reached);
        for (int l = 0; l < lanes; ++l) {
            if (start[l] < 0 || !(there >> l & 1 || ++steps[l] == rule.most_steps)) continue;
            reached[start[l]] = there >> l & 1;
            for (int i = 0; i < n; ++i) q[start[l]][i] = get_lane(at[i], l);
            --active;
            take_next(l);
        }
    }
}
// Moves `starts` configurations q by Newton's method onto the curve; `reached` says which of them it led
// there.
CSPACE_ONCE void descend_to_manifold(const Chain& chain, int rank, const Posed& goal, double length,
                                     double (*q)[max_joints], int starts, bool* reached,
                                     const DescentRule& rule = {}) {
    if (rank == 6) {
        (chain.n == 7 ? descend_abreast<7, Pack<8>> : descend_abreast<0, Pack<4>>)(chain, goal, length, q,
                                                                                   starts, reached, rule);
        return;
    }
    for (int k = 0; k < starts; ++k) {
        CurvePoint at;
        for (int i = 0; i < chain.n; ++i) at.q[i] = q[k][i];
        at.error = 1;
        for (int step = 0; step < rule.most_steps && at.error > tolerance::reached; ++step)
            onto_curve(chain, rank, goal, length, at);
        reached[k] = at.error <= tolerance::reached;
        for (int i = 0; i < chain.n; ++i) q[k][i] = at.q[i];
    }
}

// ‖J⁺ (J′ − J)‖ for the Jacobian J at `at` and J′ at `other`. If it is below 1 on a convex set, every
// solution in that set lies on one arc. Two solutions then differ in their component along the tangent.
template <int N = 0, class V>
inline V jacobian_change(const CurvePoints<V>& at, const CurvePoints<V>& other, int size) {
    const SplitJacobian<V>& split = at.split;
    const int n = size_or<N>(size), rank = rank_in<N>(split);
    V square = fill_lanes<V>(0.0), y[6], per[6];
    for (int k = 0; k < rank; ++k) per[k] = 1.0 / away_from_zero(split.diagonal[k]);
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < rank; ++k) {
            const int c = N ? k : split.chosen[k];
            y[k] = other.motion.column[i][c] - at.motion.column[i][c];
            for (int j = 0; j < k; ++j) y[k] = mul_add(-split.A[j][k], y[j], y[k]);
            y[k] = y[k] * per[k];
            square = mul_add(y[k], y[k], square);
        }
    return sqrt(square);
}

// Moves q along the curve to the fold of joint p, by Newton's method on component p of the tangent. Returns
// false if it leads farther than `reach` away or does not converge.
inline bool settle_fold(const Chain& chain, int rank, const Posed& goal, double length, int p, double reach,
                        CurvePoint& at) {
    constexpr double straight = 1e-9;    // second derivative that is only rounding
    constexpr double converged = 1e-10;  // [rad, arm's lengths] the next step leaves rounding alone
    double start[max_joints];
    for (int i = 0; i < chain.n; ++i) start[i] = at.q[i];
    for (int k = 0; k < 20; ++k) {
        onto_curve(chain, rank, goal, length, at);
        const double slope = at.bend[p];
        double step = std::fabs(slope) > straight ? -at.tangent[p] / slope : 1;
        const bool settled = std::fabs(step) < converged && at.error < converged;
        step = max(-0.1, min(0.1, step));
        predict_along(at.q, at.tangent, at.bend, step, chain.n, at.q);
        double away = 0;
        for (int i = 0; i < chain.n; ++i) away = max(away, std::fabs(at.q[i] - start[i]));
        if (!(away < reach)) return false;
        if (settled) return true;
    }
    return false;
}

}  // namespace cspace::ik::inline CSPACE_ISA
