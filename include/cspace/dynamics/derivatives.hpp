// The first derivatives of inverse dynamics by positions, velocities and accelerations, in closed form.
//
// Carpentier and Mansard 2018; in the order of Singh, Russell and Wensing 2022 (Efficient analytical
// derivatives of rigid-body dynamics using spatial vector algebra), where every entry is a product of a
// motion and a wrench in common axes.
#pragma once

#include "cspace/dynamics/spatial_links.hpp"

namespace cspace::dynamics::inline CSPACE_ISA {

// What an entry needs of the joint that moves: the motion by which the velocities (rate) and the
// accelerations (bend) behind it grow.
template <class V>
struct Growth {
    Twist<V> axis, rate, bend;
};

// dq and dqd (columns, columns), rows `stride` apart: the derivatives of tau by the positions and velocities
// of the joints, and by a displacement of a floating base, [v; ω] in the axes of the world, that leaves its
// velocities and accelerations in these axes as they are. base, change: its motion and the time derivative of
// that, less gravity. links, whole: as of place_links with change. M is the derivative by the
// accelerations, the mass matrix.
template <class V>
CSPACE_INLINE void torque_derivatives(const Multibody& bodies, const Twist<V>& base, const Twist<V>& change,
                                      bool floating, bool rubs, const SpatialLink<V>* links,
                                      const SpatialBody<V>& whole, int stride, V* dq, V* dqd, V* M) {
    const int first = floating ? 6 : 0, columns = first + bodies.n_coordinates;
    const auto add = [&](V* matrix, int row, int column, V value) {
        V& entry = matrix[row * stride + column];
        entry = entry + value;
    };
    const auto add_rows = [&](V* matrix, int column, const Wrench<V>& wrench) {
        const V rows[6] = {wrench.f.x, wrench.f.y, wrench.f.z, wrench.n.x, wrench.n.y, wrench.n.z};
        for (int i = 0; i < 6; ++i) add(matrix, i, column, rows[i]);
    };
    const auto growth_of = [&](int k) -> Growth<V> {
        return {links[k].axis, links[k].axis_rate, links[k].axis_bend};
    };
    for (int i = 0; i < columns; ++i) {
        for (int j = 0; j < columns; ++j) {
            const int k = i * stride + j;
            dq[k] = dqd[k] = M[k] = fill_lanes<V>(0.0);
        }
    }
    for (int k = 0; k < bodies.n_links; ++k) {
        const Link& link = bodies.links[k];
        const SpatialLink<V>& state = links[k];
        const int column = first + link.coordinate;
        const Growth<V> own = growth_of(k);
        const auto inertial = [&](const Twist<V>& motion) {
            return momentum_of(link.carried_mass, state.all, motion);
        };
        // The wrench on all that the joint moves, where the joint and its velocity grow.
        const Wrench<V> by_position = scale_vector(2.0, velocity_product(state.all, own.rate)) +
                                      inertial(own.bend) + cross_wrench(own.axis, state.all.wrench);
        const Wrench<V> by_velocity =
            scale_vector(2.0, velocity_product(state.all, own.axis) + inertial(own.rate));
        // The force of the joint, where those before it and their velocities grow.
        const Wrench<V> unit = inertial(own.axis);
        const Vec3<V> turning = 2.0 * transposed_velocity_product(state.all, own.axis);
        const double square = link.ratio * link.ratio;
        add(dq, column, column, square * find_power(own.axis, by_position));
        add(dqd, column, column, square * find_power(own.axis, by_velocity));
        if (rubs) add(dqd, column, column, fill_lanes<V>(square * link.damping));
        add(M, column, column, square * (find_power(own.axis, unit) + link.armature));
        for (int i = link.parent; i >= 0; i = bodies.links[i].parent) {
            const Link& before = bodies.links[i];
            const Growth<V> other = growth_of(i);
            const double ratio = before.ratio * link.ratio;
            const int row = first + before.coordinate;
            add(dq, row, column, ratio * find_power(other.axis, by_position));
            add(dqd, row, column, ratio * find_power(other.axis, by_velocity));
            add(dq, column, row, ratio * (dot(turning, other.rate.w) + find_power(other.bend, unit)));
            add(dqd, column, row, ratio * (dot(turning, other.axis.w) + 2.0 * find_power(other.rate, unit)));
            const V inertia = ratio * find_power(other.axis, unit);
            add(M, row, column, inertia);
            add(M, column, row, inertia);
        }
        if (!floating) continue;
        add_rows(dq, column, scale_vector(link.ratio, by_position));
        add_rows(dqd, column, scale_vector(link.ratio, by_velocity));
        add_rows(M, column, scale_vector(link.ratio, unit));
    }
    if (!floating) return;
    // Turning the base by e and all motion and gravity with it changes no joint force and turns the wrench on
    // the base. Turning motion and gravity back again is a change of velocity and acceleration.
    const V zero = fill_lanes<V>(0.0), one = fill_lanes<V>(1.0), mass = fill_lanes<V>(bodies.mass);
    const Vec3<V> none = {zero, zero, zero},
                  unit[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
    const Vec3<V> point_change =
        change.v + cross(base.w, base.v);  // of the origin, not of the spatial motion
    const auto by_turning_faster = [&](const Vec3<V>& w) -> Growth<V> {
        return {{none, w}, {cross(base.v, w), none}, {2.0 * cross(base.v, w), cross(base.w, w)}};
    };
    for (int j = 0; j < 3; ++j) {
        const Vec3<V>& e = unit[j];
        const Growth<V> faster = by_turning_faster(e), undone = by_turning_faster(cross(e, base.w));
        const Twist<V> lost = {cross(e, point_change), cross(e, change.w)};
        const auto wrench_of = [&](const Growth<V>& growth) {
            return scale_vector(2.0, velocity_product(whole, growth.axis)) +
                   momentum_of(mass, whole, growth.bend);
        };
        const Wrench<V> velocity = wrench_of(faster),
                        undoing = wrench_of(undone) + momentum_of(mass, whole, lost);
        const Vec3<V> f = cross(e, whole.wrench.f) - undoing.f, n = cross(e, whole.wrench.n) - undoing.n;
        add_rows(dq, 3 + j, Wrench<V>{f, n});
        add_rows(dqd, 3 + j, velocity);
        add_rows(M, j, momentum_of(mass, whole, Twist<V>{e, none}));
        add_rows(M, 3 + j, momentum_of(mass, whole, Twist<V>{none, e}));
        for (int k = 0; k < bodies.n_links; ++k) {
            const Link& link = bodies.links[k];
            const SpatialLink<V>& state = links[k];
            const Wrench<V> push = momentum_of(link.carried_mass, state.all, state.axis);
            const Vec3<V> turning = 2.0 * transposed_velocity_product(state.all, state.axis);
            const auto force_of = [&](const Growth<V>& growth) {
                return dot(turning, growth.axis.w) + find_power(growth.bend, push);
            };
            add(dqd, first + link.coordinate, 3 + j, link.ratio * force_of(faster));
            add(dq, first + link.coordinate, 3 + j,
                -link.ratio * (force_of(undone) + find_power(lost, push)));
        }
    }
    for (int i = 0; i < 6; ++i)
        for (int j = 6; j < columns; ++j) M[j * stride + i] = M[i * stride + j];
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
