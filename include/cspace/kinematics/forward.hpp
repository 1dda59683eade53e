// Forward kinematics: where the frames of a robot are, at a configuration.
//
// Murray, Li and Sastry, A Mathematical Introduction to Robotic Manipulation (1994), section 3.2.
#pragma once

#include "cspace/kinematics/pose_matrix.hpp"
#include "cspace/math/trig.hpp"
#include "cspace/math/vec.hpp"
#include "cspace/model/chain.hpp"
#include "cspace/model/tree.hpp"

namespace cspace::kinematics {
template <class V>
struct FrameAxes {
    Vec3<V> x, y, z, origin;
};
}  // namespace cspace::kinematics

namespace cspace::kinematics::inline CSPACE_ISA {

// The sine and cosine of each joint angle of a chain.
template <class V>
CSPACE_INLINE void chain_sines(const model::Chain& chain, const V* q, V* s, V* c) {
    const auto angle_of = [&](int i) {
        const model::ChainJoint& joint = chain.joints[i];
        return joint.turn * q[joint.coordinate] + joint.angle;
    };
    sincos_each<V>(chain.n, angle_of,
                   [&](int i, const V& sine, const V& cosine) { s[i] = sine, c[i] = cosine; });
}

// A frame by its axes and its origin. Without arrays inside, a compiler keeps all of it in registers.
template <class V>
CSPACE_INLINE FrameAxes<V> frame_axes(const Pose<V>& T) {
    return {matrix_column(T.R, 0), matrix_column(T.R, 1), matrix_column(T.R, 2), T.t};
}
template <class V>
CSPACE_INLINE Pose<V> to_pose(const FrameAxes<V>& frame) {
    return {from_columns(frame.x, frame.y, frame.z), frame.origin};
}
// Rotates the frame about its z axis.
template <class V, class S>
CSPACE_INLINE void turn_about_z(FrameAxes<V>& frame, const S& s, const S& c) {
    const Vec3<V> x = frame.x;
    frame.x = c * x + s * frame.y;
    frame.y = c * frame.y - s * x;
}
// Rotates the frame about its x axis by the α of a joint.
template <class V, class Joint>
CSPACE_INLINE void tilt_frame(FrameAxes<V>& frame, const Joint& joint) {
    const Vec3<V> y = frame.y;
    switch (joint.tilt) {
        case model::Tilt::none:
            return;
        case model::Tilt::quarter:
            frame.y = frame.z;
            frame.z = -y;
            return;
        case model::Tilt::half:
            frame.y = -y;
            frame.z = -frame.z;
            return;
        case model::Tilt::any:
            frame.y = joint.cos_alpha * y + joint.sin_alpha * frame.z;
            frame.z = joint.cos_alpha * frame.z - joint.sin_alpha * y;
    }
}

// Follows a chain from the frame of its first joint to its own frame, which it returns. visit(i, point,
// direction) sees each joint: a point on its axis and the direction of the axis.
template <class V, class Visit>
CSPACE_INLINE Pose<V> follow_chain(const model::Chain& chain, const Pose<V>& first, const V* q, const V* s,
                                   const V* c, const Visit& visit) {
    FrameAxes<V> frame = frame_axes(first);
    for (int i = 0; i < chain.n; ++i) {
        const model::ChainJoint& joint = chain.joints[i];
        visit(i, frame.origin, frame.z);
        turn_about_z(frame, s[i], c[i]);
        const V z = joint.slide * q[joint.coordinate] + joint.z;
        if (joint.x != 0.0) frame.origin = frame.origin + joint.x * frame.x;
        if (joint.y != 0.0) frame.origin = frame.origin + joint.y * frame.y;
        frame.origin = frame.origin + z * frame.z;
        tilt_frame(frame, joint);
    }
    if (chain.n > 0) turn_about_z(frame, chain.sin_last, chain.cos_last);
    return to_pose(frame);
}

// The frame of a joint, moved along or about its z axis by the value of the joint.
template <class V>
CSPACE_INLINE Pose<V> move_joint(Pose<V> T, bool prismatic, const V& value) {
    if (prismatic) {
        T.t = T.t + value * matrix_column(T.R, 2);
        return T;
    }
    V s, c;
    sincos(value, s, c);
    FrameAxes<V> frame = frame_axes(T);
    turn_about_z(frame, s, c);
    return to_pose(frame);
}
// The moving frames of all joints of a tree, in the base.
template <class V>
CSPACE_INLINE void joint_poses(const model::Tree& tree, const V* q, const Pose<V>& T_world_base,
                               Pose<V>* T_world_joint) {
    for (int k = 0; k < tree.n_joints; ++k) {
        const model::Joint& joint = tree.joints[k];
        const Pose<V>& parent = joint.parent < 0 ? T_world_base : T_world_joint[joint.parent];
        const V value = joint.ratio * q[joint.coordinate] + joint.offset;
        T_world_joint[k] = move_joint(parent * fill_pose<V>(joint.T_parent_joint), joint.prismatic, value);
    }
}

// The pose of a frame of the tree, from the poses of the joints.
template <class V>
CSPACE_INLINE Pose<V> frame_pose(const model::Frame& frame, const Pose<V>& T_world_base,
                                 const Pose<V>* T_world_joint) {
    const Pose<V>& T = frame.joint < 0 ? T_world_base : T_world_joint[frame.joint];
    return T * fill_pose<V>(frame.T_joint_frame);
}

}  // namespace cspace::kinematics::inline CSPACE_ISA
