// Descents on the pose error of a frame: what the bindings call. Rows have one column per coordinate of the
// robot.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cspace/model/chain.hpp"

namespace cspace::ik {

// What a frame has to meet, and how: weights (6,) of the error's rows, limits (2, dof) or null.
struct DescentTask {
    const model::Chain& chain;
    const double* weights;
    const double* limits;
    double tolerance;
    int most_steps;
    bool newton;
    int threads;
};

inline constexpr int descent_info = 5;  // position error, rotation error, steps, start, ending

// From starts (count, dof), or one row for all, then from more (n_more, dof), to goals (count, 16); posture:
// null, or (2, dof): a configuration to prefer and the weights of its joints. q (count, dof), info (count,
// descent_info).
void descend_to_goals(const DescentTask& task, const double* goals, std::size_t count, const double* starts,
                      bool start_each, const double* more, std::size_t n_more, const double* posture,
                      double* q, double* info);

// From many starts (count, dof) to one goal: the different solutions, those nearest to `wanted` first.
// Returns how many rows of q (count, dof), residual and hits were written.
std::size_t sample_solutions(const DescentTask& task, const double* goal, const double* starts,
                             std::size_t count, const double* wanted, double* q, double* residual,
                             std::int64_t* hits);

// How many coordinates move the end of a chain; more than a path holds if its joints alone are too many.
int moving_coordinates(const model::Chain& chain);

}  // namespace cspace::ik
