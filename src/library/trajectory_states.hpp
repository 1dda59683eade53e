// Motions from state to state: what the bindings call.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cspace::trajectory {

enum class Synchronize { time, phase, none };

// What became of a problem: a motion, a duration that is not possible (the next possible one is given), or
// boundary states that no straight line connects.
enum class Verdict : std::int32_t { found, refused_duration, not_parallel };

// Numbers of a phase: duration, acceleration at its beginning, jerk.
inline constexpr int phase_numbers = 3;

// Problems of the same axes and limits. states (rows, 2, 3, dof): positions, velocities and accelerations at
// the start, then at the goal. limits (5, dof): highest and lowest velocity, highest and lowest acceleration,
// jerk, which may be infinite. durations (rows): those asked for; NaN for the shortest. cycle: of which a
// duration that is not asked for is a multiple; 0 for none.
//
// Results: verdict (rows); duration (rows); shortest (rows, dof): of each axis alone; count (rows, dof);
// phases (rows, dof, most_phases, phase_numbers).
struct StateProblems {
    std::size_t rows, dof;
    const double *states, *limits, *durations;
    double cycle;
    Synchronize mode;
    std::int32_t* verdict;
    double *duration, *shortest;
    std::int32_t* count;
    double* phases;
};
int phases_of_axis();  // most of them
void solve_states(const StateProblems& problems, int threads);

// The motion of one problem as polynomials. states (2, 3, dof), count (dof), phases (dof, …). has_jerk: with
// a finite jerk limit, so that accelerations are attained at both ends. Pieces of the first half are given
// from their beginnings, those of the second half from their ends: both ends of the motion are exact. Each
// axis has `pieces` pieces, the most of any count and at least one; axes with fewer rest at their goal. knots
// (dof, pieces + 1), coefficients (dof, pieces, 4), origins (dof, pieces).
struct StatePieces {
    std::size_t dof, pieces;
    const double* states;
    const std::int32_t* count;
    const double* phases;
    double duration;
    double *knots, *coefficients, *origins;
};
void make_pieces(const StatePieces& made);

}  // namespace cspace::trajectory
