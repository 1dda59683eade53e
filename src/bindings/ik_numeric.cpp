// Numeric inverse kinematics: plain checked arrays in, filled arrays out, the interpreter free meanwhile.
#include "ik_numeric.hpp"

#include <array>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/ik/numeric/distinct.hpp"
#include "cspace/math/threads.hpp"
#include "numeric_path.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

constexpr int info_width = 5;  // position, rotation, steps, start, ending

ik::Task task_of(const RobotPath& on, const Array<const double, nb::shape<6>>& weights,
                 const Array<const double, nb::shape<2, -1>>& limits, double tolerance, int most_steps,
                 bool newton) {
    ik::Task task;
    std::copy_n(weights.data(), 6, task.weight);
    task.tolerance = tolerance;
    task.most_steps = most_steps;
    task.method = newton ? ik::Method::newton : ik::Method::levenberg_marquardt;
    task.limited = limits.shape(1) > 0;
    if (task.limited) {
        on.gather(limits.data(), task.lower);
        on.gather(limits.data() + limits.shape(1), task.upper);
    }
    return task;
}

// Rows of the robot's coordinates as rows of those of the path.
std::vector<double> gathered(const RobotPath& on, const Matrix& rows) {
    std::vector<double> out(rows.shape(0) * std::size_t(on.path.n));
    for (std::size_t k = 0; k < rows.shape(0); ++k)
        on.gather(rows.data() + rows.shape(1) * k, out.data() + std::size_t(on.path.n) * k);
    return out;
}

void check_columns(const RobotPath& on, const Matrix& rows) {
    if (int(rows.shape(1)) != on.coordinates) throw nb::value_error("one column per coordinate of the robot");
}

// See ik_descend in the package for the meaning of each argument.
void descend(nb::handle robot, int frame, Goals goals, Matrix starts, Matrix more, Matrix posture,
             Array<const double, nb::shape<6>> weights, Array<const double, nb::shape<2, -1>> limits,
             double tolerance, int most_steps, bool newton, int threads, Array<double, nb::ndim<2>> q,
             Array<double, nb::shape<-1, info_width>> info) {
    const RobotPath on = path_on(robot, frame);
    const std::size_t count = goals.shape(0), n = std::size_t(on.path.n);
    for (const Matrix* rows : {&starts, &more, &posture}) check_columns(on, *rows);
    if (q.shape(0) != count || int(q.shape(1)) != on.coordinates || info.shape(0) != count ||
        (starts.shape(0) != count && starts.shape(0) != 1) ||
        (limits.shape(1) != 0 && int(limits.shape(1)) != on.coordinates))
        throw nb::value_error("arrays of matching sizes");
    const std::vector<double> first = gathered(on, starts), further = gathered(on, more);
    ik::Posture wish;
    if (posture.shape(0) == 2) {
        on.gather(posture.data(), wish.rest);
        on.gather(posture.data() + posture.shape(1), wish.weight);
    }
    const std::size_t stride = starts.shape(0) == 1 ? 0 : n;
    const Search search = {on.path,
                           task_of(on, weights, limits, tolerance, most_steps, newton),
                           goals.data(),
                           count,
                           first.data(),
                           stride,
                           further.data(),
                           more.shape(0),
                           posture.shape(0) == 2 ? &wish : nullptr};
    nb::gil_scoped_release free;
    std::vector<double> answers(count * n);
    std::vector<Found> found(count);
    over_rows(count, threads, 4, 64, [&](std::size_t begin, std::size_t end) {
        search_goals(search, begin, end, kernels::ik_descend, answers.data(), found.data());
        return true;
    });
    for (std::size_t k = 0; k < count; ++k) {
        double* row = q.data() + q.shape(1) * k;
        std::copy_n(starts.data() + (stride ? starts.shape(1) * k : 0), q.shape(1), row);
        on.scatter(answers.data() + n * k, row);
        const Found& f = found[k];
        const double values[info_width] = {f.position, f.rotation, double(f.steps), double(f.start),
                                           double(f.ending)};
        std::copy_n(values, info_width, info.data() + info_width * k);
    }
}

// From many starts to one goal; returns how many different solutions q and hits hold.
std::size_t sample(nb::handle robot, int frame, Goal goal, Matrix starts, Matrix wanted,
                   Array<const double, nb::shape<6>> weights, Array<const double, nb::shape<2, -1>> limits,
                   double tolerance, int most_steps, int threads, Array<double, nb::ndim<2>> q,
                   Array<double, nb::ndim<1>> residual, Array<std::int64_t, nb::ndim<1>> hits) {
    const RobotPath on = path_on(robot, frame);
    const std::size_t count = starts.shape(0), n = std::size_t(on.path.n);
    check_columns(on, starts);
    check_columns(on, wanted);
    if (q.shape(0) != count || int(q.shape(1)) != on.coordinates || hits.shape(0) != count ||
        residual.shape(0) != count || wanted.shape(0) != 1 ||
        (limits.shape(1) != 0 && int(limits.shape(1)) != on.coordinates))
        throw nb::value_error("arrays of matching sizes");
    const ik::Task task = task_of(on, weights, limits, tolerance, most_steps, false);
    const std::vector<double> from = gathered(on, starts), near = gathered(on, wanted);
    nb::gil_scoped_release free;
    DescentResults results(count, on.path.n);
    over_rows(count, threads, 4, 64, [&](std::size_t begin, std::size_t end) {
        DescentRows rows = results.rows_for(on.path, task);
        std::vector<std::int64_t> pick(end - begin);
        for (std::size_t k = begin; k < end; ++k) pick[k - begin] = std::int64_t(k);
        rows.pick = pick.data();
        rows.count = pick.size();
        rows.goals = goal.data();
        rows.starts = from.data();
        rows.start_stride = n;
        kernels::ik_descend(rows);
        return true;
    });
    std::vector<double> kept(count * n);
    const std::size_t different = pick_distinct(on.path, task, goal.data(), near.data(), results, kept.data(),
                                                residual.data(), hits.data());
    for (std::size_t k = 0; k < different; ++k) {
        double* row = q.data() + q.shape(1) * k;
        std::copy_n(wanted.data(), q.shape(1), row);
        on.scatter(kept.data() + n * k, row);
    }
    return different;
}

// How many coordinates move a frame; more than a path holds if its joints alone are too many.
int moving(nb::handle robot, int frame) {
    const Chain& chain = chain_on(robot, frame);
    int count = 0;
    for (int i = 0; i < chain.n; ++i) {
        bool known = false;
        for (int k = 0; k < i; ++k) known = known || chain.joints[k].coordinate == chain.joints[i].coordinate;
        count += !known;
    }
    return chain.n > ik::max_path && count <= ik::max_joints ? chain.n : count;
}

}  // namespace

void bind_ik_numeric(nb::module_& m) {
    m.def("_ik_moving", moving, "robot"_a, "frame"_a, "How many coordinates move a frame.");
    m.def("_ik_descend", descend, "robot"_a, "frame"_a, "goals"_a, "starts"_a, "more"_a, "posture"_a,
          "weights"_a, "limits"_a, "tolerance"_a, "most_steps"_a, "newton"_a, "threads"_a, "q"_a, "info"_a,
          "Descends from starts to goals; q and info take the answers.");
    m.def("_ik_sample", sample, "robot"_a, "frame"_a, "goal"_a, "starts"_a, "wanted"_a, "weights"_a,
          "limits"_a, "tolerance"_a, "most_steps"_a, "threads"_a, "q"_a, "residual"_a, "hits"_a,
          "The different solutions that descents from many starts reach; returns their number.");
}
