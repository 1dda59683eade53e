// Pose error of configurations relative to goals, and its derivative, on lanes.
//
// With T = T_goal_tip(q) = (R, t) the error is e = −[t; log R] in the axes of the goal. A twist [v; ω] of the
// tip changes log R by J_l⁻¹(log R) ω (Chirikjian 2012, section 10.8). For equal weights the factor may be
// omitted: J_lᵀ log R = log R, so the gradient of |log R|² does not change.
#pragma once

#include "cspace/ik/numeric/path.hpp"
#include "cspace/spatial/rotation.hpp"

namespace cspace::ik {

// The task of a numeric method: the weights of the pose error, its tolerances, and the limit of iterations.

enum class Method : unsigned char {
    levenberg_marquardt,  // damped, descends from any start
    newton,               // undamped: quick near a solution, erratic far from one
};

enum class Ending : unsigned char {
    reached,
    stalled,    // a local minimum of the error, or nothing gained any more
    exhausted,  // the iterations ran out
    unknown,    // not tried yet
};

// The pose error in the axes of the goal is [Δp; rotation vector]. Row k counts where weight[k] > 0.
struct Task {
    double weight[6] = {1, 1, 1, 1, 1, 1};
    double tolerance = tolerance::reached;  // of |Δp| [m] and of the angle [rad], their counted parts
    int most_steps = 60;
    Method method = Method::levenberg_marquardt;
    bool limited = false;
    double lower[max_joints] = {}, upper[max_joints] = {};  // of the coordinates, where limited
};

// The rows of the error with nonzero weight, lengths divided by that of the path, times their weights.
struct Rows {
    int m = 0;           // how many count
    int row[6];          // which of [t; rotation vector]
    double weight[6];    // of each counted row
    bool turns = false;  // some row of the rotation counts
    bool even = true;    // the rows of the rotation weigh alike
};

template <class V>
struct Gap {
    V e[6];
    V J[6][max_joints];    // −∂e/∂x of the coordinates x, slides over the length of the path
    V position, rotation;  // lengths of the counted parts [m, rad]
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline Rows rows_of(const Task& task) {
    Rows rows;
    for (int k = 0; k < 6; ++k) {
        if (!(task.weight[k] > 0)) continue;
        rows.row[rows.m] = k;
        rows.weight[rows.m++] = task.weight[k];
        rows.turns = rows.turns || k > 2;
    }
    rows.even = task.weight[3] == task.weight[4] && task.weight[4] == task.weight[5];
    return rows;
}

// Maps ω to the rate of the rotation vector w: J_l⁻¹(w) ω = ω − ½ w × ω + k w × (w × ω).
template <class V>
struct LogRate {
    Vec3<V> w;
    V k;
};
template <class V>
CSPACE_INLINE LogRate<V> log_rate(const Vec3<V>& w) {
    const V square = dot(w, w), angle = sqrt(square);
    V s, c;
    sincos(0.5 * angle, s, c);
    constexpr double series2 = 1e-4;  // square of the angle up to which two terms of the series are exact
    // 1/θ² − cot(θ/2) / 2θ; its series where the difference cancels.
    const mask_of<V> small = square < series2;
    const V safe = select_lanes(small, fill_lanes<V>(1.0), square);
    const V exact = (1.0 - 0.5 * angle * c / select_lanes(small, fill_lanes<V>(1.0), s)) / safe;
    return {w, select_lanes(small, 1.0 / 12.0 + square * (1.0 / 720.0), exact)};
}
template <class V>
CSPACE_INLINE Vec3<V> operator*(const LogRate<V>& rate, const Vec3<V>& omega) {
    const Vec3<V> across = cross(rate.w, omega);
    return omega - 0.5 * across + rate.k * cross(rate.w, across);
}

// T_goal_first: the frame of the first joint relative to the goal.
template <class V>
CSPACE_INLINE void measure_gap(const Path& path, const Rows& rows, const Pose<V>& T_goal_first, const V* q,
                               Gap<V>& out) {
    V s[max_path + 3], c[max_path + 3];
    kinematics::Axis<V> axes[max_path];
    const Pose<V> T = kinematics::place_axes(view_of(path), T_goal_first, q, s, c, axes);
    const V zero = fill_lanes<V>(0.0);
    const Vec3<V> w = rows.turns ? spatial::rotvec_of_rotation(T.R) : Vec3<V>{zero, zero, zero};
    const V error[6] = {T.t.x, T.t.y, T.t.z, w.x, w.y, w.z};
    const double per_length = 1 / path.length;
    V square[2] = {zero, zero};
    for (int r = 0; r < rows.m; ++r) {
        const int k = rows.row[r];
        square[k > 2] = mul_add(error[k], error[k], square[k > 2]);
        out.e[r] = -rows.weight[r] * (k > 2 ? 1.0 : per_length) * error[k];
        for (int j = 0; j < path.n; ++j) out.J[r][j] = zero;
    }
    out.position = sqrt(square[0]);
    out.rotation = sqrt(square[1]);
    const LogRate<V> rate = rows.even ? LogRate<V>{w, zero} : log_rate(w);
    for (int i = 0; i < path.joints; ++i) {
        const model::ChainJoint& joint = path.joint[i];
        const int j = joint.coordinate;
        const double unit = joint.ratio * unit_of(path, j);
        kinematics::Twist<V> twist =
            kinematics::joint_twist(joint.prismatic, axes[i].direction, axes[i].point, T.t);
        if (!rows.even && !joint.prismatic) twist.w = rate * twist.w;
        V column[6];
        write_twist(twist, per_length, column);
        for (int r = 0; r < rows.m; ++r)
            out.J[r][j] = mul_add(fill_lanes<V>(unit * rows.weight[r]), column[rows.row[r]], out.J[r][j]);
    }
}

}  // namespace cspace::ik::inline CSPACE_ISA
