#include "ik_numeric.hpp"

#include <algorithm>

#include "cspace/ik/numeric/search.hpp"
#include "cspace/math/threads.hpp"
#include "kernels/ik.hpp"
#include "robot_path.hpp"

namespace cspace::ik {

namespace {

ik::Task task_on(const RobotPath& on, const DescentTask& given) {
    ik::Task task;
    std::copy_n(given.weights, 6, task.weight);
    task.tolerance = given.tolerance;
    task.most_steps = given.most_steps;
    task.method = given.newton ? ik::Method::newton : ik::Method::levenberg_marquardt;
    task.limited = given.limits != nullptr;
    if (task.limited) {
        on.gather(given.limits, task.lower);
        on.gather(given.limits + on.coordinates, task.upper);
    }
    return task;
}

}  // namespace

void descend_to_goals(const DescentTask& task, const double* goals, std::size_t count, const double* starts,
                      bool start_each, const double* more, std::size_t n_more, const double* posture,
                      double* q, double* info) {
    const RobotPath on(task.chain);
    const std::size_t n = std::size_t(on.path.n), dof = std::size_t(on.coordinates);
    const std::vector<double> first = on.gather_rows(starts, start_each ? count : 1);
    const std::vector<double> further = on.gather_rows(more, n_more);
    ik::Posture wish;
    if (posture) {
        on.gather(posture, wish.rest);
        on.gather(posture + dof, wish.weight);
    }
    const Search search = {
        on.path, task_on(on, task),        goals, count, first.data(), start_each ? n : 0, further.data(),
        n_more,  posture ? &wish : nullptr};
    std::vector<double> answers(count * n);
    std::vector<Found> found(count);
    over_rows(count, task.threads, 4, 64, [&](std::size_t begin, std::size_t end) {
        search_goals(search, begin, end, kernels::ik_descend, answers.data(), found.data());
        return true;
    });
    for (std::size_t k = 0; k < count; ++k) {
        std::copy_n(starts + (start_each ? dof * k : 0), dof, q + dof * k);
        on.scatter(answers.data() + n * k, q + dof * k);
        const Found& f = found[k];
        const DescentEnd& end = f.end;
        const double values[descent_info] = {end.position, end.rotation, double(end.steps), double(f.start),
                                             double(end.ending)};
        std::copy_n(values, descent_info, info + descent_info * k);
    }
}

std::size_t sample_solutions(const DescentTask& given, const double* goal, const double* starts,
                             std::size_t count, const double* wanted, double* q, double* residual,
                             std::int64_t* hits) {
    const RobotPath on(given.chain);
    const std::size_t n = std::size_t(on.path.n), dof = std::size_t(on.coordinates);
    const ik::Task task = task_on(on, given);
    const std::vector<double> from = on.gather_rows(starts, count), near = on.gather_rows(wanted, 1);
    DescentResults results(count, on.path.n);
    over_rows(count, given.threads, 4, 64, [&](std::size_t begin, std::size_t end) {
        DescentRows rows = results.rows_for(on.path, task, begin);
        rows.count = end - begin;
        rows.goals = goal;
        rows.starts = from.data() + n * begin;
        rows.start_stride = n;
        kernels::ik_descend(rows);
        return true;
    });
    std::vector<double> kept(count * n);
    const std::size_t different =
        pick_distinct(on.path, task, goal, near.data(), results, kept.data(), residual, hits);
    for (std::size_t k = 0; k < different; ++k) {
        std::copy_n(wanted, dof, q + dof * k);
        on.scatter(kept.data() + n * k, q + dof * k);
    }
    return different;
}

int moving_coordinates(const model::Chain& chain) {
    int count = 0;
    for (int i = 0; i < chain.n; ++i) {
        bool known = false;
        for (int k = 0; k < i; ++k) known = known || chain.joints[k].coordinate == chain.joints[i].coordinate;
        count += !known;
    }
    return chain.n > ik::max_path && count <= ik::max_joints ? chain.n : count;
}

}  // namespace cspace::ik
