// The geometric Jacobian: the twist [v; ω] of a point of the robot per unit of each joint velocity.
//
// A revolute joint about the unit direction d through the point o gives [d × (p − o); d], a prismatic one
// along d gives [d; 0] (Whitney 1969; Siciliano et al., Robotics, 2009, section 3.1).
#pragma once

#include "cspace/kinematics/forward.hpp"

namespace cspace::kinematics {
// The axis of a joint where it is at a configuration.
template <class V>
struct Axis {
    Vec3<V> point, direction;
};
// How fast something moves: the velocity of its reference point and its angular velocity.
template <class V>
struct Twist {
    Vec3<V> v, w;
};
}  // namespace cspace::kinematics

namespace cspace::kinematics::inline CSPACE_ISA {

// Follows a chain as follow_chain does; axes[i] becomes the axis of joint i. s, c: as of chain_sines.
template <class V>
CSPACE_INLINE Pose<V> place_axes(const model::Chain& chain, const Pose<V>& first, const V* q, V* s, V* c,
                                 Axis<V>* axes) {
    chain_sines(chain, q, s, c);
    return follow_chain(chain, first, q, s, c,
                        [&](int i, const Vec3<V>& o, const Vec3<V>& d) { axes[i] = {o, d}; });
}

// One of two vectors, number by number, which stay in registers.
template <class V>
CSPACE_INLINE Vec3<V> choose_vector(bool first, const Vec3<V>& a, const Vec3<V>& b) {
    V x = b.x, y = b.y, z = b.z;
    if (first) x = a.x, y = a.y, z = a.z;
    return {x, y, z};
}

// The twist of the point p per unit velocity of a joint along the direction d, or about it through o.
template <class V>
CSPACE_INLINE Twist<V> joint_twist(bool prismatic, const Vec3<V>& d, const Vec3<V>& o, const Vec3<V>& p) {
    const V zero = fill_lanes<V>(0.0);
    return {choose_vector(prismatic, d, cross(d, p - o)), choose_vector(prismatic, {zero, zero, zero}, d)};
}

// One column of a matrix of `columns` columns, rows first to first + 2.
template <class V>
CSPACE_INLINE void put_column(V* J, int columns, int j, int first, const Vec3<V>& a) {
    J[first * columns + j] = a.x;
    J[(first + 1) * columns + j] = a.y;
    J[(first + 2) * columns + j] = a.z;
}
template <class V>
CSPACE_INLINE Vec3<V> get_column(const V* J, int columns, int j, int first) {
    return {J[first * columns + j], J[(first + 1) * columns + j], J[(first + 2) * columns + j]};
}
template <class V>
CSPACE_INLINE void add_to_column(V* J, int columns, int j, int first, const Vec3<V>& a) {
    put_column(J, columns, j, first, get_column(J, columns, j, first) + a);
}

// The columns of the joints of a chain, from column `first` of J (6, columns) on, from the twist per unit
// velocity of each joint, twist_of(i). The other columns behind `first` are set to zero.
template <class V, class TwistOf>
CSPACE_INLINE void sum_columns(const model::Chain& chain, V* J, int columns, int first,
                               const TwistOf& twist_of) {
    for (int i = 0; i < chain.n && chain.ordered; ++i) {
        const Twist<V> twist = twist_of(i);
        put_column(J, columns, first + i, 0, twist.v);
        put_column(J, columns, first + i, 3, twist.w);
    }
    if (chain.ordered) return;
    for (int r = 0; r < 6; ++r) {
        for (int j = first; j < columns; ++j) J[r * columns + j] = fill_lanes<V>(0.0);
    }
    for (int i = 0; i < chain.n; ++i) {
        const model::ChainJoint& joint = chain.joints[i];
        const Twist<V> twist = twist_of(i);
        add_to_column(J, columns, first + joint.coordinate, 0, joint.ratio * twist.v);
        add_to_column(J, columns, first + joint.coordinate, 3, joint.ratio * twist.w);
    }
}

// The columns of the joints of a chain for the point p. Everything in one frame: the axes, p and the result.
template <class V>
CSPACE_INLINE void joint_columns(const model::Chain& chain, const Axis<V>* axes, const Vec3<V>& p, V* J,
                                 int columns, int first) {
    sum_columns(chain, J, columns, first, [&](int i) {
        return joint_twist(chain.joints[i].prismatic, axes[i].direction, axes[i].point, p);
    });
}

// The columns of a floating base: its twist [v; ω] refers to its origin, `arm` away from the point p. unit:
// 1, or 0 for their derivatives, where `arm` is its rate: nothing else changes.
template <class V>
CSPACE_INLINE void base_columns(const Vec3<V>& arm, V* J, int columns, int rows, double unit = 1) {
    const V zero = fill_lanes<V>(0.0), one = fill_lanes<V>(1.0);
    const Vec3<V> axis[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
    for (int j = 0; j < 3; ++j) {
        put_column(J, columns, j, 0, unit * axis[j]);
        put_column(J, columns, 3 + j, 0, cross(axis[j], arm));
        if (rows < 6) continue;
        put_column(J, columns, j, 3, {zero, zero, zero});
        put_column(J, columns, 3 + j, 3, unit * axis[j]);
    }
}

// Turns both halves of every column into the axes of a frame with orientation R.
template <class V>
CSPACE_INLINE void express_in(const Mat3<V>& R, V* J, int columns) {
    for (int j = 0; j < columns; ++j) {
        put_column(J, columns, j, 0, transpose_times(R, get_column(J, columns, j, 0)));
        put_column(J, columns, j, 3, transpose_times(R, get_column(J, columns, j, 3)));
    }
}

}  // namespace cspace::kinematics::inline CSPACE_ISA
