// Vectors, rotations and poses over a scalar V (a double or a pack of lanes). Row-major, no member functions.
#pragma once

#include "cspace/math/lanes.hpp"

namespace cspace {

template <class V>
struct Vec3 {
    V x, y, z;
};
template <class V>
struct Mat3 {
    V m[3][3];
};
// A displacement p ↦ R p + t; named T_a_b where it maps coordinates in frame b to coordinates in frame a.
template <class V>
struct Pose {
    Mat3<V> R;
    Vec3<V> t;
};

using Vec3d = Vec3<double>;
using Mat3d = Mat3<double>;
using Posed = Pose<double>;

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE Vec3<V> operator+(const Vec3<V>& a, const Vec3<V>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
CSPACE_INLINE Vec3<V> operator-(const Vec3<V>& a, const Vec3<V>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
CSPACE_INLINE Vec3<V> operator-(const Vec3<V>& a) {
    return {-a.x, -a.y, -a.z};
}
template <class V, class S>
CSPACE_INLINE Vec3<V> operator*(const S& s, const Vec3<V>& a) {
    return {s * a.x, s * a.y, s * a.z};
}
template <class V>
CSPACE_INLINE V dot(const Vec3<V>& a, const Vec3<V>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
CSPACE_INLINE Vec3<V> cross(const Vec3<V>& a, const Vec3<V>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class V>
CSPACE_INLINE V norm(const Vec3<V>& a) {
    return sqrt(dot(a, a));
}
template <class V>
CSPACE_INLINE Vec3<V> matrix_column(const Mat3<V>& R, int j) {
    return {R.m[0][j], R.m[1][j], R.m[2][j]};
}
template <class V>
CSPACE_INLINE Vec3<V> matrix_row(const Mat3<V>& R, int i) {
    return {R.m[i][0], R.m[i][1], R.m[i][2]};
}
template <class V>
CSPACE_INLINE Mat3<V> from_columns(const Vec3<V>& x, const Vec3<V>& y, const Vec3<V>& z) {
    return {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
}
template <class V>
CSPACE_INLINE Vec3<V> operator*(const Mat3<V>& R, const Vec3<V>& a) {
    return {dot(matrix_row(R, 0), a), dot(matrix_row(R, 1), a), dot(matrix_row(R, 2), a)};
}
template <class V>
CSPACE_INLINE Mat3<V> operator*(const Mat3<V>& A, const Mat3<V>& B) {
    return from_columns(A * matrix_column(B, 0), A * matrix_column(B, 1), A * matrix_column(B, 2));
}
template <class V>
CSPACE_INLINE Mat3<V> transpose(const Mat3<V>& R) {
    return from_columns(matrix_row(R, 0), matrix_row(R, 1), matrix_row(R, 2));
}
// Rᵀ a without forming the transpose.
template <class V>
CSPACE_INLINE Vec3<V> transpose_times(const Mat3<V>& R, const Vec3<V>& a) {
    return {dot(matrix_column(R, 0), a), dot(matrix_column(R, 1), a), dot(matrix_column(R, 2), a)};
}
template <class V>
CSPACE_INLINE Pose<V> operator*(const Pose<V>& A, const Pose<V>& B) {
    return {A.R * B.R, A.R * B.t + A.t};
}
template <class V>
CSPACE_INLINE Vec3<V> operator*(const Pose<V>& T, const Vec3<V>& p) {
    return T.R * p + T.t;
}
template <class V>
CSPACE_INLINE Pose<V> inverse(const Pose<V>& T) {
    return {transpose(T.R), -transpose_times(T.R, T.t)};
}
template <class V, class S>
CSPACE_INLINE Vec3<V> fill_vec3(const Vec3<S>& a) {
    return {fill_lanes<V>(a.x), fill_lanes<V>(a.y), fill_lanes<V>(a.z)};
}
template <class V, class S>
CSPACE_INLINE Mat3<V> fill_mat3(const Mat3<S>& R) {
    return from_columns(fill_vec3<V>(matrix_column(R, 0)), fill_vec3<V>(matrix_column(R, 1)),
                        fill_vec3<V>(matrix_column(R, 2)));
}
template <class V>
CSPACE_INLINE Pose<V> fill_pose(const Pose<double>& T) {
    return {fill_mat3<V>(T.R), fill_vec3<V>(T.t)};
}
CSPACE_INLINE Posed identity_pose() { return {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}}; }
template <class V>
CSPACE_INLINE void set_pose_lane(Pose<V>& to, int l, const Posed& from) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) set_lane(to.R.m[i][j], l, from.R.m[i][j]);
    set_lane(to.t.x, l, from.t.x);
    set_lane(to.t.y, l, from.t.y);
    set_lane(to.t.z, l, from.t.z);
}
// A unit vector square to the unit vector h.
inline Vec3d any_perpendicular(const Vec3d& h) {
    const Vec3d other = abs(h.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    const Vec3d n = cross(h, other);
    return (1 / norm(n)) * n;
}
// A rotation whose third column is the unit vector z.
inline Mat3d frame_along(const Vec3d& z) {
    const Vec3d x = any_perpendicular(z);
    return from_columns(x, cross(z, x), z);
}

}  // namespace cspace::inline CSPACE_ISA
