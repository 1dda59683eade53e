// Velocities: resolved rate, and several tasks at once. Plain checked arrays in, filled arrays out.
#include <nanobind/stl/tuple.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/ik/numeric/rate.hpp"
#include "cspace/ik/numeric/serve.hpp"
#include "cspace/kinematics/forward.hpp"
#include "cspace/math/threads.hpp"
#include "numeric_path.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

void require(bool fits) {
    if (!fits) throw nb::value_error("arrays of matching sizes");
}

// The columns of a packed task: kind, frame, gain, target (16), weights (6), point (3).
constexpr int task_width = 28;

FrameTask task_from(const double* row, const RobotModel& model) {
    FrameTask task;
    task.kind = static_cast<TaskKind>(int(row[0]));
    task.frame = int(row[1]);
    require(task.kind == TaskKind::center_of_mass || (task.frame >= 0 && task.frame < model.n_frames()));
    task.gain = row[2];
    task.target = read_matrix(row + 3);
    std::copy_n(row + 19, 6, task.weight);
    task.point = {row[25], row[26], row[27]};
    return task;
}

// postures (k, 2 n + 1): places, weights, gain.
TaskProblem problem_from(nb::handle robot, const Matrix& tasks, const Matrix& postures,
                         const Array<const double, nb::shape<2, -1>>& limits) {
    if (!PyObject_TypeCheck(robot.ptr(), robot_type)) throw nb::type_error("a robot comes first");
    auto* object = reinterpret_cast<RobotObject*>(robot.ptr());
    require(object->model != nullptr);
    const int n = object->model->n_coordinates();
    TaskProblem problem;
    problem.model = object->model.get();
    problem.floating = object->floating;
    require(tasks.shape(1) == task_width && int(postures.shape(1)) == 2 * n + 1);
    for (std::size_t k = 0; k < tasks.shape(0); ++k)
        problem.tasks.push_back(task_from(tasks.data() + task_width * k, *problem.model));
    for (std::size_t k = 0; k < postures.shape(0); ++k) {
        const double* row = postures.data() + postures.shape(1) * k;
        problem.postures.push_back({row, row + n, row[2 * n]});
    }
    require(limits.shape(1) == 0 || int(limits.shape(1)) == n);
    problem.lower = limits.shape(1) ? limits.data() : nullptr;
    problem.upper = limits.shape(1) ? limits.data() + n : nullptr;
    return problem;
}

void write_errors(const TaskPlace& at, const Array<double, nb::shape<-1, 2>>& errors) {
    for (std::size_t k = 0; k < at.errors.size(); ++k) {
        errors.data()[2 * k] = at.errors[k].position;
        errors.data()[2 * k + 1] = at.errors[k].rotation;
    }
}

// The bounds of a step of length dt: speeds, and the way to the limits. From outside it leads back in.
void bound_by_speed(const TaskProblem& problem, const double* q, const Row& speed, double dt, BoxQp& qp) {
    const std::size_t first = problem.floating ? 6 : 0;
    constexpr double endless = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < std::size_t(qp.n); ++j) {
        const double most = j >= first && speed.shape(0) ? speed.data()[j - first] * dt : endless;
        double low = -most, high = most;
        if (j >= first && problem.lower) {
            low = std::min(std::max(problem.lower[j - first] - q[j - first], -most), most);
            high = std::max(std::min(problem.upper[j - first] - q[j - first], most), -most);
        }
        qp.lower[j] = low;
        qp.upper[j] = std::max(low, high);
    }
}

// A velocity that, after dt, is past a limit by rounding alone, taken back by as much.
double kept_inside(double qd, double q, double dt, double lower, double upper) {
    if (q < lower || q > upper) return qd;
    for (int k = 0; k < 8 && q + qd * dt > upper; ++k) qd = std::nextafter(qd, -1e308);
    for (int k = 0; k < 8 && q + qd * dt < lower; ++k) qd = std::nextafter(qd, 1e308);
    return qd;
}

