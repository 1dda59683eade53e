// Differential kinematics along a moving pose, on lanes: the correction to the pose, the slope q' and the
// second derivative q'' of the joints along the path.
//
// With the twist t = [v; ω] of the pose, constant on each segment,
//     J q' = t,    J q'' = −J' q',
// or t' − J' q' where the twist has a rate t'.
// With redundant joints q' is the minimum-norm solution, q' = J⁺ t, and q'' has the additional term (I − J⁺J)
// J'ᵀ (J Jᵀ)⁻¹ t, the rate of J⁺ perpendicular to the rows of J (Golub and Pereyra 1973). With fewer than six
// coordinates all three are solved by least squares.
#pragma once

#include "cspace/ik/numeric/path.hpp"
#include "cspace/kinematics/jacobian_rate.hpp"
#include "cspace/math/least_squares.hpp"

namespace cspace::ik {

// The joints of a path at configurations, in base coordinates.
template <class V>
struct PlacedJoints {
    kinematics::Axis<V> axes[max_path];
    Pose<V> tip;
};

// Twists [v; ω]; lengths and prismatic joints are divided by the length of the path.
template <class V>
struct Twist {
    V entry[6];
};

// A = L Q with k orthonormal rows of Q, where A is J if J is wide, else Jᵀ.
template <class V>
struct Factors {
    V Q[6][max_joints], L[6][6], inverse[6];
    V weakest;  // the least diagonal entry of L
    int k, width;
    bool wide;
};

template <class V>
struct Motion {
    V correction[max_joints], slope[max_joints], bend[max_joints];
    V error;    // of the pose before the correction: its largest part
    V weakest;  // see Factors
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// A row of J whose remainder is smaller than this is dependent: its direction cannot be distinguished from
// rounding.
inline constexpr double lost_direction = 1e-10;

template <class V>
CSPACE_INLINE PlacedJoints<V> place_joints(const Path& path, const V* q) {
    V s[max_path + 3], c[max_path + 3];
    PlacedJoints<V> at;
    at.tip = kinematics::place_axes(view_of(path), fill_pose<V>(path.T_base_first), q, s, c, at.axes);
    return at;
}

// The motion of joint i per unit of its scaled coordinate.
CSPACE_INLINE double joint_unit(const Path& path, int i) {
    const model::ChainJoint& joint = path.joint[i];
    return joint.ratio * unit_of(path, joint.coordinate);
}

template <class V>
CSPACE_INLINE void add_twist(double unit, double per_length, const kinematics::Twist<V>& twist,
                             Twist<V>& to) {
    V entry[6];
    write_twist(twist, per_length, entry);
    for (int r = 0; r < 6; ++r) to.entry[r] = mul_add(fill_lanes<V>(unit), entry[r], to.entry[r]);
}

template <class V>
CSPACE_INLINE void clear_twist(Twist<V>& twist) {
    for (V& x : twist.entry) x = fill_lanes<V>(0.0);
}

// The columns of J, one twist per coordinate.
template <class V>
CSPACE_INLINE void columns_of(const Path& path, int n, const PlacedJoints<V>& at, Twist<V>* J) {
    const double per_length = 1 / path.length;
    for (int j = 0; j < n; ++j) clear_twist(J[j]);
    for (int i = 0; i < path.joints; ++i) {
        const model::ChainJoint& joint = path.joint[i];
        const kinematics::Axis<V>& axis = at.axes[i];
        add_twist(joint_unit(path, i), per_length,
                  kinematics::joint_twist(joint.prismatic, axis.direction, axis.point, at.tip.t),
                  J[joint.coordinate]);
    }
}

// The columns of J' for the rates `slope` of the scaled coordinates.
template <class V>
CSPACE_INLINE void column_rates(const Path& path, int n, const PlacedJoints<V>& at, const V* slope,
                                Twist<V>* J) {
    const V zero = fill_lanes<V>(0.0);
    const Vec3<V> none = {zero, zero, zero};
    const double per_length = 1 / path.length;
    kinematics::Axis<V> rates[max_path];
    V speed[max_joints];
    for (int j = 0; j < n; ++j) speed[j] = path.slides[j] ? path.length * slope[j] : slope[j];
    const Vec3<V> v_tip =
        kinematics::axis_rates(view_of(path), at.axes, at.tip.t, speed, {none, none}, at.axes[0].point, rates)
            .v;
    for (int j = 0; j < n; ++j) clear_twist(J[j]);
    for (int i = 0; i < path.joints; ++i) {
        const model::ChainJoint& joint = path.joint[i];
        add_twist(joint_unit(path, i), per_length,
                  kinematics::joint_twist_rate(joint.prismatic, at.axes[i], rates[i], at.tip.t, v_tip),
                  J[joint.coordinate]);
    }
}

// By the modified Gram–Schmidt process (Björck 1967).
template <class V>
CSPACE_INLINE void factor_columns(int n, const Twist<V>* J, Factors<V>& f) {
    f.wide = n >= 6;
    f.k = f.wide ? 6 : n;
    f.width = f.wide ? n : 6;
    f.weakest = fill_lanes<V>(1e300);
    for (int r = 0; r < f.k; ++r) {
        V a[max_joints];
        for (int j = 0; j < f.width; ++j) a[j] = f.wide ? J[j].entry[r] : J[r].entry[j];
        for (int s = 0; s < r; ++s) {
            V along = fill_lanes<V>(0.0);
            for (int j = 0; j < f.width; ++j) along = mul_add(f.Q[s][j], a[j], along);
            for (int j = 0; j < f.width; ++j) a[j] = mul_add(-along, f.Q[s][j], a[j]);
            f.L[r][s] = along;
        }
        V square = fill_lanes<V>(0.0);
        for (int j = 0; j < f.width; ++j) square = mul_add(a[j], a[j], square);
        const V left = sqrt(square);
        const mask_of<V> lost = left < lost_direction;
        f.inverse[r] = keep_lanes(!lost, 1.0 / select_lanes(lost, fill_lanes<V>(1.0), left));
        f.weakest = min(f.weakest, left);
        for (int j = 0; j < f.width; ++j) f.Q[r][j] = f.inverse[r] * a[j];
    }
}

// y with L y = e.
template <class V>
CSPACE_INLINE void forward_solve(const Factors<V>& f, const V* e, V* y) {
    for (int r = 0; r < f.k; ++r) {
        y[r] = e[r];
        for (int s = 0; s < r; ++s) y[r] = mul_add(-f.L[r][s], y[s], y[r]);
        y[r] = f.inverse[r] * y[r];
    }
}
// y with Lᵀ y = b.
template <class V>
CSPACE_INLINE void backward_solve(const Factors<V>& f, const V* b, V* y) {
    for (int r = f.k - 1; r >= 0; --r) {
        y[r] = b[r];
        for (int s = r + 1; s < f.k; ++s) y[r] = mul_add(-f.L[s][r], y[s], y[r]);
        y[r] = f.inverse[r] * y[r];
    }
}

// x with J x = e: the minimum-norm solution, or the least-squares solution. y (k,) is Q x.
template <class V>
CSPACE_INLINE void solve_for(const Factors<V>& f, const V* e, V* x, V* y) {
    if (!f.wide) {
        V b[6];
        for (int r = 0; r < f.k; ++r) {
            b[r] = fill_lanes<V>(0.0);
            for (int j = 0; j < 6; ++j) b[r] = mul_add(f.Q[r][j], e[j], b[r]);
        }
        return backward_solve(f, b, x);
    }
    forward_solve(f, e, y);
    for (int j = 0; j < f.width; ++j) {
        x[j] = fill_lanes<V>(0.0);
        for (int r = 0; r < 6; ++r) x[j] = mul_add(y[r], f.Q[r][j], x[j]);
    }
}

// Adds the term of q'' that only redundant arms have; y = Q q'.
template <class V>
CSPACE_INLINE void add_rate_of_inverse(const Factors<V>& f, const Twist<V>* J_rate, const V* y, V* bend) {
    V z[6], g[max_joints];
    backward_solve(f, y, z);
    for (int j = 0; j < f.width; ++j) {
        g[j] = fill_lanes<V>(0.0);
        for (int r = 0; r < 6; ++r) g[j] = mul_add(J_rate[j].entry[r], z[r], g[j]);
    }
    for (int r = 0; r < 6; ++r) {
        V along = fill_lanes<V>(0.0);
        for (int j = 0; j < f.width; ++j) along = mul_add(f.Q[r][j], g[j], along);
        for (int j = 0; j < f.width; ++j) g[j] = mul_add(-along, f.Q[r][j], g[j]);
    }
    for (int j = 0; j < f.width; ++j) bend[j] = bend[j] + g[j];
}

// The tip error relative to the goal, and its largest component.
template <class V>
CSPACE_INLINE Twist<V> error_of(const Pose<V>& tip, const Pose<V>& goal, double length, V& largest) {
    Twist<V> e;
    const V aligned = tip_error(tip, goal, length, e.entry);
    largest = max(largest_of(e.entry, 6), abs(3.0 - aligned));  // a half turn has no first order
    return e;
}

template <class V>
CSPACE_INLINE void measure_coordinates(const Path& path, int n, const Pose<V>& goal, const Twist<V>& twist,
                                       const Twist<V>* rate, const V* q, int locked, Motion<V>& out) {
    const PlacedJoints<V> at = place_joints(path, q);
    Twist<V> J[max_joints], turning;
    columns_of(path, n, at, J);
    if (locked >= 0) clear_twist(J[locked]);
    Factors<V> f;
    factor_columns(n, J, f);
    out.weakest = f.weakest;
    V y[6], unused[6];
    const Twist<V> e = error_of(at.tip, goal, path.length, out.error);
    solve_for(f, e.entry, out.correction, unused);
    solve_for(f, twist.entry, out.slope, y);
    column_rates(path, n, at, out.slope, J);
    if (locked >= 0) clear_twist(J[locked]);
    clear_twist(turning);
    if (rate) turning = *rate;
    for (int j = 0; j < n; ++j)
        for (int r = 0; r < 6; ++r)
            turning.entry[r] = mul_add(-out.slope[j], J[j].entry[r], turning.entry[r]);
    solve_for(f, turning.entry, out.bend, unused);
    if (n > 6) add_rate_of_inverse(f, J, y, out.bend);
}

// slope and bend are derivatives by the parameter of which twist and rate are the first two derivatives of
// the pose; without a rate, the twist is constant. locked: a coordinate that does not move, −1 for none.
template <class V>
CSPACE_NOINLINE void measure_motion(const Path& path, const Pose<V>& goal, const Twist<V>& twist,
                                    const Twist<V>* rate, const V* q, Motion<V>& out, int locked = -1) {
    // A number that the compiler knows unrolls the loops of most arms.
    if (path.n == 6) return measure_coordinates(path, 6, goal, twist, rate, q, locked, out);
    measure_coordinates(path, path.n, goal, twist, rate, q, locked, out);
}

}  // namespace cspace::ik::inline CSPACE_ISA
