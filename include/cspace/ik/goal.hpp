// Validation of goals: 4×4 matrices that should be poses.
#pragma once

#include "cspace/kinematics/forward.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::ik {

template <class V>
struct ReadGoal {
    Pose<V> T;
    mask_of<V> is_pose;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The rotation nearest to R for an R that is one up to a small error e = RᵀR − I: R (I − e/2), twice.
template <class V>
CSPACE_INLINE Mat3<V> straighten_rotation(const Mat3<V>& R) {
    Mat3<V> out = R;
    for (int step = 0; step < 2; ++step) {
        const Vec3<V> x = matrix_column(out, 0), y = matrix_column(out, 1), z = matrix_column(out, 2);
        const V xx = 0.5 * (dot(x, x) - 1.0), yy = 0.5 * (dot(y, y) - 1.0), zz = 0.5 * (dot(z, z) - 1.0);
        const V xy = 0.5 * dot(x, y), yz = 0.5 * dot(y, z), xz = 0.5 * dot(x, z);
        out = from_columns(x - xx * x - xy * y - xz * z, y - xy * x - yy * y - yz * z,
                           z - xz * x - yz * y - zz * z);
    }
    return out;
}

// Checks a pose and orthonormalises its rotation within rounding. m: its 16 entries, row-major.
template <class V>
CSPACE_INLINE ReadGoal<V> read_goal(const V* m) {
    constexpr double exact_rotation = 1e-14;  // what products of rotations lose
    ReadGoal<V> out;
    out.T = kinematics::read_matrix(m);
    Mat3<V>& R = out.T.R;
    const Vec3<V> x = matrix_column(R, 0), y = matrix_column(R, 1), z = matrix_column(R, 2);
    const V lengths = max(max(abs(dot(x, x) - 1.0), abs(dot(y, y) - 1.0)), abs(dot(z, z) - 1.0));
    const V error = max(max(max(abs(dot(x, y)), abs(dot(y, z))), abs(dot(x, z))), lengths);
    const V last_row = max(max(abs(m[12]), abs(m[13])), max(abs(m[14]), abs(m[15] - 1.0)));
    const V size = abs(m[3]) + abs(m[7]) + abs(m[11]);
    // Every comparison with NaN is false, so NaN anywhere refuses the goal.
    out.is_pose = (abs(dot(x, x) + dot(y, y) + dot(z, z) + dot(x, y) + dot(y, z) + dot(x, z)) <= 100.0) &&
                  (error <= tolerance::rotation_error) && (last_row <= tolerance::last_row) &&
                  (size <= tolerance::farthest) && (dot(cross(x, y), z) > 0.0);
    if (any(error > exact_rotation)) R = straighten_rotation(R);
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
