// The links of a robot seen from one point, the origin of its base, in the axes of the world.
//
// There velocities, momenta and inertias of all that a joint moves simply add up. A motion (v; ω) has the
// velocity of the point of the body that passes the origin. Featherstone 2008, chapter 2.
#pragma once

#include "cspace/dynamics/mass_matrix.hpp"
#include "cspace/kinematics/jacobian.hpp"

namespace cspace::dynamics {
using kinematics::Twist;

// Sums over bodies: first and second moments, momentum, gyration (see gyration_of), and the wrench that moves
// them.
template <class V>
struct SpatialBody {
    Vec3<V> first;
    Symmetric3<V> second;
    Wrench<V> momentum;
    Mat3<V> gyration;
    Wrench<V> wrench;
};
template <class V>
struct SpatialLink {
    Turn<V> turn;
    kinematics::FrameAxes<V> frame;
    Twist<V> axis, axis_rate;  // the motion per unit velocity of the joint, and its time derivative
    Twist<V> axis_bend;        // what of the second time derivative a change of the joint itself brings about
    Twist<V> motion, change;   // of the link, and its time derivative less gravity
    SpatialBody<V> all;        // that the joint moves
};
}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

// The change of a motion b that moves along with a, a × b.
template <class V>
CSPACE_INLINE Twist<V> cross_motion(const Twist<V>& a, const Twist<V>& b) {
    return {cross(a.w, b.v) + cross(a.v, b.w), cross(a.w, b.w)};
}
template <class V>
CSPACE_INLINE V find_power(const Twist<V>& motion, const Wrench<V>& wrench) {
    return dot(motion.v, wrench.f) + dot(motion.w, wrench.n);
}
template <class V>
CSPACE_INLINE Twist<V> operator+(const Twist<V>& a, const Twist<V>& b) {
    return {a.v + b.v, a.w + b.w};
}
template <class V>
CSPACE_INLINE Wrench<V> operator+(const Wrench<V>& a, const Wrench<V>& b) {
    return {a.f + b.f, a.n + b.n};
}
template <class V, class S>
CSPACE_INLINE Twist<V> scale_vector(const S& s, const Twist<V>& a) {
    return {s * a.v, s * a.w};
}
template <class V>
CSPACE_INLINE Wrench<V> cross_wrench(const Twist<V>& a, const Wrench<V>& b) {
    return {cross(a.w, b.f), cross(a.v, b.f) + cross(a.w, b.n)};
}
template <class V, class S>
CSPACE_INLINE Wrench<V> scale_vector(const S& s, const Wrench<V>& a) {
    return {s * a.f, s * a.n};
}

// The momentum of a body that moves so: I (v; ω).
template <class V, class M>
CSPACE_INLINE Wrench<V> momentum_of(const M& mass, const Vec3<V>& first, const Symmetric3<V>& second,
                                    const Twist<V>& motion) {
    const V trace = second.xx + second.yy + second.zz;
    return {mass * motion.v + cross(motion.w, first),
            cross(first, motion.v) + trace * motion.w - second * motion.w};
}

// [ω]× S + [h]× [v]×. With the momentum l it makes the matrix B = (0, −[l]×; 0, −gyration) of Echeandia and
// Wensing (2021), which is linear in the velocity.
template <class V>
CSPACE_INLINE Mat3<V> gyration_of(const Vec3<V>& first, const Symmetric3<V>& second, const Twist<V>& motion) {
    const Mat3<V> S = to_matrix(second);
    const Vec3<V>&h = first, &v = motion.v;
    const V hv = dot(h, v);
    Mat3<V> P = from_columns(cross(motion.w, matrix_column(S, 0)), cross(motion.w, matrix_column(S, 1)),
                             cross(motion.w, matrix_column(S, 2)));
    const V a[3] = {v.x, v.y, v.z}, b[3] = {h.x, h.y, h.z};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) P.m[i][j] = P.m[i][j] + a[i] * b[j];
    for (int i = 0; i < 3; ++i) P.m[i][i] = P.m[i][i] - hv;
    return P;
}
// B m, and Bᵀ m, whose force is zero.
template <class V>
CSPACE_INLINE Wrench<V> velocity_product(const SpatialBody<V>& body, const Twist<V>& m) {
    return {cross(m.w, body.momentum.f), -(body.gyration * m.w)};
}
template <class V>
CSPACE_INLINE Vec3<V> transposed_velocity_product(const SpatialBody<V>& body, const Twist<V>& m) {
    return cross(body.momentum.f, m.v) - transpose_times(body.gyration, m.w);
}
template <class V, class M>
CSPACE_INLINE Wrench<V> momentum_of(const M& mass, const SpatialBody<V>& body, const Twist<V>& motion) {
    return momentum_of(mass, body.first, body.second, motion);
}

