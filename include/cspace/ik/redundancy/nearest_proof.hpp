// The nearest configuration to a seed, by Newton's method, with a proof that no other solution is nearer.
//
// The goal is met where the frames of the two halves of the arm agree: f(q) = 0, where f contains the
// difference of their origins and half the sum of the cross products of their axes. Let a be such a q, d = |a
// − s| its distance from the seed s. The vector a − s is normal to the manifold: a − s = Jᵀ λ. The last three
// components of f are replaced by the nine differences of the entries of the frames, weighted with λ. The
// weighted sum φ is zero at every solution b, has the gradient Jᵀ λ at a, and has no mixed derivatives
// between the halves. So with x = b − a
//   0 = φ(b) − φ(a) = (a − s) · x + ½ xᵀ φ″ x + third order,
//   |b − s|² = d² + 2 (a − s) · x + |x|² ≥ d² + xᵀ (1 − φ″) x − third |x|³ / 3.
// A nearer b would satisfy |x| ≤ 2 d. Where 1 − φ″ − ⅔ d · third is positive definite, no such b exists on
// any branch.
#pragma once

#include "cspace/ik/redundancy/split_chain.hpp"
#include "cspace/math/least_squares.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::ik {

// The kinematics of the two halves of an arm at a configuration, one half per lane; joints as in SplitChain.
struct SplitChainMotion {
    using V = Pack<2>;
    Vec3<V> axis[SplitChain::longest], linear[SplitChain::longest];  // of each joint, at the middle
    double error[6];                                                 // what is missing between the frames
    double aligned;  // trace of the rotation between them: 3 at the goal
};

// 1 − φ″ or its factors as of factor_ldl, one block per half; the upper triangle counts.
using SplitChainMatrix = Pack<2>[SplitChain::longest][SplitChain::longest];

