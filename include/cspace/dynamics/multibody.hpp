// A robot as dynamics takes it: one link per joint, with its place in the link before and its mass.
//
// Link k stands in its parent at Rz(φ) Rx(α) Rz(turn · q + angle), with its origin at t + (slide · q + z) d,
// d the third axis. Frames are turned about their own z so that φ = 0 for the first link that a link carries
// (as in cspace/model/chain.hpp): most rotations are then one turn by a variable angle and one by a right
// angle. Plain data: it is shared by all instruction sets.
#pragma once

#include "cspace/math/symmetric.hpp"
#include "cspace/model/chain.hpp"

namespace cspace::dynamics {

// The moments of a body about the origin of its frame: mass [kg], first moment m c [kg·m] and second moment
// ∫ p pᵀ dm [kg·m²]. The inertia tensor is tr(S) 1 − S.
template <class V>
struct Moments {
    V mass;
    Vec3<V> first;
    Symmetric3<V> second;
};

struct Link {
    int parent;              // the link that carries it, smaller than its own number; -1: the base
    int coordinate;          // which entry of q moves it
    bool prismatic, turned;  // turned: φ is not zero
    model::Tilt tilt;
    double ratio;                        // velocity of the joint per velocity of its coordinate
    double turn, angle;                  // turn is 0 for a prismatic joint
    double slide, z;                     // both are 0 for a revolute joint
    double cos_phi, sin_phi;             // φ
    double cos_alpha, sin_alpha;         // α, whose sine is not negative
    Vec3d t, d;                          // in the axes of the parent
    Moments<double> body;                // in its own axes
    double carried_mass;                 // of all that the joint moves [kg]
    double armature, damping, friction;  // of the joint
};

struct Multibody {
    const Link* links;
    int n_links, n_coordinates;
    bool shares;           // a coordinate moves several joints
    Moments<double> base;  // what is fixed to the base, in its axes
    double mass;
};

}  // namespace cspace::dynamics