// Turns a frame about its own z, then x, then z, from that of the parent to that of the link.
template <class V>
CSPACE_INLINE void turn_frame(const Link& link, const Turn<V>& turn, kinematics::FrameAxes<V>& frame) {
    if (link.turned) kinematics::turn_about_z(frame, link.sin_phi, link.cos_phi);
    kinematics::tilt_frame(frame, link);
    kinematics::turn_about_z(frame, turn.s, turn.c);
}

// The moments of a body in the axes of the world, about the origin of the base.
template <class V>
CSPACE_INLINE void place_moments(const Moments<double>& body, const kinematics::FrameAxes<V>& frame,
                                 Vec3<V>& first, Symmetric3<V>& second) {
    const Mat3<V> R = from_columns(frame.x, frame.y, frame.z);
    const Mat3<V> turned = R * fill_mat3<V>(to_matrix(body.second));
    const Vec3<V> x = matrix_row(turned, 0), y = matrix_row(turned, 1), z = matrix_row(turned, 2);
    const Vec3<V> r0 = matrix_row(R, 0), r1 = matrix_row(R, 1), r2 = matrix_row(R, 2);
    second = {dot(x, r0), dot(x, r1), dot(x, r2), dot(y, r1), dot(y, r2), dot(z, r2)};
    first = R * fill_vec3<V>(body.first);
    shift_moments(body.mass, first, second, frame.origin);
}

// One body: its sums where it moves so. change: the time derivative of its motion, or null.
template <class V>
CSPACE_INLINE SpatialBody<V> place_body(const Moments<double>& body, const kinematics::FrameAxes<V>& frame,
                                        const Twist<V>& motion, const Twist<V>* change) {
    SpatialBody<V> placed;
    place_moments(body, frame, placed.first, placed.second);
    placed.momentum = momentum_of(body.mass, placed.first, placed.second, motion);
    placed.gyration = gyration_of(placed.first, placed.second, motion);
    if (change)
        placed.wrench = momentum_of(body.mass, placed.first, placed.second, *change) +
                        cross_wrench(motion, placed.momentum);
    return placed;
}
template <class V>
CSPACE_INLINE void add_body(SpatialBody<V>& to, const SpatialBody<V>& more, bool accelerated) {
    to.first = to.first + more.first;
    to.second = to.second + more.second;
    to.momentum = to.momentum + more.momentum;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) to.gyration.m[i][j] = to.gyration.m[i][j] + more.gyration.m[i][j];
    if (accelerated) to.wrench = to.wrench + more.wrench;
}

// Places all links and sums what their joints move; the whole robot with its base is returned. R: the axes of
// the base; base: its motion, change: the time derivative of that less gravity, or null, which leaves the
// wrenches out. qd, qdd: null for zero.
template <class V>
CSPACE_INLINE SpatialBody<V> place_links(const Multibody& bodies, const Mat3<V>& R, const Twist<V>& base,
                                         const Twist<V>* change, const V* q, const V* qd, const V* qdd,
                                         SpatialLink<V>* links) {
    const V zero = fill_lanes<V>(0.0);
    const Vec3<V> none = {zero, zero, zero};
    turn_links(bodies, q, links);
    const kinematics::FrameAxes<V> root = {matrix_column(R, 0), matrix_column(R, 1), matrix_column(R, 2),
                                           none};
    for (int k = 0; k < bodies.n_links; ++k) {
        const Link& link = bodies.links[k];
        SpatialLink<V>& state = links[k];
        const SpatialLink<V>* parent = link.parent < 0 ? nullptr : &links[link.parent];
        const kinematics::FrameAxes<V>& before = parent ? parent->frame : root;
        const Twist<V>& carried = parent ? parent->motion : base;
        const Vec3<V> t = link_origin(link, q);
        state.frame = before;
        state.frame.origin = before.origin + t.x * before.x + t.y * before.y + t.z * before.z;
        turn_frame(link, state.turn, state.frame);
        const Vec3<V>& z = state.frame.z;
        const V rate = qd ? link.ratio * qd[link.coordinate] : zero;
        state.axis = link.prismatic ? Twist<V>{z, none} : Twist<V>{cross(state.frame.origin, z), z};
        state.axis_rate = cross_motion(carried, state.axis);
        state.motion = carried + scale_vector(rate, state.axis);
        if (change) {
            const V growth = qdd ? link.ratio * qdd[link.coordinate] : zero;
            const Twist<V>& changed = parent ? parent->change : *change;
            state.axis_bend = cross_motion(changed, state.axis) + cross_motion(carried, state.axis_rate);
            state.change = changed + scale_vector(growth, state.axis) + scale_vector(rate, state.axis_rate);
        }
        state.all = place_body(link.body, state.frame, state.motion, change ? &state.change : nullptr);
    }
    SpatialBody<V> whole = place_body(bodies.base, root, base, change);
    for (int k = bodies.n_links - 1; k >= 0; --k) {
        const int parent = bodies.links[k].parent;
        add_body(parent < 0 ? whole : links[parent].all, links[k].all, change != nullptr);
    }
    return whole;
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
