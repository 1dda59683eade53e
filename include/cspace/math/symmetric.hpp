// Symmetric matrices of three rows by their six numbers, such as tensors of inertia.
#pragma once

#include "cspace/math/vec.hpp"

namespace cspace {

template <class V>
struct Symmetric3 {
    V xx, xy, xz, yy, yz, zz;
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE Vec3<V> operator*(const Symmetric3<V>& S, const Vec3<V>& a) {
    return {S.xx * a.x + S.xy * a.y + S.xz * a.z, S.xy * a.x + S.yy * a.y + S.yz * a.z,
            S.xz * a.x + S.yz * a.y + S.zz * a.z};
}
template <class V>
CSPACE_INLINE Symmetric3<V> operator+(const Symmetric3<V>& A, const Symmetric3<V>& B) {
    return {A.xx + B.xx, A.xy + B.xy, A.xz + B.xz, A.yy + B.yy, A.yz + B.yz, A.zz + B.zz};
}
template <class V, class S>
CSPACE_INLINE Symmetric3<V> fill_symmetric(const Symmetric3<S>& A) {
    return {fill_lanes<V>(A.xx), fill_lanes<V>(A.xy), fill_lanes<V>(A.xz),
            fill_lanes<V>(A.yy), fill_lanes<V>(A.yz), fill_lanes<V>(A.zz)};
}
// The symmetric part of a matrix that is symmetric but for rounding: its upper triangle.
template <class V>
CSPACE_INLINE Symmetric3<V> upper_triangle(const Mat3<V>& A) {
    return {A.m[0][0], A.m[0][1], A.m[0][2], A.m[1][1], A.m[1][2], A.m[2][2]};
}
template <class V>
CSPACE_INLINE Mat3<V> to_matrix(const Symmetric3<V>& S) {
    return {{{S.xx, S.xy, S.xz}, {S.xy, S.yy, S.yz}, {S.xz, S.yz, S.zz}}};
}

}  // namespace cspace::inline CSPACE_ISA
