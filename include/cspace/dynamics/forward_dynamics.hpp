// Forward dynamics: the accelerations under given torques, by articulated bodies.
//
// From the tips on, each link with all that it carries answers an acceleration of its frame by a wrench that
// is linear in it, since the joints beyond give way. That inertia and the wrench at zero are handed down;
// then the accelerations follow from the base on (Featherstone 2008, section 7.3). As in inverse_dynamics.hpp
// the accelerations are those of points.
#pragma once

#include "cspace/dynamics/inverse_dynamics.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::dynamics {
// The wrench that a frame needs is (f, n) = (C a + Bᵀ α, B a + A α) + bias.
template <class V>
struct Articulated {
    Symmetric3<V> A, C;
    Mat3<V> B;
    Wrench<V> bias;
};
// What forward dynamics keeps of a link. c, cd: its linear and angular acceleration where those of its parent
// and of its joint are zero. U: the wrench per unit acceleration of the joint, and u: the force left to it.
template <class V>
struct LinkResponse {
    Turn<V> turn;
    Vec3<V> t, w, c, cd;
    Articulated<V> body;
    Wrench<V> U;
    V inverse_inertia, u;
    Motion<V> motion;
};
}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

template <class V>
inline constexpr scalar_of<V> singular_inertia =
    std::is_same_v<scalar_of<V>, float> ? tolerance::singular_inertia_of_floats : tolerance::singular_inertia;

// The response of a rigid body that turns at w.
template <class V>
CSPACE_INLINE Articulated<V> rigid_response(const MomentsOf<V>& body, const Vec3<V>& w) {
    const V zero = fill_lanes<V>(0.0), m = fill_lanes<V>(body.mass);
    const Vec3<V> h = fill_vec3<V>(body.first);
    const Symmetric3<scalar_of<V>>& S = body.second;
    const Mat3<V> K = acceleration_gradient(w, {zero, zero, zero});
    return {fill_symmetric<V>(
                Symmetric3<scalar_of<V>>{S.yy + S.zz, -S.xy, -S.xz, S.xx + S.zz, -S.yz, S.xx + S.yy}),
            {m, zero, zero, m, zero, m},
            {{{zero, -h.z, h.y}, {h.z, zero, -h.x}, {-h.y, h.x, zero}}},
            {K * h, torque_of_gradient(K, S)}};
}
template <class V>
CSPACE_INLINE void add_response(Articulated<V>& to, const Articulated<V>& more) {
    to.A = to.A + more.A;
    to.C = to.C + more.C;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) to.B.m[i][j] = to.B.m[i][j] + more.B.m[i][j];
    to.bias = {to.bias.f + more.bias.f, to.bias.n + more.bias.n};
}
// The wrench behind an acceleration, without the bias.
template <class V>
CSPACE_INLINE Wrench<V> inertial_wrench(const Articulated<V>& body, const Vec3<V>& a, const Vec3<V>& wd) {
    return {body.C * a + transpose_times(body.B, wd), body.B * a + body.A * wd};
}
// a − s b bᵀ and, of a matrix with rows of u and columns of v, B − s u vᵀ.
template <class V>
CSPACE_INLINE void subtract_square(Symmetric3<V>& A, const Vec3<V>& b, const Vec3<V>& scaled) {
    A = {A.xx - scaled.x * b.x, A.xy - scaled.x * b.y, A.xz - scaled.x * b.z,
         A.yy - scaled.y * b.y, A.yz - scaled.y * b.z, A.zz - scaled.z * b.z};
}
template <class V>
CSPACE_INLINE void subtract_product(Mat3<V>& B, const Vec3<V>& u, const Vec3<V>& v) {
    const V rows[3] = {u.x, u.y, u.z};
    for (int i = 0; i < 3; ++i) {
        B.m[i][0] = B.m[i][0] - rows[i] * v.x;
        B.m[i][1] = B.m[i][1] - rows[i] * v.y;
        B.m[i][2] = B.m[i][2] - rows[i] * v.z;
    }
}
// A response about the point from which the old one is at t: B' = B + [t]× C, A' = A + [t]× Bᵀ − B' [t]×.
template <class V>
CSPACE_INLINE void shift_response(Articulated<V>& body, const Vec3<V>& t) {
    const Mat3<V> C = to_matrix(body.C), old = body.B;
    Mat3<V>& B = body.B;
    for (int j = 0; j < 3; ++j) {
        const Vec3<V> c = cross(t, matrix_column(C, j));
        B.m[0][j] = B.m[0][j] + c.x;
        B.m[1][j] = B.m[1][j] + c.y;
        B.m[2][j] = B.m[2][j] + c.z;
    }
    // Row i of B' [t]× is row i of B' crossed with t; column j of [t]× Bᵀ is t crossed with row j of B.
    const Vec3<V> x = cross(t, matrix_row(old, 0)), y = cross(t, matrix_row(old, 1)),
                  z = cross(t, matrix_row(old, 2));
    const Vec3<V> u = cross(matrix_row(B, 0), t), v = cross(matrix_row(B, 1), t),
                  w = cross(matrix_row(B, 2), t);
    body.A = body.A + Symmetric3<V>{x.x - u.x, y.x - u.y, z.x - u.z, y.y - v.y, z.y - v.z, z.z - w.z};
    body.bias.n = body.bias.n + cross(t, body.bias.f);
}

