// Poses as matrices (4, 4).
#pragma once

#include "cspace/math/vec.hpp"

namespace cspace::kinematics::inline CSPACE_ISA {

// A pose as the sixteen numbers of its matrix, row by row, and back.
template <class V>
CSPACE_INLINE void write_matrix(const Pose<V>& T, V* matrix) {
    for (int r = 0; r < 3; ++r) {
        for (int j = 0; j < 3; ++j) matrix[4 * r + j] = T.R.m[r][j];
        matrix[4 * r + 3] = r == 0 ? T.t.x : r == 1 ? T.t.y : T.t.z;
        matrix[12 + r] = fill_lanes<V>(0.0);
    }
    matrix[15] = fill_lanes<V>(1.0);
}
template <class V>
CSPACE_INLINE Pose<V> read_matrix(const V* m) {
    return {{{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}}, {m[3], m[7], m[11]}};
}

}  // namespace cspace::kinematics::inline CSPACE_ISA
