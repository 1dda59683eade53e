// The centroidal momentum and its matrix, and the energies.
//
// Orin, Goswami and Lee 2013 (Centroidal dynamics of a humanoid robot).
#pragma once

#include "cspace/dynamics/spatial_links.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {

// A momentum about the origin, taken about the point c.
template <class V>
CSPACE_INLINE Wrench<V> momentum_about(const Wrench<V>& momentum, const Vec3<V>& c) {
    return {momentum.f, momentum.n - cross(c, momentum.f)};
}

// The matrix A (6, columns), row by row, with [l; k] = A q̇ about the centre of mass, in the axes of the
// world.
template <class V>
CSPACE_INLINE void momentum_matrix(const Multibody& bodies, bool floating, const SpatialLink<V>* links,
                                   const SpatialBody<V>& whole, V* A) {
    const int first = floating ? 6 : 0, columns = first + bodies.n_coordinates;
    const Vec3<V> c = (1.0 / bodies.mass) * whole.first;
    for (int i = 0; i < 6 * columns; ++i) A[i] = fill_lanes<V>(0.0);
    const auto add = [&](int column, const Wrench<V>& momentum) {
        kinematics::add_to_column(A, columns, column, 0, momentum.f);
        kinematics::add_to_column(A, columns, column, 3, momentum.n);
    };
    for (int k = 0; k < bodies.n_links; ++k) {
        const Link& link = bodies.links[k];
        const SpatialLink<V>& state = links[k];
        const Twist<V> motion = scale_vector(link.ratio, state.axis);
        add(first + link.coordinate, momentum_about(momentum_of(link.carried_mass, state.all, motion), c));
    }
    if (!floating) return;
    const V zero = fill_lanes<V>(0.0), one = fill_lanes<V>(1.0), mass = fill_lanes<V>(bodies.mass);
    const Vec3<V> none = {zero, zero, zero},
                  unit[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
    for (int j = 0; j < 3; ++j) {
        const Twist<V> along = {unit[j], none}, about = {none, unit[j]};
        add(j, momentum_about(momentum_of(mass, whole, along), c));
        add(3 + j, momentum_about(momentum_of(mass, whole, about), c));
    }
}

// ½ Σ ω · k + v · l over the links, and of the armature of the joints.
template <class V>
CSPACE_INLINE V kinetic_energy(const Multibody& bodies, const Twist<V>& base, const V* qd,
                               const SpatialLink<V>* links, const SpatialBody<V>& whole) {
    // The momentum of the whole is felt by the base; that of each subtree by its joint.
    V twice = find_power(base, whole.momentum);
    for (int k = 0; k < bodies.n_links; ++k) {
        const Link& link = bodies.links[k];
        const V rate = link.ratio * qd[link.coordinate];
        twice = twice + rate * (find_power(links[k].axis, links[k].all.momentum) + link.armature * rate);
    }
    return 0.5 * twice;
}
// −m g · c, zero at the origin of the world. origin: of the base.
template <class V>
CSPACE_INLINE V potential_energy(const Multibody& bodies, const Vec3<V>& gravity, const Vec3<V>& origin,
                                 const SpatialBody<V>& whole) {
    return -dot(gravity, whole.first + bodies.mass * origin);
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
