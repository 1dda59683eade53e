// The Coriolis matrix C of Christoffel's symbols: C q̇ are the forces of velocities, and Ṁ = C + Cᵀ.
//
// Echeandia and Wensing 2021 (Numerical methods to compute the Coriolis matrix and Christoffel symbols for
// rigid-body systems, algorithm 1).
#pragma once

#include "cspace/dynamics/spatial_links.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {

// C (columns, columns), row by row, as mass_matrix.hpp orders M. links, whole: as of place_links with
// velocities. base: how a floating base moves.
template <class V>
CSPACE_INLINE void coriolis_matrix(const Multibody& bodies, const Twist<V>& base, bool floating,
                                   const SpatialLink<V>* links, const SpatialBody<V>& whole, V* C) {
    const int first = floating ? 6 : 0, columns = first + bodies.n_coordinates;
    const auto add = [&](int row, int column, V value) {
        V& entry = C[row * columns + column];
        entry = entry + value;
    };
    for (int i = 0; i < columns * columns; ++i) C[i] = fill_lanes<V>(0.0);
    for (int k = 0; k < bodies.n_links; ++k) {
        const Link& link = bodies.links[k];
        const SpatialLink<V>& state = links[k];
        const int column = first + link.coordinate;
        const Wrench<V> F1 = momentum_of(link.carried_mass, state.all, state.axis_rate) +
                             velocity_product(state.all, state.axis);
        const Wrench<V> F2 = momentum_of(link.carried_mass, state.all, state.axis);
        const Vec3<V> F3 = transposed_velocity_product(state.all, state.axis);
        add(column, column, (link.ratio * link.ratio) * find_power(state.axis, F1));
        for (int i = link.parent; i >= 0; i = bodies.links[i].parent) {
            const Link& before = bodies.links[i];
            const double ratio = before.ratio * link.ratio;
            add(first + before.coordinate, column, ratio * find_power(links[i].axis, F1));
            add(column, first + before.coordinate,
                ratio * (find_power(links[i].axis_rate, F2) + dot(links[i].axis.w, F3)));
        }
        if (!floating) continue;
        const Vec3<V> turning = cross(F2.f, base.v) + F3;
        const V down[6] = {F1.f.x, F1.f.y, F1.f.z, F1.n.x, F1.n.y, F1.n.z};
        const V across[3] = {turning.x, turning.y, turning.z};
        for (int i = 0; i < 6; ++i) add(i, column, link.ratio * down[i]);
        for (int i = 0; i < 3; ++i) add(column, 3 + i, link.ratio * across[i]);
    }
    if (!floating) return;
    // Columns of the base: (e; 0) with rate zero and (0; e) with rate (v × e; 0).
    const V zero = fill_lanes<V>(0.0), one = fill_lanes<V>(1.0);
    const Vec3<V> none = {zero, zero, zero},
                  unit[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
    const V mass = fill_lanes<V>(bodies.mass);
    for (int j = 0; j < 3; ++j) {
        const Twist<V> axis = {none, unit[j]}, rate = {cross(base.v, unit[j]), none};
        const Wrench<V> F1 = momentum_of(mass, whole, rate) + velocity_product(whole, axis);
        const V column[6] = {F1.f.x, F1.f.y, F1.f.z, F1.n.x, F1.n.y, F1.n.z};
        for (int i = 0; i < 6; ++i) add(i, 3 + j, column[i]);
    }
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