// What the parent of a link feels, in the frame of the link, since its joint gives way to the force tau.
// Fills U, the inertia and u. regular: becomes false where the joint moves no inertia.
template <class V>
CSPACE_INLINE Articulated<V> give_way(const LinkOf<V>& link, LinkResponse<V>& state, V tau,
                                      mask_of<V>& regular) {
    const Articulated<V>& body = state.body;
    const Vec3<V> last_of_B = link.prismatic ? matrix_column(body.B, 2) : matrix_row(body.B, 2);
    if (link.prismatic)
        state.U = {{body.C.xz, body.C.yz, body.C.zz}, last_of_B};
    else
        state.U = {last_of_B, {body.A.xz, body.A.yz, body.A.zz}};
    const V inertia = (link.prismatic ? state.U.f.z : state.U.n.z) + link.armature;
    const Symmetric3<V>& resists = link.prismatic ? body.C : body.A;
    regular = regular && inertia > singular_inertia<V> * (resists.xx + resists.yy + resists.zz);
    state.inverse_inertia = 1.0 / inertia;
    state.u = tau - (link.prismatic ? body.bias.f.z : body.bias.n.z);
    const Vec3<V> f = state.inverse_inertia * state.U.f, n = state.inverse_inertia * state.U.n;
    Articulated<V> left = body;
    subtract_square(left.A, state.U.n, n);
    subtract_square(left.C, state.U.f, f);
    subtract_product(left.B, state.U.n, f);
    const Wrench<V> moved = inertial_wrench(left, state.c, state.cd);
    left.bias.f = left.bias.f + moved.f + state.u * f;
    left.bias.n = left.bias.n + moved.n + state.u * n;
    return left;
}

// The first half: what the base feels of all links, where it turns at w in its axes. tau (n_coordinates,),
// applied: see applied_wrenches.hpp.
// Every coordinate must move one joint. regular: false in the lanes where a joint moves no inertia.
template <class V>
CSPACE_INLINE Articulated<V> articulate_bodies(const MultibodyOf<V>& bodies, const Vec3<V>& base_w,
                                               const V* q, const V* qd, const V* tau, bool rubs,
                                               LinkResponse<V>* links, mask_of<V>& regular,
                                               const AppliedWrenches<V>& applied = {}) {
    const V zero = fill_lanes<V>(0.0);
    regular = zero == 0.0;
    turn_links(bodies, q, links);
    for (int k = 0; k < bodies.n_links; ++k) {
        const LinkOf<V>& link = bodies.links[k];
        LinkResponse<V>& state = links[k];
        const Vec3<V>& before = link.parent < 0 ? base_w : links[link.parent].w;
        const V rate = link.ratio * qd[link.coordinate];
        state.t = link_origin(link, q);
        state.w = before;
        state.c = dot(before, state.t) * before - dot(before, before) * state.t;
        to_link(link, state.turn, state.w, state.c);
        const Vec3<V> turned = {state.w.y * rate, -(state.w.x * rate), zero};
        state.cd = link.prismatic ? Vec3<V>{zero, zero, zero} : turned;
        if (link.prismatic)
            state.c = state.c + 2.0 * turned;
        else
            state.w.z = state.w.z + rate;
        state.body = rigid_response(link.body, state.w);
    }
    apply_wrenches(bodies, applied, links,
                   [](LinkResponse<V>& state) -> Wrench<V>& { return state.body.bias; });
    Articulated<V> base = rigid_response(bodies.base, base_w);
    apply_to_base(applied, base.bias);
    for (int k = bodies.n_links - 1; k >= 0; --k) {
        const LinkOf<V>& link = bodies.links[k];
        LinkResponse<V>& state = links[k];
        // At the joint itself forces are those at the coordinate divided by the ratio.
        const int j = link.coordinate;
        const V force = (1.0 / link.ratio) * (tau[j] - joint_resistance(link, qd[j], zero, rubs));
        Articulated<V> left = give_way(link, state, force, regular);
        to_parent(link, state.turn, left.A, left.B, left.C, left.bias.f, left.bias.n);
        shift_response(left, state.t);
        add_response(link.parent < 0 ? base : links[link.parent].body, left);
    }
    return base;
}

// The second half: qdd (n_coordinates,) from the acceleration of the base, less gravity, in its axes.
template <class V>
CSPACE_INLINE void find_accelerations(const MultibodyOf<V>& bodies, const Vec3<V>& base_a,
                                      const Vec3<V>& base_wd, LinkResponse<V>* links, V* qdd) {
    for (int k = 0; k < bodies.n_links; ++k) {
        const LinkOf<V>& link = bodies.links[k];
        LinkResponse<V>& state = links[k];
        Vec3<V> wd = link.parent < 0 ? base_wd : links[link.parent].motion.wd;
        Vec3<V> a = (link.parent < 0 ? base_a : links[link.parent].motion.a) + cross(wd, state.t);
        to_link(link, state.turn, wd, a);
        wd = wd + state.cd;
        a = a + state.c;
        const V rate = state.inverse_inertia * (state.u - dot(state.U.f, a) - dot(state.U.n, wd));
        if (link.prismatic)
            a.z = a.z + rate;
        else
            wd.z = wd.z + rate;
        state.motion.a = a;
        state.motion.wd = wd;
        qdd[link.coordinate] = (1.0 / link.ratio) * rate;
    }
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
