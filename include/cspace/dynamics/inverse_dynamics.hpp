// Inverse dynamics: the forces and torques behind a motion, by the recursion of Newton and Euler.
//
// With angular velocity ω and acceleration α, points fixed to a body accelerate by a + K p, K = [α]× + ω ωᵀ −
// |ω|² 1, so that the force on it is m a + K m c and the torque about its origin m c × a + ∫ p × K p dm.
// These are accelerations of points, not of spatial vectors: linear velocities never appear (Luh, Walker and
// Paul 1980).
#pragma once

#include "cspace/dynamics/applied_wrenches.hpp"

namespace cspace::dynamics {
// How a frame moves: angular velocity, angular acceleration and the acceleration of its origin, less gravity.
template <class V>
struct Motion {
    Vec3<V> w, wd, a;
};
// What inverse dynamics keeps of a link.
template <class V>
struct LinkMotion {
    Turn<V> turn;
    Vec3<V> t;
    Motion<V> motion;
    Mat3<V> K;
    Wrench<V> wrench;
};
}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

// How the acceleration of a point grows with its place in a frame.
template <class V>
CSPACE_INLINE Mat3<V> acceleration_gradient(const Vec3<V>& w, const Vec3<V>& wd) {
    const V xx = w.x * w.x, yy = w.y * w.y, zz = w.z * w.z;
    return {{{-(yy + zz), w.x * w.y - wd.z, w.x * w.z + wd.y},
             {w.x * w.y + wd.z, -(xx + zz), w.y * w.z - wd.x},
             {w.x * w.z - wd.y, w.y * w.z + wd.x, -(xx + yy)}}};
}

// ∫ p × K p dm of a body with the second moment S.
template <class V, class S>
CSPACE_INLINE Vec3<V> torque_of_gradient(const Mat3<V>& K, const Symmetric3<S>& s) {
    const auto& m = K.m;
    return {
        m[2][0] * s.xy + m[2][1] * s.yy + m[2][2] * s.yz - m[1][0] * s.xz - m[1][1] * s.yz - m[1][2] * s.zz,
        m[0][0] * s.xz + m[0][1] * s.yz + m[0][2] * s.zz - m[2][0] * s.xx - m[2][1] * s.xy - m[2][2] * s.xz,
        m[1][0] * s.xx + m[1][1] * s.xy + m[1][2] * s.xz - m[0][0] * s.xy - m[0][1] * s.yy - m[0][2] * s.yz};
}

// The wrench that moves a body.
template <class V>
CSPACE_INLINE Wrench<V> body_wrench(const MomentsOf<V>& body, const Motion<V>& motion, const Mat3<V>& K) {
    const Vec3<V> h = fill_vec3<V>(body.first);
    return {body.mass * motion.a + K * h, cross(h, motion.a) + torque_of_gradient(K, body.second)};
}
// The same for a body that does not turn.
template <class V>
CSPACE_INLINE Wrench<V> body_wrench(const MomentsOf<V>& body, const Vec3<V>& a) {
    return {body.mass * a, cross(fill_vec3<V>(body.first), a)};
}

// Adds what a link feels at its origin to what its parent feels.
template <class V>
CSPACE_INLINE void hand_down(const LinkOf<V>& link, const LinkMotion<V>& state, Wrench<V>& parent) {
    Wrench<V> wrench = state.wrench;
    to_parent(link, state.turn, wrench.f, wrench.n);
    parent.f = parent.f + wrench.f;
    parent.n = parent.n + wrench.n + cross(state.t, wrench.f);
}

// What a joint itself opposes to its motion, at its coordinate. rubs: with damping and dry friction.
template <class V>
CSPACE_INLINE V joint_resistance(const LinkOf<V>& link, V qd, V qdd, bool rubs) {
    V force = (link.ratio * link.ratio * link.armature) * qdd;
    if (!rubs) return force;
    force = force + (link.ratio * link.ratio * link.damping) * qd;
    if (link.friction == 0.0) return force;
    const V zero = fill_lanes<V>(0.0), v = link.ratio * qd;
    const V size = fill_lanes<V>(link.ratio * link.friction);
    return force + select_lanes(v > zero, size, select_lanes(v < zero, -size, zero));
}

