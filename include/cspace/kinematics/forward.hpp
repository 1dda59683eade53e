// Forward kinematics: where the frames of a robot are, at a configuration.
//
// Murray, Li and Sastry, A Mathematical Introduction to Robotic Manipulation (1994), section 3.2.
#pragma once

#include "cspace/math/trig.hpp"
#include "cspace/math/vec.hpp"
#include "cspace/model/chain.hpp"
#include "cspace/model/tree.hpp"

namespace cspace::inline CSPACE_ISA {

// The sine and cosine of each joint angle of a chain; s and c hold n rounded up to four.
// One configuration alone fills the lanes with its joints.
template <class V>
CSPACE_INLINE void chain_sines(const Chain& chain, const V* q, V* s, V* c) {
    if constexpr (Lanes<V>::count == 1) {
        for (int i = 0; i < chain.n; i += 4) {
            auto angles = fill<Pack<4>>(0.0);
            const int count = chain.n - i < 4 ? chain.n - i : 4;
            for (int k = 0; k < count; ++k) {
                const ChainJoint& joint = chain.joints[i + k];
                set_lane(angles, k, joint.turn * q[joint.coordinate] + joint.angle);
            }
            Pack<4> sines, cosines;
            sincos(angles, sines, cosines);
            for (int k = 0; k < 4; ++k) {
                s[i + k] = lane(sines, k);
                c[i + k] = lane(cosines, k);
            }
        }
    } else {
        for (int i = 0; i < chain.n; ++i) {
            const ChainJoint& joint = chain.joints[i];
            sincos(joint.turn * q[joint.coordinate] + joint.angle, s[i], c[i]);
        }
    }
}

// Turns the first two columns: R · Rz(angle).
template <class V, class S>
CSPACE_INLINE void turn_about_z(Mat3<V>& R, const S& s, const S& c) {
    for (int r = 0; r < 3; ++r) {
        const V x = R.m[r][0], y = R.m[r][1];
        R.m[r][0] = c * x + s * y;
        R.m[r][1] = c * y - s * x;
    }
}
// Turns the last two columns: R · Rx(angle).
template <class V, class S>
CSPACE_INLINE void turn_about_x(Mat3<V>& R, const S& s, const S& c) {
    for (int r = 0; r < 3; ++r) {
        const V y = R.m[r][1], z = R.m[r][2];
        R.m[r][1] = c * y + s * z;
        R.m[r][2] = c * z - s * y;
    }
}

// Follows a chain from T, the pose of the frame of its first joint, to its own frame, which it returns.
// visit(i, point, direction) sees each joint: a point on its axis and the direction of the axis.
template <class V, class Visit>
CSPACE_INLINE Pose<V> follow_chain(const Chain& chain, Pose<V> T, const V* q, const V* s, const V* c,
                                   const Visit& visit) {
    for (int i = 0; i < chain.n; ++i) {
        const ChainJoint& joint = chain.joints[i];
        visit(i, T.t, column(T.R, 2));
        turn_about_z(T.R, s[i], c[i]);
        const V z = joint.slide * q[joint.coordinate] + joint.z;
        for (int r = 0; r < 3; ++r) {
            V& t = r == 0 ? T.t.x : r == 1 ? T.t.y : T.t.z;
            t += T.R.m[r][0] * joint.x + T.R.m[r][1] * joint.y + T.R.m[r][2] * z;
        }
        turn_about_x(T.R, joint.sin_alpha, joint.cos_alpha);
    }
    if (chain.n > 0) turn_about_z(T.R, chain.sin_last, chain.cos_last);
    return T;
}

// The moving frames of all joints of a tree, in the base.
template <class V>
CSPACE_INLINE void joint_poses(const Tree& tree, const V* q, const Pose<V>& T_world_base,
                               Pose<V>* T_world_joint) {
    for (int k = 0; k < tree.n_joints; ++k) {
        const Joint& joint = tree.joints[k];
        const Pose<V>& parent = joint.parent < 0 ? T_world_base : T_world_joint[joint.parent];
        Pose<V> T = parent * fill_pose<V>(joint.T_parent_joint);
        const V value = joint.ratio * q[joint.coordinate] + joint.offset;
        if (joint.prismatic) {
            T.t = T.t + value * column(T.R, 2);
        } else {
            V s, c;
            sincos(value, s, c);
            turn_about_z(T.R, s, c);
        }
        T_world_joint[k] = T;
    }
}

// The pose of a frame of the tree, from the poses of the joints.
template <class V>
CSPACE_INLINE Pose<V> frame_pose(const Frame& frame, const Pose<V>& T_world_base,
                                 const Pose<V>* T_world_joint) {
    const Pose<V>& T = frame.joint < 0 ? T_world_base : T_world_joint[frame.joint];
    return T * fill_pose<V>(frame.T_joint_frame);
}

// A pose as the sixteen numbers of its matrix, row by row, and back.
template <class V>
CSPACE_INLINE void write_matrix(const Pose<V>& T, V* matrix) {
    for (int r = 0; r < 3; ++r) {
        for (int j = 0; j < 3; ++j) matrix[4 * r + j] = T.R.m[r][j];
        matrix[4 * r + 3] = r == 0 ? T.t.x : r == 1 ? T.t.y : T.t.z;
        matrix[12 + r] = fill<V>(0.0);
    }
    matrix[15] = fill<V>(1.0);
}
template <class V>
CSPACE_INLINE Pose<V> read_matrix(const V* m) {
    return {{{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}}, {m[3], m[7], m[11]}};
}

}  // namespace cspace::inline CSPACE_ISA
