// The Lagrangian L = T − V of a robot: its momenta ∂L/∂q̇ = M q̇ and its slope ∂L/∂q, without any matrix.
//
// In the axes of each link the velocity of its origin is handed up, its momentum and first moment down. A
// joint moves all beyond it along S; the velocity with which that is carried then changes by v × S, so that
// ∂T/∂q is the power of v × S on its momentum (Marsden and Ratiu 1999 for L; the recursion is that of
// Luh, Walker and Paul 1980).
#pragma once

#include "cspace/dynamics/inverse_dynamics.hpp"
#include "cspace/kinematics/jacobian.hpp"

namespace cspace::dynamics {
using kinematics::Twist;

// What the Lagrangian keeps of a link, in its axes: the velocity of its origin, gravity, and the momentum and
// the first moment of all that its joint moves, about its origin.
template <class V>
struct LinkMomentum {
    Turn<V> turn;
    Vec3<V> t;
    Twist<V> motion;
    Vec3<V> gravity;
    Wrench<V> momentum;
    Vec3<V> first;
};
// Of the whole robot, about the origin of its base, in its axes.
template <class V>
struct WholeMomentum {
    Wrench<V> momentum;
    Vec3<V> first;
};
}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

// The momentum of a body about the origin of its frame, which moves so.
template <class V>
CSPACE_INLINE Wrench<V> body_momentum(const Moments<double>& body, const Twist<V>& motion) {
    const Vec3<V> h = fill_vec3<V>(body.first);
    const Symmetric3<double>& S = body.second;
    const Symmetric3<V> inertia =
        fill_symmetric<V>(Symmetric3<double>{S.yy + S.zz, -S.xy, -S.xz, S.xx + S.zz, -S.yz, S.xx + S.yy});
    return {body.mass * motion.v + cross(motion.w, h), cross(h, motion.v) + inertia * motion.w};
}

// The slope of L along a joint: the power of v × S on the momentum, and the weight along S.
template <class V>
CSPACE_INLINE V joint_slope(const Link& link, const LinkMomentum<V>& state) {
    const Vec3<V>&v = state.motion.v, &w = state.motion.w, &g = state.gravity, &h = state.first;
    const Vec3<V>&l = state.momentum.f, &k = state.momentum.n;
    if (link.prismatic) return w.y * l.x - w.x * l.y + link.carried_mass * g.z;
    return v.y * l.x - v.x * l.y + w.y * k.x - w.x * k.y + h.x * g.y - h.y * g.x;
}

// momentum, slope (n_coordinates,): ∂L/∂q̇ and ∂L/∂q of the joints. base: the motion of the base, and
// gravity, in its axes.
template <class V>
CSPACE_INLINE WholeMomentum<V> lagrangian_rates(const Multibody& bodies, const Twist<V>& base,
                                                const Vec3<V>& gravity, const V* q, const V* qd,
                                                LinkMomentum<V>* links, V* momentum, V* slope) {
    turn_links(bodies, q, links);
    for (int k = 0; k < bodies.n_links; ++k) {
        const Link& link = bodies.links[k];
        LinkMomentum<V>& state = links[k];
        const Twist<V>& before = link.parent < 0 ? base : links[link.parent].motion;
        state.t = link_origin(link, q);
        state.motion = {before.v + cross(before.w, state.t), before.w};
        state.gravity = link.parent < 0 ? gravity : links[link.parent].gravity;
        to_link(link, state.turn, state.motion.v, state.motion.w, state.gravity);
        const V rate = link.ratio * qd[link.coordinate];
        V& along = link.prismatic ? state.motion.v.z : state.motion.w.z;
        along = along + rate;
        state.momentum = body_momentum(link.body, state.motion);
        state.first = fill_vec3<V>(link.body.first);
    }
    for (int j = 0; j < bodies.n_coordinates; ++j) momentum[j] = slope[j] = fill_lanes<V>(0.0);
    WholeMomentum<V> whole = {body_momentum(bodies.base, base), fill_vec3<V>(bodies.base.first)};
    for (int k = bodies.n_links - 1; k >= 0; --k) {
        const Link& link = bodies.links[k];
        const LinkMomentum<V>& state = links[k];
        const int j = link.coordinate;
        const V along = link.prismatic ? state.momentum.f.z : state.momentum.n.z;
        momentum[j] = momentum[j] + link.ratio * along + (link.ratio * link.ratio * link.armature) * qd[j];
        slope[j] = slope[j] + link.ratio * joint_slope(link, state);
        Vec3<V> f = state.momentum.f, n = state.momentum.n, first = state.first;
        to_parent(link, state.turn, f, n, first);
        Wrench<V>& below = link.parent < 0 ? whole.momentum : links[link.parent].momentum;
        Vec3<V>& first_below = link.parent < 0 ? whole.first : links[link.parent].first;
        below.f = below.f + f;
        below.n = below.n + n + cross(state.t, f);
        first_below = first_below + first + link.carried_mass * state.t;
    }
    return whole;
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
