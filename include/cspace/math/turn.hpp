// An angle kept as its cosine and sine: exact to compose, free of branch cuts, cheap on lanes.
#pragma once

#include "cspace/math/trig.hpp"
#include "cspace/math/vec.hpp"

namespace cspace {

template <class V>
struct Turn {
    V c, s;
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE Turn<V> no_turn() {
    return {fill_lanes<V>(1.0), fill_lanes<V>(0.0)};
}
template <class V>
CSPACE_INLINE Turn<V> turn_by(V angle) {
    Turn<V> t;
    sincos(angle, t.s, t.c);
    return t;
}
// The angle in (−π, π].
template <class V>
CSPACE_INLINE V angle_of(const Turn<V>& t) {
    const V a = atan2(t.s, t.c);
    return select_lanes(a <= -pi, fill_lanes<V>(pi), a);
}
template <class V>
CSPACE_INLINE Turn<V> operator+(const Turn<V>& a, const Turn<V>& b) {
    return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s};
}
template <class V>
CSPACE_INLINE Turn<V> operator-(const Turn<V>& a, const Turn<V>& b) {
    return {a.c * b.c + a.s * b.s, a.s * b.c - a.c * b.s};
}
template <class V>
CSPACE_INLINE Turn<V> select_lanes(mask_of<V> m, const Turn<V>& yes, const Turn<V>& no) {
    return {select_lanes(m, yes.c, no.c), select_lanes(m, yes.s, no.s)};
}
template <class V>
CSPACE_INLINE Vec3<V> select_lanes(mask_of<V> m, const Vec3<V>& yes, const Vec3<V>& no) {
    return {select_lanes(m, yes.x, no.x), select_lanes(m, yes.y, no.y), select_lanes(m, yes.z, no.z)};
}
// Rot(k, θ) p about the unit axis k through the origin (Rodrigues 1840).
template <class V>
CSPACE_INLINE Vec3<V> rotate_about(const Vec3<V>& k, const Turn<V>& t, const Vec3<V>& p) {
    const Vec3<V> kp = cross(k, p);
    return p + t.s * kp + (1.0 - t.c) * cross(k, kp);
}

}  // namespace cspace::inline CSPACE_ISA
