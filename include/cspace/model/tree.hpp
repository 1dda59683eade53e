// A robot as a tree of joints, every fixed link folded into the joint that carries it.
//
// A joint places its moving frame in that of its parent: T_parent_joint · Rz(v) if it turns, T_parent_joint
// · Tz(v) if it slides, with v = ratio · q[coordinate] + offset. Its axis is z always: the reader of a
// robot turns it there once. Joints that mimic another share its coordinate. Plain data: it is shared by
// all instruction sets.
#pragma once

#include "cspace/math/symmetric.hpp"

namespace cspace::model {

struct Joint {
    Posed T_parent_joint;
    int parent;      // joint that carries it, smaller than its own index; -1: the base
    int coordinate;  // which entry of q moves it
    double ratio, offset;
    bool prismatic;
    double carried_mass;  // of all that it moves [kg]
    // Of the joint itself: inertia of its rotor behind the gear [kg·m² or kg], viscous damping [N·m·s/rad or
    // N·s/m] and dry friction [N·m or N].
    double armature = 0.0, damping = 0.0, friction = 0.0;
};
// A named place, fixed to a joint (-1: to the base).
struct Frame {
    Posed T_joint_frame;
    int joint;
};
// All that is fixed to a joint, as one mass [kg] at its centre [m] in the frame of the joint, with its
// inertia about the centre, in the axes of the joint [kg·m²].
struct Body {
    Vec3d center;
    double mass;
    Symmetric3<double> inertia = {};
};
// bodies[0] belongs to the base, bodies[k + 1] to joint k.
struct Tree {
    const Joint* joints;
    const Frame* frames;
    const Body* bodies;
    int n_joints, n_frames, n_coordinates;
    double mass;
};

}  // namespace cspace::model
