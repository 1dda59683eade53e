// Dynamics of many configurations, and of one.
#pragma once

#include <cstddef>

#include "cspace/dynamics/multibody.hpp"
#include "dispatch.hpp"

namespace cspace::dynamics {

// What spatial_rows computes, and the size of its result.
enum class What {
    coriolis,         // (dof, dof)
    derivatives,      // (3, dof, dof): of inverse dynamics by positions, velocities and accelerations
    responses,        // (3, dof, dof): the same of forward dynamics, the last by torques
    momentum,         // (6,): about the centre of mass
    momentum_matrix,  // (6, dof)
    kinetic,          // (1,)
    potential         // (1,)
};

// A wrench of the world on a link, per row: see applied_wrenches.hpp. in_frame_axes: its numbers are in axes
// which are `axes` in those of the link, else in those of the world.
template <class S>
struct BasicPush {
    const int* path;
    int depth;
    bool in_frame_axes;
    Vec3<S> point;
    Mat3<S> axes;
    const S* values;
    std::size_t stride;  // 0: one for all rows
};

// Rows of arguments and results; each row has n = n_coordinates joints and dof = n velocities, six more, [v;
// ω] of the base at its origin in world axes, where it floats. rubs: joints have damping and dry friction.
template <class S>
struct BasicRows {
    BasicMultibody<S> bodies;
    Vec3d gravity;
    bool floating, rubs;
    const S *q, *qd;               // qd null: at rest
    const S* force;                // qdd of inverse dynamics (null: zero), tau of forward dynamics
    const S* T_world_base;         // null: identity
    std::size_t base_stride;       // 0: one pose for all
    S* result;                     // tau or qdd (rows, dof), M (rows, dof, dof), or as What says
    What what;                     // for spatial_rows
    const BasicPush<S>* wrenches;  // of inverse and forward dynamics
    int n_wrenches;
};
using Rows = BasicRows<double>;
using FloatRows = BasicRows<float>;

// The regressor of inverse dynamics (rows, dof, columns): ten columns per body, of a floating base first,
// then one per joint for its armature and, with rubs, for damping and dry friction.
struct RegressorRows {
    Rows rows;            // with qd and force (qdd)
    const Posed* frames;  // of each body, in which its parameters are, in the axes of its link
    int columns;
};

// Bytes of scratch memory, aligned to 64, that one thread needs for packs of 64 bytes.
template <class S>
std::size_t scratch_bytes(const BasicRows<S>& rows) {
    const std::size_t n = std::size_t(rows.bodies.n_links), dof = std::size_t(rows.bodies.n_coordinates) + 6;
    return 64 * (80 * n + dof * (6 * dof + 24) + 20 * std::size_t(rows.n_wrenches) + 8);
}
inline std::size_t scratch_bytes(const RegressorRows& rows) { return scratch_bytes(rows.rows); }

}  // namespace cspace::dynamics

#define CSPACE_DYNAMICS_KERNEL(name, Rows)      \
    CSPACE_KERNEL(cspace::dynamics, bool, name, \
                  (const Rows& rows, std::size_t begin, std::size_t end, void* scratch))
// Rows begin to end. False if an argument among them is not finite; the results are then of no use.
CSPACE_DYNAMICS_KERNEL(inverse_rows, Rows)
CSPACE_DYNAMICS_KERNEL(mass_rows, Rows)
// Also false if the mass matrix of a row is singular.
CSPACE_DYNAMICS_KERNEL(forward_rows, Rows)
CSPACE_DYNAMICS_KERNEL(spatial_rows, Rows)
// In floats; also false for values of joints beyond those of which floats have a sine (float_packs.hpp).
CSPACE_DYNAMICS_KERNEL(inverse_float_rows, FloatRows)
CSPACE_DYNAMICS_KERNEL(mass_float_rows, FloatRows)
CSPACE_DYNAMICS_KERNEL(forward_float_rows, FloatRows)
#undef CSPACE_DYNAMICS_KERNEL
CSPACE_NARROW_KERNEL(cspace::dynamics, bool, regressor_rows,
                     (const RegressorRows& rows, std::size_t begin, std::size_t end, void* scratch))
