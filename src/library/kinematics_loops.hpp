// The equations of closed loops at many configurations.
#pragma once

#include <cstddef>

#include "cspace/kinematics/closed_loops.hpp"

namespace cspace::kinematics {

// Arrays of a row for each configuration; null where nothing is asked. q (n,), qd (dof,); phi (n_rows,), over
// (n_loops,): whether a loop is nearer to a place upside down, K (n_rows, dof), wrenches (n_rows, 6): what a
// unit multiplier of a row exerts on the child, at the origin of its frame, k (n_rows,).
struct LoopArrays {
    const double *q, *qd;
    double* phi;
    bool* over;
    double *K, *wrenches, *k;
};

// Fills in the arrays of so many rows. threads: at most so many (0: all).
void evaluate_loops(const ClosedLoops& loops, const LoopArrays& arrays, std::size_t rows, int threads);

}  // namespace cspace::kinematics
