// The regressor Y of inverse dynamics: tau = Y π, with the mass, first moments and inertia of every body in
// π.
//
// The wrench that moves a body is linear in its ten parameters. What a joint feels of it is its power in a
// unit motion of the joint, all seen from the body (Atkeson, An and Hollerbach 1986).
#pragma once

#include "cspace/dynamics/spatial_links.hpp"

namespace cspace::dynamics {
// A frame in the axes of the world: how it stands, how it turns, and the acceleration of its origin less
// gravity.
template <class V>
struct MovingFrame {
    Turn<V> turn;
    kinematics::FrameAxes<V> frame;
    Motion<V> motion;
};
// A body with parameters: how it moves in its own axes.
template <class V>
struct MovingBody {
    Mat3<V> R;  // its axes in those of the world
    Vec3<V> origin;
    Motion<V> motion;
    Mat3<V> K;
};
}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

// A frame with the axes of another, further by d in the axes of the world.
template <class V>
CSPACE_INLINE Vec3<V> acceleration_at(const Motion<V>& motion, const Vec3<V>& d) {
    return motion.a + cross(motion.wd, d) + cross(motion.w, cross(motion.w, d));
}

// The frames of all links; root: that of the base.
template <class V>
CSPACE_INLINE void move_frames(const Multibody& bodies, const MovingFrame<V>& root, const V* q, const V* qd,
                               const V* qdd, MovingFrame<V>* links) {
    turn_links(bodies, q, links);
    for (int k = 0; k < bodies.n_links; ++k) {
        const Link& link = bodies.links[k];
        MovingFrame<V>& state = links[k];
        const MovingFrame<V>& before = link.parent < 0 ? root : links[link.parent];
        const Vec3<V> t = link_origin(link, q);
        const Vec3<V> d = t.x * before.frame.x + t.y * before.frame.y + t.z * before.frame.z;
        state.frame = before.frame;
        state.frame.origin = before.frame.origin + d;
        turn_frame(link, state.turn, state.frame);
        const Vec3<V>& z = state.frame.z;
        const V rate = link.ratio * qd[link.coordinate], push = link.ratio * qdd[link.coordinate];
        const Vec3<V> bend = cross(before.motion.w, z);
        state.motion = {before.motion.w, before.motion.wd, acceleration_at(before.motion, d)};
        if (link.prismatic) {
            state.motion.a = state.motion.a + push * z + 2.0 * rate * bend;
        } else {
            state.motion.w = state.motion.w + rate * z;
            state.motion.wd = state.motion.wd + push * z + rate * bend;
        }
    }
}

// The body whose parameters are in `frame`, of the axes of its link.
template <class V>
CSPACE_INLINE MovingBody<V> move_body(const MovingFrame<V>& link, const Posed& frame) {
    const Mat3<V> axes = from_columns(link.frame.x, link.frame.y, link.frame.z);
    const Vec3<V> d = axes * fill_vec3<V>(frame.t);
    MovingBody<V> body;
    body.R = axes * fill_mat3<V>(frame.R);
    body.origin = link.frame.origin + d;
    body.motion = {transpose_times(body.R, link.motion.w), transpose_times(body.R, link.motion.wd),
                   transpose_times(body.R, acceleration_at(link.motion, d))};
    body.K = acceleration_gradient(body.motion.w, body.motion.wd);
    return body;
}

// Adds to `powers` the power of the wrench behind the motion of the body, per unit of each parameter, in a
// motion of the body whose origin moves at v and which turns at w, in the axes of the world.
template <class V>
CSPACE_INLINE void add_powers(const MovingBody<V>& body, const Vec3<V>& v, const Vec3<V>& w, V* powers) {
    const Vec3<V> u = transpose_times(body.R, v), z = transpose_times(body.R, w);
    const Vec3<V>&a = body.motion.a, &wd = body.motion.wd, &turning = body.motion.w;
    const Vec3<V> first = transpose_times(body.K, u) + cross(a, z), across = cross(z, turning);
    const V values[body_parameters] = {dot(u, a),
                                       first.x,
                                       first.y,
                                       first.z,
                                       z.x * wd.x + across.x * turning.x,
                                       z.x * wd.y + z.y * wd.x + across.x * turning.y + across.y * turning.x,
                                       z.x * wd.z + z.z * wd.x + across.x * turning.z + across.z * turning.x,
                                       z.y * wd.y + across.y * turning.y,
                                       z.y * wd.z + z.z * wd.y + across.y * turning.z + across.z * turning.y,
                                       z.z * wd.z + across.z * turning.z};
    for (int i = 0; i < body_parameters; ++i) powers[i] = powers[i] + values[i];
}
// The same for a unit of the coordinate that moves a joint.
template <class V>
CSPACE_INLINE void add_joint_powers(const MovingBody<V>& body, const Link& link,
                                    const kinematics::FrameAxes<V>& joint, V* powers) {
    const V zero = fill_lanes<V>(0.0);
    const Vec3<V> axis = link.ratio * joint.z;
    if (link.prismatic)
        add_powers(body, axis, {zero, zero, zero}, powers);
    else
        add_powers(body, cross(axis, body.origin - joint.origin), axis, powers);
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
