#pragma once
#include <cstddef>

#include "dispatch.hpp"

// Rotation matrices (n, 9), row by row. False if some row needs care: it is zero where zero is not a
// rotation, not finite, or so long or short that its square leaves the range of doubles. Its matrix is then
// meaningless.

// q: (n, 4), of any length, order w x y z, or x y z w if scalar_last.
CSPACE_NARROW_KERNEL(cspace::spatial, bool, quaternion_matrices_n,
                     (const double* q, bool scalar_last, double* R, std::size_t n))
// w: (n, 3) [rad], zero included; one longer than a turn needs care.
CSPACE_NARROW_KERNEL(cspace::spatial, bool, rotvec_matrices_n, (const double* w, double* R, std::size_t n))
// axis: (n, 3), of any length; angle: (n,) [rad].
CSPACE_NARROW_KERNEL(cspace::spatial, bool, axis_angle_matrices_n,
                     (const double* axis, const double* angle, double* R, std::size_t n))
