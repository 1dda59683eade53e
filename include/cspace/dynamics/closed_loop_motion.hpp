// How one row of a mechanism with closed loops accelerates, and how its state is kept closed.
//
// Between steps dependent rows of K are not quite dependent, so no more rows count than at closed loops
// before. A motion that began at a singular configuration, with a lower rank, gets to its full rank when it
// is settled.
#pragma once

#include <limits>

#include "cspace/dynamics/allowed_motions.hpp"

namespace cspace::dynamics {

// Newton steps of a projection: each squares the residual.
inline constexpr int most_projections = 8;

}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

// memory.x (dof,): the accelerations at memory.q, qd and M under memory.force, what acts less the bias of the
// tree. rank: as cap of find_allowed_motions. False where an allowed motion moves no inertia.
inline bool accelerate_row(const ClosedLoops& loops, int rank, LoopMemory& memory) {
    place_row(loops, memory.q, memory);
    find_allowed_motions(loops, rank, memory);
    kinematics::find_loop_bias(loops, memory.qd, memory.places, memory.b);
    for (int r = 0; r < loops.n_rows; ++r) memory.b[r] = -memory.b[r];
    return solve_least_energy(loops, memory.M, memory.b, memory.force, memory, memory.x);
}

// Moves memory.q until its loops are closed and adds to memory.qd what keeps them so, both by as little as
// possible in the metric of M: q ← q − M⁻¹ Kᵀ (K M⁻¹ Kᵀ)⁺ φ until φ is at rounding, and q̇ likewise. The pose
// of a floating base stays. Returns how far the loops are open then [m], infinite upside down.
inline double project_row(const ClosedLoops& loops, int rank, LoopMemory& memory) {
    const int n = loops.n_coordinates, first = loops.dof - n;
    place_row(loops, memory.q, memory);
    double size = kinematics::residual_size(loops, memory.phi);
    for (int i = 0; i < most_projections && !(size <= tolerance::loop_projected); ++i) {
        find_allowed_motions(loops, rank, memory);
        for (int r = 0; r < loops.n_rows; ++r) memory.b[r] = -memory.phi[r];
        solve_least_energy(loops, memory.M, memory.b, nullptr, memory, memory.x);
        for (int j = 0; j < n; ++j) memory.tried[j] = memory.q[j] + memory.x[first + j];
        place_row(loops, memory.tried, memory);
        const double after = kinematics::residual_size(loops, memory.phi);
        if (!(after < size)) {
            place_row(loops, memory.q, memory);
            break;
        }
        std::swap(memory.q, memory.tried);
        size = after;
    }
    find_allowed_motions(loops, rank, memory);
    for (int r = 0; r < loops.n_rows; ++r) {
        memory.b[r] = 0.0;
        for (int j = 0; j < loops.dof; ++j) memory.b[r] -= memory.K[r * loops.dof + j] * memory.qd[j];
    }
    solve_least_energy(loops, memory.M, memory.b, nullptr, memory, memory.x);
    for (int j = 0; j < loops.dof; ++j) memory.qd[j] += memory.x[j];
    for (int l = 0; l < loops.n_loops; ++l)
        if (kinematics::is_turned_over(loops, memory.places, l))
            size = std::numeric_limits<double>::infinity();
    return size * loops.length;
}

// The nearest state whose loops are closed and stay closed, into memory.q and qd. rank: of K at closed loops,
// the largest so far. False if there is none.
inline bool settle_row(const ClosedLoops& loops, int& rank, LoopMemory& memory) {
    const double limit = tolerance::loop_closed * loops.length;
    if (!(project_row(loops, rank, memory) <= limit) && !(project_row(loops, -1, memory) <= limit))
        return false;
    find_allowed_motions(loops, -1, memory);
    rank = std::max(rank, memory.motions.rank);
    return true;
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
