// Rotation matrices from quaternions and rotation vectors, over a scalar or a pack of lanes.
#pragma once

#include "cspace/math/trig.hpp"
#include "cspace/math/vec.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::spatial::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE mask_of<V> safe_square(V square) {
    return square >= tolerance::least_square && square <= tolerance::largest_square;
}
// I + a [v] + b [v]²: a rotation where a² |v|² + (1 − b |v|²)² = 1.
template <class V>
CSPACE_INLINE Mat3<V> rotation_of(const Vec3<V>& v, V a, V b) {
    const Vec3<V> av = a * v, bv = b * v;
    const V xx = bv.x * v.x, yy = bv.y * v.y, zz = bv.z * v.z;
    const V xy = bv.x * v.y, xz = bv.x * v.z, yz = bv.y * v.z;
    return {{{1.0 - (yy + zz), xy - av.z, xz + av.y},
             {xy + av.z, 1.0 - (xx + zz), yz - av.x},
             {xz - av.y, yz + av.x, 1.0 - (xx + yy)}}};
}
// The rotation of the quaternion (w, v) of any length; square: w² + |v|².
template <class V>
CSPACE_INLINE Mat3<V> rotation_of_quaternion(V w, const Vec3<V>& v, V square) {
    const V scale = 2.0 / square;
    return rotation_of(v, scale * w, scale);
}
// exp [w] = I + (sin θ / θ) [w] + (2 sin²(θ/2) / θ²) [w]²; square: θ² = |w|². Where the
// square underflows both factors are those of zero, which is exact there (Murray, Li, Sastry 1994, eq. 2.14).
template <class V>
CSPACE_INLINE Mat3<V> rotation_of_rotvec(const Vec3<V>& w, V square) {
    const mask_of<V> tiny = square < tolerance::least_square;
    const V theta2 = select(tiny, fill<V>(1.0), square), theta = sqrt(theta2);
    V s, c;
    sincos(0.5 * theta, s, c);
    const V twice = 2.0 * s;
    return rotation_of(w, select(tiny, fill<V>(1.0), twice * c / theta),
                       select(tiny, fill<V>(0.5), twice * s / theta2));
}
// The rotation by an angle about an axis of any length; square: |axis|².
template <class V>
CSPACE_INLINE Mat3<V> rotation_of_axis_angle(const Vec3<V>& axis, V angle, V square) {
    V s, c;
    sincos(0.5 * angle, s, c);
    const V twice = 2.0 * s;
    return rotation_of(axis, twice * c / sqrt(square), twice * s / square);
}

}  // namespace cspace::spatial::inline CSPACE_ISA
