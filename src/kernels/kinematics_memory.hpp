// What kernels over rows of configurations share: scratch memory, checks, poses.
#pragma once

#include "cspace/kinematics/forward.hpp"
#include "cspace/math/rows.hpp"

namespace cspace::kinematics::inline CSPACE_ISA {

// Hands out arrays from memory that the caller owns.
struct Scratch {
    char* next;
};
template <class T>
CSPACE_INLINE T* take_array(Scratch& scratch, int n) {
    T* array = reinterpret_cast<T*>(scratch.next);
    scratch.next += sizeof(T) * std::size_t(n);
    return array;
}

// Whether all are finite, and so small that the values of joints that follow them are finite too: up to
// 1e100, which is FARTHEST in Python.
template <class V>
CSPACE_INLINE bool all_finite(const V* values, int n) {
    constexpr double headroom = 1e208;  // 1e100 times that is just below the largest double
    V sum = fill_lanes<V>(0.0);
    for (int i = 0; i < n; ++i) sum = sum + headroom * values[i];
    return all(0.0 * sum == 0.0);
}

template <class V>
CSPACE_INLINE Pose<V> load_pose(const double* matrix, std::size_t stride, int count) {
    if (!matrix) return fill_pose<V>(identity_pose());
    V m[16];
    load_rows(matrix, stride, count, 16, m);
    return read_matrix(m);
}

}  // namespace cspace::kinematics::inline CSPACE_ISA
