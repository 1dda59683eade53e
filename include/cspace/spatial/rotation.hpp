// Rotation matrices from quaternions, axes and rotation vectors, and the logarithm, over a scalar or a pack
// of lanes.
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
// The rotation about a unit axis by the angle with cosine c and sine s (Rodrigues 1840).
template <class V>
CSPACE_INLINE Mat3<V> rotation_about(const Vec3<V>& axis, V c, V s) {
    return rotation_of(axis, s, 1.0 - c);
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
    const V theta2 = select_lanes(tiny, fill_lanes<V>(1.0), square), theta = sqrt(theta2);
    V s, c;
    sincos(0.5 * theta, s, c);
    const V twice = 2.0 * s;
    return rotation_of(w, select_lanes(tiny, fill_lanes<V>(1.0), twice * c / theta),
                       select_lanes(tiny, fill_lanes<V>(0.5), twice * s / theta2));
}
template <class V>
CSPACE_INLINE Mat3<V> rotation_of_rotvec(const Vec3<V>& w) {
    return rotation_of_rotvec(w, dot(w, w));
}
// The rotation by an angle about an axis of any length; square: |axis|².
template <class V>
CSPACE_INLINE Mat3<V> rotation_of_axis_angle(const Vec3<V>& axis, V angle, V square) {
    V s, c;
    sincos(0.5 * angle, s, c);
    const V twice = 2.0 * s;
    return rotation_of(axis, twice * c / sqrt(square), twice * s / square);
}

// (sin θ) times the unit axis of R.
template <class V>
CSPACE_INLINE Vec3<V> sine_of(const Mat3<V>& R) {
    return {0.5 * (R.m[2][1] - R.m[1][2]), 0.5 * (R.m[0][2] - R.m[2][0]), 0.5 * (R.m[1][0] - R.m[0][1])};
}
// The same of B Aᵀ, from the cross products of the axes: to first order the rotation vector from A to B.
template <class V>
CSPACE_INLINE Vec3<V> sine_between(const Mat3<V>& A, const Mat3<V>& B) {
    Vec3<V> sum = 0.5 * cross(matrix_column(A, 0), matrix_column(B, 0));
    for (int k = 1; k < 3; ++k) sum = sum + 0.5 * cross(matrix_column(A, k), matrix_column(B, k));
    return sum;
}
// The trace of B Aᵀ, 1 + 2 cos θ: 3 where they agree, −1 half a turn apart.
template <class V>
CSPACE_INLINE V trace_between(const Mat3<V>& A, const Mat3<V>& B) {
    return dot(matrix_column(A, 0), matrix_column(B, 0)) + dot(matrix_column(A, 1), matrix_column(B, 1)) +
           dot(matrix_column(A, 2), matrix_column(B, 2));
}
// The angle θ of B Aᵀ, in [0, π].
template <class V>
CSPACE_INLINE V angle_between(const Mat3<V>& A, const Mat3<V>& B) {
    return atan2(norm(sine_between(A, B)), 0.5 * (trace_between(A, B) - 1.0));
}
// The rotation vector of R, rotations by π included.
template <class V>
CSPACE_INLINE Vec3<V> rotvec_of_rotation(const Mat3<V>& R) {
    constexpr double small = 1e-12;     // sine up to which it equals its angle
    constexpr double half_turn = 1e-6;  // sine that has lost the axis, next to a half turn
    Vec3<V> w = sine_of(R);
    const V s = norm(w), c = 0.5 * (R.m[0][0] + R.m[1][1] + R.m[2][2] - 1.0);
    const V angle = atan2(s, c);
    const V scale =
        select_lanes(s > small, angle / select_lanes(s > small, s, fill_lanes<V>(1.0)), fill_lanes<V>(1.0));
    w = scale * w;
    const mask_of<V> half = (s <= half_turn) && (c < 0.0);
    if (!any(half)) return w;
    // Near a half turn the axis is the largest column of R + I.
    Vec3<V> axis = matrix_column(R, 0);
    axis.x = axis.x + 1.0;
    V largest = R.m[0][0];
    for (int k = 1; k < 3; ++k) {
        Vec3<V> other = matrix_column(R, k);
        (k == 1 ? other.y : other.z) = (k == 1 ? other.y : other.z) + 1.0;
        const mask_of<V> better = R.m[k][k] > largest;
        largest = select_lanes(better, R.m[k][k], largest);
        axis = {select_lanes(better, other.x, axis.x), select_lanes(better, other.y, axis.y),
                select_lanes(better, other.z, axis.z)};
    }
    axis = (angle / norm(axis)) * axis;
    return {select_lanes(half, axis.x, w.x), select_lanes(half, axis.y, w.y),
            select_lanes(half, axis.z, w.z)};
}

}  // namespace cspace::spatial::inline CSPACE_ISA