bool task_velocity(nb::handle robot, Matrix tasks, Matrix postures, Row q,
                   Array<const double, nb::shape<4, 4>> T_world_base,
                   Array<const double, nb::shape<2, -1>> limits, Row speed, double dt, double damping,
                   RowOut qd, Array<double, nb::shape<-1, 2>> errors) {
    const TaskProblem problem = problem_from(robot, tasks, postures, limits);
    const int n = problem.model->n_coordinates(), dof = dof_of(problem);
    require(int(q.shape(0)) == n && int(qd.shape(0)) == dof && errors.shape(0) == problem.tasks.size() &&
            (speed.shape(0) == 0 || int(speed.shape(0)) == n));
    TaskWork work = task_work(problem);
    TaskPlace at;
    at.q.assign(q.data(), q.data() + n);
    at.T_world_base = read_matrix(T_world_base.data());
    look(problem, work, at);
    BoxQp qp(dof);
    bound_by_speed(problem, q.data(), speed, dt, qp);
    if (!best_step(at, damping, true, qp, qd.data())) return false;
    const int first = problem.floating ? 6 : 0;
    for (int j = 0; j < dof; ++j) {
        qd.data()[j] /= dt;
        if (j < first || !problem.lower) continue;
        const int i = j - first;
        qd.data()[j] = kept_inside(qd.data()[j], q.data()[i], dt, problem.lower[i], problem.upper[i]);
    }
    write_errors(at, errors);
    return true;
}

std::tuple<int, bool, double> task_serve(nb::handle robot, Matrix tasks, Matrix postures, RowOut q,
                                         Array<double, nb::shape<4, 4>> T_world_base,
                                         Array<const double, nb::shape<2, -1>> limits, int most_steps,
                                         double settled, Array<double, nb::shape<-1, 2>> errors) {
    const TaskProblem problem = problem_from(robot, tasks, postures, limits);
    const int n = problem.model->n_coordinates();
    require(int(q.shape(0)) == n && errors.shape(0) == problem.tasks.size());
    TaskPlace at;
    at.q.assign(q.data(), q.data() + n);
    at.T_world_base = read_matrix(T_world_base.data());
    Served served;
    {
        nb::gil_scoped_release free;
        served = serve(problem, {most_steps, settled}, at);
    }
    std::copy(at.q.begin(), at.q.end(), q.data());
    write_matrix(at.T_world_base, T_world_base.data());
    write_errors(at, errors);
    return {served.steps, served.settled, at.cost};
}

void rate(Array<const double, nb::shape<-1, 6, -1>> J, Array<const double, nb::shape<-1, 6>> twist,
          Matrix wish, Row most, double damping, double threshold, int threads,
          Array<double, nb::ndim<2>> qd) {
    const std::size_t rows = J.shape(0), dof = J.shape(2);
    require(twist.shape(0) == rows && qd.shape(0) == rows && qd.shape(1) == dof &&
            (wish.shape(0) == 0 || (wish.shape(0) == rows && wish.shape(1) == dof)) &&
            (most.shape(0) == 0 || most.shape(0) == dof) && dof <= max_rate_columns);
    const RateSettings settings = {damping, threshold, most.shape(0) ? most.data() : nullptr};
    nb::gil_scoped_release free;
    over_rows(rows, threads, 1, 256, [&](std::size_t begin, std::size_t end) {
        RateSvd svd;
        for (std::size_t k = begin; k < end; ++k)
            resolved_rate(J.data() + 6 * dof * k, int(dof), twist.data() + 6 * k,
                          wish.shape(0) ? wish.data() + dof * k : nullptr, settings, svd,
                          qd.data() + dof * k);
        return true;
    });
}

int box_qp_of(Matrix H, Row g, Row lower, Row upper, RowOut x) {
    const std::size_t n = g.shape(0);
    require(H.shape(0) == n && H.shape(1) == n && lower.shape(0) == n && upper.shape(0) == n &&
            x.shape(0) == n);
    BoxQp qp{int(n)};
    std::copy_n(H.data(), n * n, qp.H.begin());
    std::copy_n(g.data(), n, qp.g.begin());
    std::copy_n(lower.data(), n, qp.lower.begin());
    std::copy_n(upper.data(), n, qp.upper.begin());
    return solve(qp, x.data());
}

}  // namespace

void bind_ik_tasks(nb::module_& m) {
    m.def("_task_velocity", task_velocity, "robot"_a, "tasks"_a, "postures"_a, "q"_a, "T_world_base"_a,
          "limits"_a, "speed"_a, "dt"_a, "damping"_a, "qd"_a, "errors"_a,
          "The velocities that serve tasks best in one step.");
    m.def("_task_serve", task_serve, "robot"_a, "tasks"_a, "postures"_a, "q"_a, "T_world_base"_a, "limits"_a,
          "most_steps"_a, "settled"_a, "errors"_a,
          "Moves q and T_world_base to where tasks are served best.");
    m.def("_resolved_rate", rate, "J"_a, "twist"_a, "wish"_a, "most"_a, "damping"_a, "threshold"_a,
          "threads"_a, "qd"_a, "The velocities that give twists.");
    m.def("_box_qp", box_qp_of, "H"_a, "g"_a, "lower"_a, "upper"_a, "x"_a,
          "A quadratic program in a box; returns the number of steps, -1 if H is not positive definite.");
}
