#pragma once
#include <cstddef>

#include "cspace/model/chain.hpp"
#include "cspace/model/tree.hpp"
#include "dispatch.hpp"

namespace cspace::kinematics {

// What is given and what is asked for, for many configurations of one chain. Arrays are row-major with one
// row per configuration; a stride is in values per row, 0 where all rows share one. An output that is null
// is not asked for.
struct ChainRows {
    model::Chain chain;
    std::size_t count;           // rows of the whole batch, which the kernel may see in parts
    const double* q;             // (rows, n_coordinates)
    const double* qd;            // (rows, dof), for J_rate
    const double* T_world_base;  // 4×4, or null for the identity
    std::size_t base_stride;
    const double* point;  // (3,) in the frame, or null for its origin
    std::size_t point_stride;
    bool floating;  // six columns for the base come first
    bool in_tip;    // the Jacobian in the axes of the frame
    double* T;      // (rows, 4, 4)
    double* J;      // (rows, 6, dof)
    double* J_rate;
    double* sigma;    // (rows, min(chosen, n)): singular values of the chosen rows and the joint columns of J
    unsigned chosen;  // bit r: row r of J counts for sigma
    const double* goals;  // goals of goal_size numbers, a pose or a point, each for goal_rows rows
    std::size_t goal_size, goal_rows;
    double* miss;  // (rows,): how far T is from its goal [m or rad]; NaN for a row of NaN
};
// The same for what needs the whole tree.
struct TreeRows {
    model::Tree tree;
    const double* q;
    const double* T_world_base;
    std::size_t base_stride;
    bool floating;
    double* T;               // (rows, frames, 4, 4)
    double* center;          // (rows, 3)
    double* center_columns;  // (rows, 3, dof)
};

// Bytes of scratch memory, aligned to 64, that one thread needs.
inline std::size_t scratch_bytes(const ChainRows& rows) {
    const std::size_t n = rows.chain.n, dof = rows.chain.n_coordinates + 6;
    return 32 * (14 * (n + 4) + 20 * dof + 80);
}
inline std::size_t scratch_bytes(const TreeRows& rows) {
    const std::size_t n = rows.tree.n_joints, dof = rows.tree.n_coordinates + 6;
    return 32 * (15 * n + 4 * dof + 64);
}

}  // namespace cspace::kinematics

// Rows begin to end. False if a joint value among them is not finite; the outputs are then of no use.
CSPACE_KERNEL(cspace::kinematics, bool, chain_rows,
              (const ChainRows& rows, std::size_t begin, std::size_t end, void* scratch))
CSPACE_KERNEL(cspace::kinematics, bool, tree_rows,
              (const TreeRows& rows, std::size_t begin, std::size_t end, void* scratch))

// One configuration, as quickly as can be: T (4, 4) and, unless null, J (6, n_coordinates) in the base.
CSPACE_KERNEL(cspace::kinematics, bool, chain_pose,
              (const model::Chain& chain, const double* q, double* T, void* scratch))
CSPACE_KERNEL(cspace::kinematics, bool, chain_jacobian,
              (const model::Chain& chain, const double* q, double* T, double* J, void* scratch))
