// Numeric inverse kinematics: descents, resolved rate, and several tasks at once. Plain checked arrays in,
// filled arrays out, the interpreter free meanwhile.
#include "library/ik_numeric.hpp"

#include <nanobind/stl/tuple.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/math/box_qp.hpp"
#include "kinematics.hpp"
#include "library/ik_multi_task.hpp"

namespace nb = nanobind;
using namespace cspace;

namespace {

using Weights = Array<const double, nb::shape<6>>;
using LimitRows = Array<const double, nb::shape<2, -1>>;

ik::DescentTask task_from(nb::handle robot, int frame, const Weights& weights, const LimitRows& limits,
                          double tolerance, int most_steps, bool newton, int threads) {
    const model::Chain& chain = chain_on(robot, frame);
    require_sizes(limits.shape(1) == 0 || int(limits.shape(1)) == chain.n_coordinates);
    return {chain,  weights.data(), limits.shape(1) ? limits.data() : nullptr, tolerance, most_steps,
            newton, threads};
}

// See ik_descend in the package for the meaning of each argument.
void descend_rows(nb::handle robot, int frame, Goals goals, Matrix starts, Matrix more, Matrix posture,
                  Weights weights, LimitRows limits, double tolerance, int most_steps, bool newton,
                  int threads, Array<double, nb::ndim<2>> q,
                  Array<double, nb::shape<-1, ik::descent_info>> info) {
    const ik::DescentTask task =
        task_from(robot, frame, weights, limits, tolerance, most_steps, newton, threads);
    const std::size_t count = goals.shape(0), dof = std::size_t(task.chain.n_coordinates);
    require_sizes(starts.shape(1) == dof && more.shape(1) == dof && posture.shape(1) == dof &&
                  q.shape(1) == dof && q.shape(0) == count && info.shape(0) == count &&
                  (starts.shape(0) == count || starts.shape(0) == 1));
    const nb::gil_scoped_release release;
    descend_to_goals(task, goals.data(), count, starts.data(), starts.shape(0) != 1, more.data(),
                     more.shape(0), posture.shape(0) == 2 ? posture.data() : nullptr, q.data(), info.data());
}

// From many starts to one goal; returns how many different solutions q and hits hold.
std::size_t sample_rows(nb::handle robot, int frame, Goal goal, Matrix starts, Matrix wanted, Weights weights,
                        LimitRows limits, double tolerance, int most_steps, int threads,
                        Array<double, nb::ndim<2>> q, Array<double, nb::ndim<1>> residual,
                        Array<std::int64_t, nb::ndim<1>> hits) {
    const ik::DescentTask task =
        task_from(robot, frame, weights, limits, tolerance, most_steps, false, threads);
    const std::size_t count = starts.shape(0), dof = std::size_t(task.chain.n_coordinates);
    require_sizes(starts.shape(1) == dof && wanted.shape(1) == dof && q.shape(1) == dof &&
                  q.shape(0) == count && hits.shape(0) == count && residual.shape(0) == count &&
                  wanted.shape(0) == 1);
    const nb::gil_scoped_release release;
    return sample_solutions(task, goal.data(), starts.data(), count, wanted.data(), q.data(), residual.data(),
                            hits.data());
}

int count_moving(nb::handle robot, int frame) { return ik::moving_coordinates(chain_on(robot, frame)); }

// --- velocities ----------------------------------------------------------------------------------------
using Errors = Array<double, nb::shape<-1, 2>>;

ik::TaskRows rows_from(nb::handle robot, const Matrix& tasks, const Matrix& postures, const LimitRows& limits,
                       std::size_t q_size, const Errors& errors) {
    const KinematicsObject& object = robot_from(robot);
    const std::size_t n = std::size_t(object.model->n_coordinates());
    require_sizes(tasks.shape(1) == ik::task_width && postures.shape(1) == 2 * n + 1 && q_size == n &&
                  (limits.shape(1) == 0 || limits.shape(1) == n) && errors.shape(0) == tasks.shape(0));
    return {*object.model,
            object.floating,
            tasks.data(),
            tasks.shape(0),
            postures.data(),
            postures.shape(0),
            limits.shape(1) ? limits.data() : nullptr};
}

bool compute_velocity(nb::handle robot, Matrix tasks, Matrix postures, Row q,
                      Array<const double, nb::shape<4, 4>> T_world_base, LimitRows limits, Row speed,
                      double dt, double damping, RowOut qd, Errors errors) {
    const ik::TaskRows rows = rows_from(robot, tasks, postures, limits, q.shape(0), errors);
    require_sizes(int(qd.shape(0)) == rows.dof() && (speed.shape(0) == 0 || speed.shape(0) == q.shape(0)));
    return ik::task_velocity(rows, q.data(), T_world_base.data(), speed.shape(0) ? speed.data() : nullptr, dt,
                             damping, qd.data(), errors.data());
}

std::tuple<int, bool, double> move_to_tasks(nb::handle robot, Matrix tasks, Matrix postures, RowOut q,
                                            Array<double, nb::shape<4, 4>> T_world_base, LimitRows limits,
                                            int most_steps, double settled, Errors errors) {
    const ik::TaskRows rows = rows_from(robot, tasks, postures, limits, q.shape(0), errors);
    const nb::gil_scoped_release release;
    return ik::solve_tasks(rows, most_steps, settled, q.data(), T_world_base.data(), errors.data());
}

void resolve_rates(Array<const double, nb::shape<-1, 6, -1>> J, Array<const double, nb::shape<-1, 6>> twist,
                   Matrix wish, Row most, double damping, double threshold, int threads,
                   Array<double, nb::ndim<2>> qd) {
    const std::size_t rows = J.shape(0), dof = J.shape(2);
    require_sizes(twist.shape(0) == rows && has_shape(qd, rows, dof) &&
                  (wish.shape(0) == 0 || has_shape(wish, rows, dof)) &&
                  (most.shape(0) == 0 || most.shape(0) == dof) && dof <= ik::max_rate_dof);
    const nb::gil_scoped_release release;
    ik::resolve_rates({J.data(), rows, dof, twist.data(), wish.shape(0) ? wish.data() : nullptr,
                       most.shape(0) ? most.data() : nullptr, damping, threshold, threads, qd.data()});
}

int solve_box_program(Matrix H, Row g, Row lower, Row upper, RowOut x) {
    const std::size_t n = g.shape(0);
    require_sizes(has_shape(H, n, n) && has_shape(lower, n) && has_shape(upper, n) && has_shape(x, n));
    BoxQp qp{int(n)};
    std::copy_n(H.data(), n * n, qp.H.begin());
    std::copy_n(g.data(), n, qp.g.begin());
    std::copy_n(lower.data(), n, qp.lower.begin());
    std::copy_n(upper.data(), n, qp.upper.begin());
    return solve_box_qp(qp, x.data());
}

}  // namespace

void bind_ik_numeric(nb::module_& m) {
    m.def("_ik_moving", count_moving, "How many coordinates move a frame.");
    m.def("_ik_descend", descend_rows, "Descends from starts to goals; q and info take the answers.");
    m.def("_ik_sample", sample_rows,
          "The different solutions that descents from many starts reach; returns their number.");
    m.def("_task_velocity", compute_velocity, "The velocities with the least task error after one step.");
    m.def("_task_solve", move_to_tasks, "Moves q and T_world_base to the least error of the tasks.");
    m.def("_resolved_rate", resolve_rates, "The velocities that give twists.");
    m.def("_box_qp", solve_box_program,
          "A quadratic program in a box; returns the number of steps, -1 if H is not positive definite.");
}
