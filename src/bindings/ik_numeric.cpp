// Numeric inverse kinematics: plain checked arrays in, filled arrays out, the interpreter free meanwhile.
#include "library/ik_numeric.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "kinematics.hpp"

namespace nb = nanobind;
using namespace nb::literals;
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

}  // namespace

void bind_ik_numeric(nb::module_& m) {
    m.def("_ik_moving", count_moving, "robot"_a, "frame"_a, "How many coordinates move a frame.");
    m.def("_ik_descend", descend_rows, "robot"_a, "frame"_a, "goals"_a, "starts"_a, "more"_a, "posture"_a,
          "weights"_a, "limits"_a, "tolerance"_a, "most_steps"_a, "newton"_a, "threads"_a, "q"_a, "info"_a,
          "Descends from starts to goals; q and info take the answers.");
    m.def("_ik_sample", sample_rows, "robot"_a, "frame"_a, "goal"_a, "starts"_a, "wanted"_a, "weights"_a,
          "limits"_a, "tolerance"_a, "most_steps"_a, "threads"_a, "q"_a, "residual"_a, "hits"_a,
          "The different solutions that descents from many starts reach; returns their number.");
}