// An iterate of Newton's method; joints as in SplitChain.
struct SplitChainPoint {
    using V = Pack<2>;
    V q[SplitChain::longest], gap[SplitChain::longest];  // gap: from the seed
    double lambda[6] = {};
    SplitChainMatrix bent;  // 1 − φ″ before the last step
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

template <int n, class V>
CSPACE_INLINE Vec3<V> load_vector(const double (&values)[n][2]) {
    return {load_lanes<V>(values[0]), load_lanes<V>(values[1]), load_lanes<V>(values[2])};
}
template <class V>
CSPACE_INLINE Mat3<V> load_matrix(const double (&values)[9][2]) {
    Mat3<V> out;
    for (int j = 0; j < 9; ++j) out.m[j / 3][j % 3] = load_lanes<V>(values[j]);
    return out;
}

template <class V>
CSPACE_INLINE Vec3d vector_of_half(const Vec3<V>& a, int half) {
    return {get_lane(a.x, half), get_lane(a.y, half), get_lane(a.z, half)};
}

// 1 for the half that moves with its joints, −1 for the half that moves against them.
template <class V>
CSPACE_INLINE V there_and_back() {
    V out = fill_lanes<V>(1.0);
    set_lane(out, 1, -1.0);
    return out;
}

// Sines and cosines of all joints, in two packs of four angles.
template <class V>
CSPACE_INLINE void turns_of(const SplitChain& arm, const V* q, V* s, V* c) {
    double angle[8], sine[8], cosine[8];
    for (int k = 0; k < 4; ++k) store_lanes(angle + 2 * k, load_lanes<V>(arm.turning[k]) * q[k]);
    for (int k = 0; k < 8; k += 4) {
        Pack<4> four[2];
        sincos(load_lanes<Pack<4>>(angle + k), four[0], four[1]);
        store_lanes(sine + k, four[0]);
        store_lanes(cosine + k, four[1]);
    }
    for (int k = 0; k < 4; ++k) {
        s[k] = there_and_back<V>() * load_lanes<V>(sine + 2 * k);
        c[k] = load_lanes<V>(cosine + 2 * k);
    }
}

CSPACE_INLINE void move_split_chain(const SplitChain& arm, const Posed& goal, double per_length,
                                    const Pack<2>* q, SplitChainMotion& out) {
    using V = Pack<2>;
    V s[4], c[4];
    turns_of(arm, q, s, c);
    Pose<V> T = fill_pose<V>(identity_pose());
    set_pose_lane(T, 1, {goal.R, per_length * goal.t});
    Vec3<V> point[4];
    for (int k = 0; k < 4; ++k) {
        T.t = T * load_vector<3, V>(arm.at[k]);
        T.R = T.R * load_matrix<V>(arm.frame[k]);
        const Vec3<V> x = matrix_column(T.R, 0), y = matrix_column(T.R, 1), z = matrix_column(T.R, 2);
        out.axis[k] = z;
        if (arm.slides) T.t = T.t + (there_and_back<V>() * load_lanes<V>(arm.sliding[k]) * q[k]) * z;
        point[k] = T.t;
        T.R = from_columns(c[k] * x + s[k] * y, c[k] * y - s[k] * x, z);
    }
    const Vec3<V> middle = T * load_vector<3, V>(arm.middle);
    const Mat3<V> meeting = T.R * load_matrix<V>(arm.meeting);
    for (int k = 0; k < 4; ++k) {
        const V turning = load_lanes<V>(arm.turning[k]);
        out.linear[k] = turning * cross(out.axis[k], middle - point[k]);
        if (arm.slides) out.linear[k] = out.linear[k] + load_lanes<V>(arm.sliding[k]) * out.axis[k];
        out.axis[k] = turning * out.axis[k];
    }
    const Vec3d gap = vector_of_half(middle, 1) - vector_of_half(middle, 0);
    Mat3d half[2];
    for (int k = 0; k < 2; ++k)
        half[k] = from_columns(vector_of_half(matrix_column(meeting, 0), k),
                               vector_of_half(matrix_column(meeting, 1), k),
                               vector_of_half(matrix_column(meeting, 2), k));
    const Vec3d turn = spatial::sine_between(half[0], half[1]);
    out.aligned = spatial::trace_between(half[0], half[1]);
    const double error[6] = {gap.x, gap.y, gap.z, turn.x, turn.y, turn.z};
    for (int j = 0; j < 6; ++j) out.error[j] = error[j];
}

// 1 − φ″ for the weights lambda. The entry of joints a ≤ b of a half, with a the one farther from the middle,
// is force · (axis a × linear b) + ½ moment · (axis a × axis b). For the half that moves against its joints a
// and b are exchanged.
CSPACE_INLINE void bend_split_chain(const SplitChainMotion& motion, const double* lambda,
                                    SplitChainMatrix& bent) {
    using V = Pack<2>;
    const V way = there_and_back<V>();
    const Vec3<V> force = {lambda[0] * way, lambda[1] * way, lambda[2] * way};
    const V half = 0.5 * way;
    const Vec3<V> moment = {lambda[3] * half, lambda[4] * half, lambda[5] * half};
    for (int a = 0; a < 4; ++a) {
        const Vec3<V> lever = cross(force, motion.axis[a]), twist = cross(moment, motion.axis[a]);
        bent[a][a] = 1.0 - dot(lever, motion.linear[a]);
        for (int b = a + 1; b < 4; ++b)
            bent[a][b] = -dot(lever, motion.linear[b]) - dot(twist, motion.axis[b]);
    }
}

// The factors of `bent` minus `less` on the diagonal; false unless it is positive definite by `margin`.
CSPACE_INLINE bool factor_split_chain(const SplitChainMatrix& bent, double less, double margin,
                                      SplitChainMatrix& out) {
    for (int a = 0; a < 4; ++a)
        for (int b = a; b < 4; ++b) out[a][b] = a == b ? bent[a][a] - less : bent[a][b];
    return all(factor_ldl(out, 4, margin));
}

// One Newton step for the nearest point and its weights. Returns the largest joint change of the full step,
// and NaN where no such step exists.
CSPACE_INLINE double step_split_chain(const SplitChainMotion& motion, SplitChainPoint& at) {
    using V = Pack<2>;
    constexpr double flat = 0.05;
    SplitChainMatrix factor;
    bend_split_chain(motion, at.lambda, at.bent);
    if (!factor_split_chain(at.bent, 0, flat, factor)) {
        for (int a = 0; a < 4; ++a)
            for (int b = a; b < 4; ++b) at.bent[a][b] = fill_lanes<V>(a == b);
        factor_split_chain(at.bent, 0, flat, factor);
    }
    // With y = L⁻¹ [Jᵀ, gap]: J (1 − φ″)⁻¹ Jᵀ λ = error + J (1 − φ″)⁻¹ gap.
    V y[4][7], scaled[4][7], sum[6][7];
    for (int b = 0; b < 4; ++b) {
        const Vec3<V>&v = motion.linear[b], &h = motion.axis[b];
        const V row[7] = {v.x, v.y, v.z, h.x, h.y, h.z, at.gap[b]};
        for (int k = 0; k < 7; ++k) {
            y[b][k] = row[k];
            for (int a = 0; a < b; ++a) y[b][k] = y[b][k] - factor[a][b] * scaled[a][k];
            scaled[b][k] = factor[b][b] * y[b][k];
        }
        for (int k = 0; k < 6; ++k)
            for (int j = k; j < 7; ++j)
                sum[k][j] = b ? mul_add(scaled[b][k], y[b][j], sum[k][j]) : scaled[b][k] * y[b][j];
    }
    double S[6][6];
    for (int k = 0; k < 6; ++k) {
        for (int j = k; j < 6; ++j) S[k][j] = get_lane(sum[k][j], 0) + get_lane(sum[k][j], 1);
        at.lambda[k] = motion.error[k] + get_lane(sum[k][6], 0) + get_lane(sum[k][6], 1);
    }
    if (!solve_positive(S, 6, at.lambda)) return std::numeric_limits<double>::quiet_NaN();
    V step[4], largest = fill_lanes<V>(0.0);
    for (int b = 3; b >= 0; --b) {
        V along = -y[b][6];
        for (int k = 0; k < 6; ++k) along = mul_add(y[b][k], fill_lanes<V>(at.lambda[k]), along);
        for (int m = b + 1; m < 4; ++m) along = along - factor[b][m] * step[m];
        step[b] = along * factor[b][b];
        largest = max(largest, abs(step[b]));
        at.q[b] = at.q[b] + step[b];
        at.gap[b] = at.gap[b] + step[b];
    }
    return max(get_lane(largest, 0), get_lane(largest, 1));
}

// Whether no solution is nearer to the seed than this point. Third derivatives: see split_chain_at. The bound
// allows for a prismatic joint as far out as at the seed and beyond.
CSPACE_INLINE bool is_proven_nearest(const SplitChain& arm, const SplitChainPoint& at) {
    using V = Pack<2>;
    constexpr double margin = 0.02;  // what the last step, and rounding, may change
    V square = fill_lanes<V>(0.0);
    for (int k = 0; k < 4; ++k) square = mul_add(at.gap[k], at.gap[k], square);
    const double distance = std::sqrt(get_lane(square, 0) + get_lane(square, 1));
    const double* l = at.lambda;
    const double force = norm(Vec3d{l[0], l[1], l[2]}), moment = norm(Vec3d{l[3], l[4], l[5]});
    V reach = load_lanes<V>(arm.reach);
    for (int k = 0; k < 4 && arm.slides; ++k)
        reach = reach + load_lanes<V>(arm.slid[k]) * (abs(at.q[k]) + 2 * distance);
    const V third = force * reach + moment * load_lanes<V>(arm.turn);
    const double most = max(get_lane(third, 0), get_lane(third, 1));
    SplitChainMatrix factor;
    return factor_split_chain(at.bent, most * distance * (2.0 / 3.0) + margin, 0, factor);
}

CSPACE_INLINE void put_joints(const SplitChain& arm, const SplitChainPoint& at, double* q) {
    for (int k = 0; k < 4; ++k)
        for (int half = 0; half < 2; ++half)
            if (arm.joint[k][half] >= 0) q[arm.joint[k][half]] = get_lane(at.q[k], half);
}

// Newton's method from a seed close to the manifold, and the proof; false if either fails. All joints must
// have the same weight.
CSPACE_INLINE bool nearest_by_proof(const SplitChain& arm, const Posed& goal, double length,
                                    const double* seed, double* q) {
    using V = Pack<2>;
    constexpr double close = 0.25, settled = 1e-6, left = 1e-10, there = 1e-14;
    constexpr int most_steps = 7;
    SplitChainPoint at;
    for (int k = 0; k < 4; ++k) {
        at.gap[k] = at.q[k] = fill_lanes<V>(0.0);
        for (int half = 0; half < 2; ++half)
            if (arm.joint[k][half] >= 0) set_lane(at.q[k], half, seed[arm.joint[k][half]]);
    }
    SplitChainMotion motion;
    bool done = false;
    double before = 1;
    for (int k = 0; k < most_steps && !done; ++k) {
        move_split_chain(arm, goal, 1 / length, at.q, motion);
        if (!(motion.aligned > 2)) return false;
        if (k == 0 && largest_of(motion.error, 6) < there) {
            put_joints(arm, at, q);  // the seed itself
            return true;
        }
        const double largest = step_split_chain(motion, at);
        if (!(largest < close)) return false;
        done = largest <= settled && largest * largest <= left * before;  // each step is less of the last one
        before = largest;
    }
    if (!done || !is_proven_nearest(arm, at)) return false;
    move_split_chain(arm, goal, 1 / length, at.q, motion);
    put_joints(arm, at, q);
    return largest_of(motion.error, 6) < tolerance::reached && motion.aligned > 2;
}

}  // namespace cspace::ik::inline CSPACE_ISA
