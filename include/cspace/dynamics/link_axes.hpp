// From the axes of a link to those of its parent and back, without forming a rotation matrix.
//
// A turn about z of a matrix leaves the mean and the difference of its entries (½(xx + yy), ½(xy − yx)),
// turns (½(xx − yy), ½(xy + yx)) by twice the angle, and the third column and row by the angle. A quarter
// turn exchanges entries. Everything here is done in place.
#pragma once

#include "cspace/dynamics/multibody.hpp"
#include "cspace/math/trig.hpp"

namespace cspace::dynamics {
// The sine and cosine of an angle.
template <class S>
struct Turn {
    S s, c;
};
}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

// (x, y) turned by an angle.
template <class V, class S>
CSPACE_INLINE void turn_pair(V& x, V& y, const Turn<S>& by) {
    const V old = x;
    x = by.c * old - by.s * y;
    y = by.s * old + by.c * y;
}
template <class S>
CSPACE_INLINE Turn<S> double_turn(const Turn<S>& turn) {
    const S half = turn.s * turn.c;
    return {half + half, turn.c * turn.c - turn.s * turn.s};
}
template <class S>
CSPACE_INLINE Turn<S> reverse_turn(const Turn<S>& turn) {
    return {-turn.s, turn.c};
}
// The block (a b; b d) of a symmetric matrix, and the block (a b; c d) of any, turned: R A Rᵀ.
template <class V, class S>
CSPACE_INLINE void turn_block(V& a, V& b, V& d, const Turn<S>& by) {
    const V mean = 0.5 * (a + d);
    V half = 0.5 * (a - d);
    turn_pair(half, b, double_turn(by));
    a = mean + half;
    d = mean - half;
}
template <class V, class S>
CSPACE_INLINE void turn_block(V& a, V& b, V& c, V& d, const Turn<S>& by) {
    const V skew = 0.5 * (b - c);
    V shared = 0.5 * (b + c);
    turn_block(a, shared, d, by);
    b = shared + skew;
    c = shared - skew;
}

// About z.
template <class V, class S>
CSPACE_INLINE void turn_z(Vec3<V>& a, const Turn<S>& by) {
    turn_pair(a.x, a.y, by);
}
template <class V, class S>
CSPACE_INLINE void turn_z(Symmetric3<V>& A, const Turn<S>& by) {
    turn_block(A.xx, A.xy, A.yy, by);
    turn_pair(A.xz, A.yz, by);
}
template <class V, class S>
CSPACE_INLINE void turn_z(Mat3<V>& A, const Turn<S>& by) {
    auto& m = A.m;
    turn_block(m[0][0], m[0][1], m[1][0], m[1][1], by);
    turn_pair(m[0][2], m[1][2], by);
    turn_pair(m[2][0], m[2][1], by);
}
// About x.
template <class V, class S>
CSPACE_INLINE void turn_x(Vec3<V>& a, const Turn<S>& by) {
    turn_pair(a.y, a.z, by);
}
template <class V, class S>
CSPACE_INLINE void turn_x(Symmetric3<V>& A, const Turn<S>& by) {
    turn_block(A.yy, A.yz, A.zz, by);
    turn_pair(A.xy, A.xz, by);
}
template <class V, class S>
CSPACE_INLINE void turn_x(Mat3<V>& A, const Turn<S>& by) {
    auto& m = A.m;
    turn_block(m[1][1], m[1][2], m[2][1], m[2][2], by);
    turn_pair(m[0][1], m[0][2], by);
    turn_pair(m[1][0], m[2][0], by);
}
// About x by 90°, by −90° and by 180°.
template <class V>
CSPACE_INLINE void quarter_turn_x(Vec3<V>& a) {
    a = {a.x, -a.z, a.y};
}
template <class V>
CSPACE_INLINE void quarter_turn_x(Symmetric3<V>& A) {
    A = {A.xx, -A.xz, A.xy, A.zz, -A.yz, A.yy};
}
template <class V>
CSPACE_INLINE void quarter_turn_x(Mat3<V>& A) {
    const auto& m = A.m;
    A = {{{m[0][0], -m[0][2], m[0][1]}, {-m[2][0], m[2][2], -m[2][1]}, {m[1][0], -m[1][2], m[1][1]}}};
}
template <class V>
CSPACE_INLINE void quarter_turn_x_back(Vec3<V>& a) {
    a = {a.x, a.z, -a.y};
}
template <class V>
CSPACE_INLINE void half_turn_x(Vec3<V>& a) {
    a = {a.x, -a.y, -a.z};
}
template <class V>
CSPACE_INLINE void half_turn_x(Symmetric3<V>& A) {
    A = {A.xx, -A.xy, -A.xz, A.yy, A.yz, A.zz};
}
template <class V>
CSPACE_INLINE void half_turn_x(Mat3<V>& A) {
    const auto& m = A.m;
    A = {{{m[0][0], -m[0][1], -m[0][2]}, {-m[1][0], m[1][1], m[1][2]}, {-m[2][0], m[2][1], m[2][2]}}};
}

// Vectors from the axes of the parent into those of the link. turn: by the variable angle of the link.
template <class V, class... Vectors>
CSPACE_INLINE void to_link(const LinkOf<V>& link, const Turn<V>& turn, Vectors&... a) {
    if (link.turned) (turn_z(a, Turn<scalar_of<V>>{-link.sin_phi, link.cos_phi}), ...);
    switch (link.tilt) {
        case model::Tilt::none:
            break;
        case model::Tilt::quarter:
            (quarter_turn_x_back(a), ...);
            break;
        case model::Tilt::half:
            (half_turn_x(a), ...);
            break;
        case model::Tilt::any:
            (turn_x(a, Turn<scalar_of<V>>{-link.sin_alpha, link.cos_alpha}), ...);
    }
    (turn_z(a, reverse_turn(turn)), ...);
}
// Vectors and matrices from the axes of the link into those of the parent.
template <class V, class... Tensors>
CSPACE_INLINE void to_parent(const LinkOf<V>& link, const Turn<V>& turn, Tensors&... a) {
    (turn_z(a, turn), ...);
    switch (link.tilt) {
        case model::Tilt::none:
            break;
        case model::Tilt::quarter:
            (quarter_turn_x(a), ...);
            break;
        case model::Tilt::half:
            (half_turn_x(a), ...);
            break;
        case model::Tilt::any:
            (turn_x(a, Turn<scalar_of<V>>{link.sin_alpha, link.cos_alpha}), ...);
    }
    if (link.turned) (turn_z(a, Turn<scalar_of<V>>{link.sin_phi, link.cos_phi}), ...);
}

// The origin of the link in the axes of the parent, and the value by which its joint slides.
template <class V>
CSPACE_INLINE Vec3<V> link_origin(const LinkOf<V>& link, const V* q) {
    if (!link.prismatic) return fill_vec3<V>(link.t);
    const V value = link.slide * q[link.coordinate] + link.z;
    return {link.t.x + value * link.d.x, link.t.y + value * link.d.y, link.t.z + value * link.d.z};
}
// The turn of each link, into its state.
template <class V, class State>
CSPACE_INLINE void turn_links(const MultibodyOf<V>& bodies, const V* q, State* links) {
    const auto angle_of = [&](int k) {
        const LinkOf<V>& link = bodies.links[k];
        return link.turn * q[link.coordinate] + link.angle;
    };
    sincos_each<V>(bodies.n_links, angle_of, [&](int k, const V& s, const V& c) { links[k].turn = {s, c}; });
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
