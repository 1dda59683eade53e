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
// The parameters of a body in a regressor: mass, first moments, and its inertia row by row.
inline constexpr int body_parameters = 10;

template <class S>
struct BasicLink {
    int parent;              // the link that carries it, smaller than its own number; -1: the base
    int coordinate;          // which entry of q moves it
    bool prismatic, turned;  // turned: φ is not zero
    model::Tilt tilt;
    S ratio;                        // velocity of the joint per velocity of its coordinate
    S turn, angle;                  // turn is 0 for a prismatic joint
    S slide, z;                     // both are 0 for a revolute joint
    S cos_phi, sin_phi;             // φ
    S cos_alpha, sin_alpha;         // α, whose sine is not negative
    Vec3<S> t, d;                   // in the axes of the parent
    Moments<S> body;                // in its own axes
    S carried_mass;                 // of all that the joint moves [kg]
    S armature, damping, friction;  // of the joint
};

template <class S>
struct BasicMultibody {
    const BasicLink<S>* links;
    int n_links, n_coordinates;
    bool shares;      // a coordinate moves several joints
    Moments<S> base;  // what is fixed to the base, in its axes
    S mass;
};

using Link = BasicLink<double>;
using Multibody = BasicMultibody<double>;
// The numbers that lanes of V are computed with.
template <class V>
using LinkOf = BasicLink<scalar_of<V>>;
template <class V>
using MultibodyOf = BasicMultibody<scalar_of<V>>;
template <class V>
using MomentsOf = Moments<scalar_of<V>>;

}  // namespace cspace::dynamics
