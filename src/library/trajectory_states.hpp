// Motions from state to state: what the bindings call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cspace::trajectory {

enum class Synchronize { time, phase, none };

// What became of a problem: a motion, a duration that is not possible (the next possible one is given), or
// boundary states that no straight line connects.
enum class Verdict : std::int32_t { found, refused_duration, not_parallel };

// Problems of the same axes and limits. states (rows, 2, 3, dof): positions, velocities and accelerations at
// the start, then at the goal. limits (5, dof): highest and lowest velocity, highest and lowest acceleration,
// jerk, which may be infinite. durations (rows): those asked for; NaN for the shortest. cycle: of which a
// duration that is not asked for is a multiple; 0 for none.
//
// Results: verdict (rows); duration (rows); shortest (rows, dof): of each axis alone; motions
// (numbers_of_motion(), rows, dof): from which make_pieces makes the pieces.
struct StateProblems {
    std::size_t rows, dof;
    const double *states, *limits, *durations;
    double cycle;
    Synchronize mode;
    std::int32_t* verdict;
    double *duration, *shortest, *motions;
};
std::size_t numbers_of_motion();
void solve_states(const StateProblems& problems, int threads);

// The motion of one problem: what it was and its results. states (2, 3, dof), limits (5, dof), shortest
// (dof,), motions (numbers_of_motion(), dof).
struct StateMotion {
    std::size_t dof;
    const double *states, *limits, *shortest, *motions;
    double duration;
    Synchronize mode;
};
// Polynomials. Pieces of the first half are given from their beginnings, those of the second half from their
// ends: both ends of the motion are exact. Each axis has `pieces` pieces; those with fewer rest at their
// goal. knots (dof, pieces + 1), coefficients (dof, pieces, 4), origins (dof, pieces).
struct StatePieces {
    std::size_t pieces;
    std::vector<double> knots, coefficients, origins;
};
StatePieces make_pieces(const StateMotion& motion);

// Whether the states (2, 3, dof) are within `farthest`, the limits (5, dof) above and below zero, and the
// goal within limits that a motion can keep before it: what solve_states takes for granted.
bool can_be_asked(const double* states, const double* limits, std::size_t dof, double farthest);

// One problem in the shortest time, and whether its positions keep between `lower` and `upper` (dof,), which
// may be null.
struct OneMotion {
    StatePieces pieces;
    double duration;
    bool keeps_within;
};
OneMotion move_axes(const double* states, const double* limits, const double* lower, const double* upper,
                    std::size_t dof);

}  // namespace cspace::trajectory
