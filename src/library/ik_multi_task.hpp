// Velocities: resolved rate, and several tasks at once. What the bindings call.
#pragma once

#include <cstddef>
#include <tuple>

#include "cspace/model/robot_model.hpp"

namespace cspace::ik {

// The columns of a packed task: kind, frame, gain, target (16), weights (6), point (3).
inline constexpr int task_width = 28;

// tasks (n_tasks, task_width); postures (n_postures, 2 n + 1): places, weights, gain; limits (2, n) or null.
struct TaskRows {
    const model::RobotModel& model;
    bool floating;
    const double* tasks;
    std::size_t n_tasks;
    const double* postures;
    std::size_t n_postures;
    const double* limits;

    int dof() const { return model.n_coordinates() + (floating ? 6 : 0); }
};

// The velocities qd (dof,) with the least task error after one step of length dt; speed (n,): largest, or
// null; errors (n_tasks, 2). False where the program is not solvable.
bool task_velocity(const TaskRows& rows, const double* q, const double* T_world_base, const double* speed,
                   double dt, double damping, double* qd, double* errors);

// Moves q and T_world_base to the least error of the tasks. Returns the number of steps, whether no step
// nearby is better, and the cost.
std::tuple<int, bool, double> solve_tasks(const TaskRows& rows, int most_steps, double settled, double* q,
                                          double* T_world_base, double* errors);

// For each row of J (rows, 6, dof) and twist (rows, 6) the velocities qd (rows, dof); wish (rows, dof) or
// null, most (dof,) or null.
inline constexpr std::size_t max_rate_dof = 128;
struct RateRows {
    const double* J;
    std::size_t rows, dof;
    const double* twist;
    const double* wish;
    const double* most;
    double damping, threshold;
    int threads;
    double* qd;
};
void resolve_rates(const RateRows& given);

}  // namespace cspace::ik