// The torques (n_coordinates,) that accelerate the joints by qdd (null: zero) and carry the weight of the
// robot. base: how the base moves, in its axes, with a less gravity. Returns the wrench on the base, at its
// origin, in its axes. applied: see applied_wrenches.hpp.
template <class V>
CSPACE_INLINE Wrench<V> inverse_dynamics(const MultibodyOf<V>& bodies, const Motion<V>& base, const V* q,
                                         const V* qd, const V* qdd, bool rubs, LinkMotion<V>* links, V* tau,
                                         const AppliedWrenches<V>& applied = {}) {
    const V zero = fill_lanes<V>(0.0);
    turn_links(bodies, q, links);
    const Mat3<V> base_K = acceleration_gradient(base.w, base.wd);
    for (int k = 0; k < bodies.n_links; ++k) {
        const LinkOf<V>& link = bodies.links[k];
        const bool first = link.parent < 0;
        const Motion<V>& before = first ? base : links[link.parent].motion;
        const Mat3<V>& K_before = first ? base_K : links[link.parent].K;
        const V rate = link.ratio * qd[link.coordinate];
        const V rate_change = qdd ? link.ratio * qdd[link.coordinate] : zero;
        LinkMotion<V>& state = links[k];
        state.t = link_origin(link, q);
        Vec3<V> w = before.w, wd = before.wd, a = before.a + K_before * state.t;
        to_link(link, state.turn, w, wd, a);
        if (link.prismatic) {
            a = {a.x + 2.0 * (w.y * rate), a.y - 2.0 * (w.x * rate), a.z + rate_change};
        } else {
            wd = {wd.x + w.y * rate, wd.y - w.x * rate, wd.z + rate_change};
            w.z = w.z + rate;
        }
        state.motion = {w, wd, a};
        state.K = acceleration_gradient(w, wd);
        state.wrench = body_wrench(link.body, state.motion, state.K);
    }
    apply_wrenches(bodies, applied, links, [](LinkMotion<V>& state) -> Wrench<V>& { return state.wrench; });
    for (int j = 0; j < bodies.n_coordinates; ++j) tau[j] = zero;
    Wrench<V> on_base = body_wrench(bodies.base, base, base_K);
    apply_to_base(applied, on_base);
    for (int k = bodies.n_links - 1; k >= 0; --k) {
        const LinkOf<V>& link = bodies.links[k];
        const LinkMotion<V>& state = links[k];
        const V force = link.prismatic ? state.wrench.f.z : state.wrench.n.z;
        const int j = link.coordinate;
        tau[j] = tau[j] + link.ratio * force + joint_resistance(link, qd[j], qdd ? qdd[j] : zero, rubs);
        hand_down(link, state, link.parent < 0 ? on_base : links[link.parent].wrench);
    }
    return on_base;
}

// The torques (n_coordinates,) that hold the weight of the robot at rest. lift: minus gravity, in the axes of
// the base. Returns the wrench on the base.
template <class V>
CSPACE_INLINE Wrench<V> gravity_torques(const MultibodyOf<V>& bodies, const Vec3<V>& lift, const V* q,
                                        LinkMotion<V>* links, V* tau) {
    turn_links(bodies, q, links);
    for (int k = 0; k < bodies.n_links; ++k) {
        const LinkOf<V>& link = bodies.links[k];
        LinkMotion<V>& state = links[k];
        state.t = link_origin(link, q);
        state.motion.a = link.parent < 0 ? lift : links[link.parent].motion.a;
        to_link(link, state.turn, state.motion.a);
        state.wrench = body_wrench(link.body, state.motion.a);
    }
    for (int j = 0; j < bodies.n_coordinates; ++j) tau[j] = fill_lanes<V>(0.0);
    Wrench<V> on_base = body_wrench(bodies.base, lift);
    for (int k = bodies.n_links - 1; k >= 0; --k) {
        const LinkOf<V>& link = bodies.links[k];
        const LinkMotion<V>& state = links[k];
        V& force = tau[link.coordinate];
        force = force + link.ratio * (link.prismatic ? state.wrench.f.z : state.wrench.n.z);
        hand_down(link, state, link.parent < 0 ? on_base : links[link.parent].wrench);
    }
    return on_base;
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
