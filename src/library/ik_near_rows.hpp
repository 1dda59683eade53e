// The configurations of a pose that a planner chooses from: within limits, the nearest to a seed first.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ik_solver.hpp"

namespace cspace::ik {

// Limits (n,) that may be narrower than the arm's, and the configuration (n,) from which distances count.
struct NearSeed {
    const double *lower, *upper, *seed;
};

// Rows (k, n), each revolute joint at the multiple of 2π within limits that is nearest to the seed.
// is_doubtful: a row is left out that is beyond a limit by at most `close`.
struct NearRows {
    std::vector<double> q;
    bool is_doubtful = false;
};

// Those of the rows q (k, n) that keep the limits; rows of NaN are left out.
NearRows sort_rows_near(const Chain& chain, std::span<const double> q, const NearSeed& near, double close);

// The solutions of one pose with the redundant joints at each of the values (k, r). None for an invalid goal.
std::optional<NearRows> solve_locked_near(Solver& solver, const double* goal, std::span<const double> values,
                                          const NearSeed& near);
// The same of goals (m, 4, 4), each with a seed of its own (m, n), on so many threads (0: all).
std::vector<std::optional<NearRows>> solve_each_locked_near(Solver& solver, std::span<const double> goals,
                                                            std::span<const double> values,
                                                            const double* lower, const double* upper,
                                                            std::span<const double> seeds, int threads);

}  // namespace cspace::ik
