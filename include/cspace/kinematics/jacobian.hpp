// The geometric Jacobian: the twist [v; ω] of a point of the robot per unit of each joint velocity.
//
// A revolute joint about the unit direction d through the point o gives [d × (p − o); d], a prismatic one
// along d gives [d; 0] (Whitney 1969; Siciliano et al., Robotics, 2009, section 3.1).
#pragma once

#include "cspace/math/vec.hpp"
#include "cspace/model/chain.hpp"

namespace cspace::kinematics {
// The axis of a joint where it is at a configuration.
template <class V>
struct Axis {
    Vec3<V> point, direction;
};
}  // namespace cspace::kinematics

namespace cspace::kinematics::inline CSPACE_ISA {

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

// The columns of the joints of a chain for the point p, from column `first` of J (6, columns) on.
// Everything in one frame: the axes, p and the result. The other columns are set to zero.
template <class V>
CSPACE_INLINE void joint_columns(const model::Chain& chain, const Axis<V>* axes, const Vec3<V>& p, V* J,
                                 int columns, int first) {
    if (chain.ordered) {
        const V zero = fill<V>(0.0);
        for (int i = 0; i < chain.n; ++i) {
            const Vec3<V>& d = axes[i].direction;
            const bool slides = chain.joints[i].prismatic;
            put_column(J, columns, first + i, 0, slides ? d : cross(d, p - axes[i].point));
            put_column(J, columns, first + i, 3, slides ? Vec3<V>{zero, zero, zero} : d);
        }
        return;
    }
    for (int r = 0; r < 6; ++r) {
        for (int j = first; j < columns; ++j) J[r * columns + j] = fill<V>(0.0);
    }
    for (int i = 0; i < chain.n; ++i) {
        const model::ChainJoint& joint = chain.joints[i];
        const Vec3<V> d = joint.ratio * axes[i].direction;
        add_to_column(J, columns, first + joint.coordinate, 0,
                      joint.prismatic ? d : cross(d, p - axes[i].point));
        if (!joint.prismatic) add_to_column(J, columns, first + joint.coordinate, 3, d);
    }
}

// The columns of a floating base: its twist [v; ω] refers to its origin, `arm` away from the point p.
template <class V>
CSPACE_INLINE void base_columns(const Vec3<V>& arm, V* J, int columns, int rows) {
    const V zero = fill<V>(0.0), one = fill<V>(1.0);
    const Vec3<V> unit[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
    for (int j = 0; j < 3; ++j) {
        put_column(J, columns, j, 0, unit[j]);
        put_column(J, columns, 3 + j, 0, cross(unit[j], arm));
        if (rows < 6) continue;
        put_column(J, columns, j, 3, {zero, zero, zero});
        put_column(J, columns, 3 + j, 3, unit[j]);
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
