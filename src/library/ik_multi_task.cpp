#include "ik_multi_task.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "cspace/ik/numeric/multi_task.hpp"
#include "cspace/ik/numeric/resolved_rate.hpp"
#include "cspace/kinematics/forward.hpp"
#include "cspace/math/threads.hpp"

namespace cspace::ik {

namespace {

FrameTask task_from(const double* row, const model::RobotModel& model) {
    FrameTask task;
    task.kind = static_cast<TaskKind>(int(row[0]));
    task.frame = int(row[1]);
    if (task.kind != TaskKind::center_of_mass && (task.frame < 0 || task.frame >= model.n_frames()))
        throw std::invalid_argument("no such frame");
    task.gain = row[2];
    task.target = kinematics::read_matrix(row + 3);
    std::copy_n(row + 19, 6, task.weight);
    task.point = {row[25], row[26], row[27]};
    return task;
}

TaskProblem problem_from(const TaskRows& rows) {
    const int n = rows.model.n_coordinates();
    TaskProblem problem;
    problem.model = &rows.model;
    problem.floating = rows.floating;
    for (std::size_t k = 0; k < rows.n_tasks; ++k)
        problem.tasks.push_back(task_from(rows.tasks + task_width * k, rows.model));
    for (std::size_t k = 0; k < rows.n_postures; ++k) {
        const double* row = rows.postures + std::size_t(2 * n + 1) * k;
        problem.postures.push_back({row, row + n, row[2 * n]});
    }
    problem.lower = rows.limits;
    problem.upper = rows.limits ? rows.limits + n : nullptr;
    return problem;
}

TaskPlace place_at(const TaskProblem& problem, const double* q, const double* T_world_base) {
    TaskPlace at;
    at.q.assign(q, q + problem.model->n_coordinates());
    at.T_world_base = kinematics::read_matrix(T_world_base);
    return at;
}

void write_errors(const TaskPlace& at, double* errors) {
    for (std::size_t k = 0; k < at.errors.size(); ++k) {
        errors[2 * k] = at.errors[k].position;
        errors[2 * k + 1] = at.errors[k].rotation;
    }
}

// A velocity that, after dt, is past a limit by rounding alone, taken back by as much.
double kept_inside(double qd, double q, double dt, double lower, double upper) {
    if (q < lower || q > upper) return qd;
    for (int k = 0; k < 8 && q + qd * dt > upper; ++k) qd = std::nextafter(qd, -1e308);
    for (int k = 0; k < 8 && q + qd * dt < lower; ++k) qd = std::nextafter(qd, 1e308);
    return qd;
}

}  // namespace

bool task_velocity(const TaskRows& rows, const double* q, const double* T_world_base, const double* speed,
                   double dt, double damping, double* qd, double* errors) {
    const TaskProblem problem = problem_from(rows);
    const int dof = dof_of(problem), first = problem.floating ? 6 : 0;
    TaskWork work = task_work(problem);
    TaskPlace at = place_at(problem, q, T_world_base);
    measure_tasks(problem, work, at);
    BoxQp qp(dof);
    const auto most = [&](std::size_t j) {
        const bool slow = speed && int(j) >= first;
        return slow ? speed[int(j) - first] * dt : std::numeric_limits<double>::infinity();
    };
    bound_step(problem, q, most, qp);
    if (!best_step(at, damping, true, qp, qd)) return false;
    for (int j = 0; j < dof; ++j) {
        qd[j] /= dt;
        if (j < first || !problem.lower) continue;
        const int i = j - first;
        qd[j] = kept_inside(qd[j], q[i], dt, problem.lower[i], problem.upper[i]);
    }
    write_errors(at, errors);
    return true;
}

std::tuple<int, bool, double> solve_tasks(const TaskRows& rows, int most_steps, double settled, double* q,
                                          double* T_world_base, double* errors) {
    const TaskProblem problem = problem_from(rows);
    TaskPlace at = place_at(problem, q, T_world_base);
    const TaskEnd end = solve_tasks(problem, most_steps, settled, at);
    std::copy(at.q.begin(), at.q.end(), q);
    kinematics::write_matrix(at.T_world_base, T_world_base);
    write_errors(at, errors);
    return {end.steps, end.settled, at.cost};
}

void resolve_rates(const RateRows& given) {
    static_assert(max_rate_dof == max_rate_columns);
    const RateSettings settings = {given.damping, given.threshold, given.most};
    const std::size_t dof = given.dof;
    over_rows(given.rows, given.threads, 1, 256, [&](std::size_t begin, std::size_t end) {
        RateSvd svd;
        for (std::size_t k = begin; k < end; ++k)
            resolved_rate(given.J + 6 * dof * k, int(dof), given.twist + 6 * k,
                          given.wish ? given.wish + dof * k : nullptr, settings, svd, given.qd + dof * k);
        return true;
    });
}

}  // namespace cspace::ik
