// The memory that closed loops need while they move, as plain data.
#pragma once

#include <cstddef>

#include "cspace/kinematics/loop_places.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::dynamics {

using kinematics::ClosedLoops;
using kinematics::LoopPlaces;

// The factors of Kᵀ (dof, n_rows), the order of its columns, and how many are independent.
struct AllowedMotions {
    MatrixRows<double> reflections;
    double *diagonal, *factor;
    int* order;
    int rank;
};

// Memory for one configuration. phi, b (n_rows,); K (n_rows, dof); G, MG, H, M
// (dof, dof); the others (dof,).
struct LoopMemory {
    LoopPlaces places;
    AllowedMotions motions;
    double *phi, *b, *K, *G, *MG, *H, *M;
    double *x, *pull, *y, *own, *q, *qd, *tried, *force;
};

inline std::size_t loop_memory_bytes(const ClosedLoops& loops) {
    const std::size_t n = std::size_t(loops.n_joints), r = std::size_t(loops.n_rows);
    const std::size_t dof = std::size_t(loops.dof);
    return sizeof(Posed) * (n + 2 * std::size_t(loops.n_loops)) + sizeof(kinematics::LoopMotion) * n +
           sizeof(double) * (2 * r * dof + 5 * r + 4 * dof * dof + 8 * dof) + sizeof(double) * r;
}

}  // namespace cspace::dynamics
