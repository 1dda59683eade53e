// Inverse kinematics with several weighted tasks: Levenberg–Marquardt steps, each a quadratic program within
// the limits.
//
// Not for kernels: it uses the standard library.
#pragma once

#include "cspace/ik/numeric/tasks.hpp"

namespace cspace::ik {

struct ServeSettings {
    int most_steps;
    double settled;  // a step this small ends the descent [rad, m]
};
struct Served {
    int steps;
    bool settled;  // nothing nearby serves better
};

namespace serving {
inline constexpr double first_mu = 0.1, least_mu = 1e-9, largest_mu = 1e9, gained = 0.3, lost = 4.0;
inline constexpr double floor = 1e-13;  // of the damping, so that there is always one best step
inline constexpr double stride = 1.0;   // largest change of a joint, or of the turn of a base, in one step
}  // namespace serving

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The bounds of the next step: joint limits and the maximum stride.
inline void bound_step(const TaskProblem& problem, const TaskPlace& at, BoxQp& qp) {
    const std::size_t first = problem.floating ? 6 : 0;
    for (std::size_t j = 0; j < std::size_t(qp.n); ++j) {
        qp.lower[j] = -serving::stride;
        qp.upper[j] = serving::stride;
        if (j < first || !problem.lower) continue;
        qp.lower[j] = std::max(qp.lower[j], std::min(problem.lower[j - first] - at.q[j - first], 0.0));
        qp.upper[j] = std::min(qp.upper[j], std::max(problem.upper[j - first] - at.q[j - first], 0.0));
    }
}

// Second-order correction after a step (Nocedal & Wright 2006, section 18.3). A soft posture task makes a
// curved valley, on whose floor the frame tasks are satisfied. The shortest step for the frame tasks alone
// returns to the floor.
inline void back_to_the_valley(const TaskProblem& problem, TaskWork& work, BoxQp& qp, double* step,
                               TaskPlace& there, TaskPlace& spare) {
    bound_step(problem, there, qp);
    if (!best_step(there, serving::floor, false, qp, step)) return;
    move_by(problem, there, step, spare);
    look(problem, work, spare);
    if (spare.cost < there.cost) std::swap(there, spare);
}

// Minimises the task error locally, from at.q (within the limits) and at.T_world_base.
inline Served serve(const TaskProblem& problem, const ServeSettings& settings, TaskPlace& at) {
    TaskWork work = task_work(problem);
    BoxQp qp(dof_of(problem));
    TaskPlace there, spare;
    std::vector<double> step(std::size_t(qp.n));
    double mu = serving::first_mu;
    look(problem, work, at);
    for (int k = 0; k < settings.most_steps; ++k) {
        bound_step(problem, at, qp);
        if (!best_step(at, 2 * mu * at.cost + serving::floor, true, qp, step.data())) return {k, false};
        double reach = 0;
        for (const double d : step) reach = std::max(reach, std::fabs(d));
        move_by(problem, at, step.data(), there);
        look(problem, work, there);
        if (there.cost >= at.cost && !problem.postures.empty())
            back_to_the_valley(problem, work, qp, step.data(), there, spare);
        const bool better = there.cost < at.cost;
        if (better) std::swap(at, there);
        if (reach <= settings.settled) return {k + 1, true};
        mu = better ? std::max(serving::gained * mu, serving::least_mu) : serving::lost * mu;
        if (mu > serving::largest_mu) return {k + 1, true};
    }
    return {settings.most_steps, false};
}

}  // namespace cspace::ik::inline CSPACE_ISA
