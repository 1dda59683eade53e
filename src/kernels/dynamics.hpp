// Dynamics of many configurations, and of one.
#pragma once

#include <cstddef>

#include "cspace/dynamics/multibody.hpp"
#include "dispatch.hpp"

namespace cspace::dynamics {

// What spatial_rows computes, and the size of its result.
enum class What {
    coriolis,         // (dof, dof)
    derivatives,      // (2, dof, dof): of inverse dynamics by positions and by velocities
    momentum,         // (6,): about the centre of mass
    momentum_matrix,  // (6, dof)
    kinetic,          // (1,)
    potential         // (1,)
};

// Rows of arguments and results; each row has n = n_coordinates joints and dof = n velocities, six more, [v;
// ω] of the base at its origin in world axes, where it floats. rubs: joints have damping and dry friction.
struct Rows {
    Multibody bodies;
    Vec3d gravity;
    bool floating, rubs;
    const double *q, *qd;        // qd null: at rest
    const double* force;         // qdd of inverse dynamics (null: zero), tau of forward dynamics
    const double* T_world_base;  // null: identity
    std::size_t base_stride;     // 0: one pose for all
    double* result;              // tau or qdd (rows, dof), M (rows, dof, dof), or as What says
    What what;                   // for spatial_rows
};

// Bytes of scratch memory, aligned to 64, that one thread needs for packs of `lanes`.
inline std::size_t scratch_bytes(const Rows& rows, std::size_t lanes = 8) {
    const std::size_t n = std::size_t(rows.bodies.n_links), dof = std::size_t(rows.bodies.n_coordinates) + 6;
    return 8 * lanes * (80 * n + dof * (2 * dof + 5) + 8);
}

}  // namespace cspace::dynamics

// Rows begin to end. False if an argument among them is not finite; the results are then of no use.
CSPACE_KERNEL(cspace::dynamics, bool, inverse_rows,
              (const Rows& rows, std::size_t begin, std::size_t end, void* scratch))
CSPACE_KERNEL(cspace::dynamics, bool, mass_rows,
              (const Rows& rows, std::size_t begin, std::size_t end, void* scratch))
CSPACE_KERNEL(cspace::dynamics, bool, spatial_rows,
              (const Rows& rows, std::size_t begin, std::size_t end, void* scratch))
// Also false if the mass matrix of a row is singular.
CSPACE_KERNEL(cspace::dynamics, bool, forward_rows,
              (const Rows& rows, std::size_t begin, std::size_t end, void* scratch))
