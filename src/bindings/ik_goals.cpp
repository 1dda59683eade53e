// Goals that leave freedom: plain checked arrays in, one result or filled arrays out.
#include "library/ik_goals.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "ik.hpp"
#include "library/ik_limits.hpp"
#include "library/ik_near_rows.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

// One goal's result. What `about` says of it: the rows of the longer arm of a partial goal, and over how many
// values of a redundant joint its rows are spread.
nb::object to_result(SolverArgument solver, const ik::GoalRequest& request, const ik::GoalAnswer& answer,
                     nb::handle about) {
    if (request.is_partial) about.attr("q") = Doubles({answer.count, request.whole.n}, answer.whole.data());
    about.attr("values") = answer.values;
    about.attr("feasible") = answer.feasible;
    return solutions_from(new_solutions(solver.object, request.goals,
                                        {answer.count, answer.q.data(), request.own, answer.branch.data(),
                                         answer.self_motion.data(), answer.status, answer.complete},
                                        about.ptr()));
}

// Rows of so many numbers, those of each goal in `room` rows, NaN behind them.
Doubles to_rows(const std::vector<ik::GoalAnswer>& answers, std::vector<double> ik::GoalAnswer::* rows,
                int room, int columns) {
    const Doubles out({npy_intp(answers.size()), room, columns});
    std::fill_n(out.data, out.size, std::numeric_limits<double>::quiet_NaN());
    double* row = out.data;
    for (const ik::GoalAnswer& answer : answers) {
        std::copy((answer.*rows).begin(), (answer.*rows).end(), row);
        row += room * columns;
    }
    return out;
}

// q (N, room, n), the longer arm's rows (N, room, columns) of a partial goal or None, count, verdict,
// self_motion (N, room).
nb::object to_arrays(const ik::GoalRequest& request, const std::vector<ik::GoalAnswer>& answers) {
    int room = 1;
    for (const ik::GoalAnswer& answer : answers) room = std::max(room, answer.count);
    const npy_intp N = npy_intp(answers.size());
    const Plain<std::int64_t> count({N});
    const Plain<std::uint8_t> verdict({N});
    const Plain<bool> self_motion({N, room});
    std::fill_n(self_motion.data, self_motion.size, false);
    for (npy_intp i = 0; i < N; ++i) {
        const ik::GoalAnswer& answer = answers[std::size_t(i)];
        std::copy(answer.self_motion.begin(), answer.self_motion.end(), self_motion.data + i * room);
        count.data[i] = answer.count;
        verdict.data[i] = std::uint8_t(int(answer.status) + (answer.complete ? 0 : ik::incomplete));
    }
    nb::object whole = nb::none();
    if (request.is_partial) whole = nb::cast(to_rows(answers, &ik::GoalAnswer::whole, room, request.whole.n));
    return nb::make_tuple(to_rows(answers, &ik::GoalAnswer::q, room, request.own), whole, count, verdict,
                          self_motion);
}

nb::object answer_rows(SolverArgument solver, SolverArgument asked, Goals goals,
                       const std::vector<int>& columns, Row values, int first, bool is_partial,
                       std::optional<Matrix> seeds, int samples, std::optional<std::vector<int>> locked,
                       std::optional<Matrix> at, int threads, bool is_single, nb::handle about) {
    ik::Solver& core = asked.core();
    const int own = solver.core().chain().n;
    const std::size_t n = std::size_t(core.chain().n), N = goals.shape(0);
    const auto require_rows = [N](const std::optional<Matrix>& rows, std::size_t joints) {
        if (rows && (rows->shape(1) != joints || (rows->shape(0) != 1 && rows->shape(0) != N)))
            throw nb::value_error(
                "rows of joints need one number per joint and one row per goal, or one row");
    };
    require_rows(seeds, std::size_t(own));
    require_rows(at, n);
    const int whole = int(columns.size());
    if (columns.size() > std::size_t(ik::max_joints) || values.shape(0) != columns.size() ||
        std::any_of(columns.begin(), columns.end(), [n](int column) { return column >= int(n); }))
        throw nb::value_error("columns and values need one number per joint of the whole arm");
    if (first < 0 || first + own > whole || samples < 1 || locked.has_value() != at.has_value() ||
        (is_single && N != 1))
        throw nb::value_error("samples, locked joints, values and goals do not fit together");
    const ik::GoalRequest request = {goals.data(),
                                     N,
                                     {whole, columns.data(), values.data()},
                                     first,
                                     own,
                                     is_partial,
                                     seeds ? seeds->data() : nullptr,
                                     seeds && seeds->shape(0) != 1,
                                     samples,
                                     locked ? &core.redundant().lock(*locked) : nullptr,
                                     at ? at->data() : nullptr,
                                     at && at->shape(0) != 1,
                                     threads};
    std::vector<ik::GoalAnswer> answers;
    {
        const nb::gil_scoped_release release;
        answers = ik::answer_goals(core, request);
    }
    return is_single ? to_result(solver, request, answers[0], about) : to_arrays(request, answers);
}

Doubles find_nearest_poses(SolverArgument solver, Goals goals, double stiffness, int threads) {
    const Doubles q({npy_intp(goals.shape(0)), solver.arm().dof});
    {
        const nb::gil_scoped_release release;
        ik::nearest_to_goals(solver.arm(), goals.data(), goals.shape(0), stiffness, q.data, threads);
    }
    return q;
}

using Numbers = Plain<std::int64_t>;

Numbers keep_within(SolverArgument solver, const ConstDoubles& q, const ConstDoubles& lower,
                    const ConstDoubles& upper, const Doubles& kept, const Numbers& count,
                    const std::optional<Numbers>& order, double same, double close) {
    const npy_intp n = solver.core().chain().n, rows = q.size / n;
    require_sizes(q.ndim() == 3 && q.shape(2) == n && q.shape(0) == count.size && kept.size == q.size &&
                  lower.size == n && upper.size == n && (!order || order->size == rows));
    const ik::RowsWithin asked = {std::size_t(count.size),
                                  std::size_t(q.shape(1)),
                                  int(n),
                                  solver.core().chain().prismatic,
                                  lower.data,
                                  upper.data,
                                  q.data,
                                  kept.data,
                                  count.data,
                                  order ? order->data : nullptr};
    std::vector<std::int64_t> found;
    {
        const nb::gil_scoped_release release;
        found = ik::keep_within(asked, same, close);
    }
    return Numbers({npy_intp(found.size())}, found.data());
}

// Limits and a seed, as many numbers each as the arm has joints.
ik::NearSeed read_near(SolverArgument solver, const ConstDoubles& lower, const ConstDoubles& upper,
                       const ConstDoubles& seed) {
    const npy_intp n = solver.core().chain().n;
    require_sizes(lower.size == n && upper.size == n && seed.size == n);
    return {lower.data, upper.data, seed.data};
}
Doubles rows_of(SolverArgument solver, const ik::NearRows& sorted) {
    const npy_intp n = solver.core().chain().n;
    return Doubles({npy_intp(sorted.q.size()) / n, n}, sorted.q.data());
}
// The rows within limits, the nearest to a seed first, and whether one is left out that may be on a limit.
nb::tuple sort_near(SolverArgument solver, const ConstDoubles& q, const ConstDoubles& lower,
                    const ConstDoubles& upper, const ConstDoubles& seed, double close) {
    const ik::NearSeed near = read_near(solver, lower, upper, seed);
    require_sizes(q.size % solver.core().chain().n == 0);
    const ik::NearRows sorted =
        ik::sort_rows_near(solver.core().chain(), {q.data, std::size_t(q.size)}, near, close);
    return nb::make_tuple(rows_of(solver, sorted), sorted.is_doubtful);
}
std::optional<Doubles> solve_locked_near(SolverArgument solver, const ConstDoubles& goal,
                                         const ConstDoubles& values, const ConstDoubles& lower,
                                         const ConstDoubles& upper, const ConstDoubles& seed) {
    const ik::NearSeed near = read_near(solver, lower, upper, seed);
    const npy_intp width = npy_intp(solver.core().redundant().default_locked().size());
    require_sizes(goal.size == 16 && width > 0 && values.size % width == 0);
    std::optional<ik::NearRows> found;
    {
        const nb::gil_scoped_release release;
        found =
            ik::solve_locked_near(solver.core(), goal.data, {values.data, std::size_t(values.size)}, near);
    }
    if (!found) return std::nullopt;
    return rows_of(solver, *found);
}

// The rows of all poses (m, dof), and how many each has (n,), −1 for what is not a pose.
std::pair<Doubles, Numbers> solve_each_locked_near(SolverArgument solver, const ConstDoubles& goals,
                                                   const ConstDoubles& values, const ConstDoubles& lower,
                                                   const ConstDoubles& upper, const ConstDoubles& seeds,
                                                   int threads) {
    const npy_intp n = solver.core().chain().n, count = goals.size / 16;
    const npy_intp width = npy_intp(solver.core().redundant().default_locked().size());
    require_sizes(goals.size % 16 == 0 && width > 0 && values.size % width == 0 && lower.size == n &&
                  upper.size == n && seeds.size == count * n);
    std::vector<std::optional<ik::NearRows>> found;
    {
        const nb::gil_scoped_release release;
        found = ik::solve_each_locked_near(solver.core(), {goals.data, std::size_t(goals.size)},
                                           {values.data, std::size_t(values.size)}, lower.data, upper.data,
                                           {seeds.data, std::size_t(seeds.size)}, threads);
    }
    const Numbers counts({count});
    npy_intp rows = 0;
    for (npy_intp k = 0; k < count; ++k) {
        const auto& each = found[std::size_t(k)];
        counts.data[k] = each ? std::int64_t(each->q.size()) / n : -1;
        rows += std::max<npy_intp>(counts.data[k], 0);
    }
    const Doubles q({rows, n});
    double* row = q.data;
    for (const auto& each : found)
        if (each) row = std::copy(each->q.begin(), each->q.end(), row);
    return {q, counts};
}

}  // namespace

void bind_ik_goals(nb::module_& m) {
    m.def("_ik_keep_within", &keep_within, "solver"_a, "q"_a, "lower"_a, "upper"_a, "kept"_a, "count"_a,
          "order"_a.none(), "same"_a, "close"_a,
          "Keeps the rows inside limits; returns the numbers of those that are close to them.");
    m.def("_ik_sort_near", &sort_near, "solver"_a, "q"_a, "lower"_a, "upper"_a, "seed"_a, "close"_a,
          "The rows within limits, the nearest to a seed first; whether one may be on a limit.");
    m.def("_ik_locked_near", &solve_locked_near, "solver"_a, "goal"_a, "values"_a, "lower"_a, "upper"_a,
          "seed"_a,
          "The same of the solutions of a pose at values of the redundant joints; None for what is not a "
          "pose.");
    m.def(
        "_ik_each_locked_near", &solve_each_locked_near, "solver"_a, "goals"_a, "values"_a, "lower"_a,
        "upper"_a, "seeds"_a, "threads"_a,
        "The same of many poses: the rows of all (m, dof), and how many each has (n,), -1 for what is not a "
        "pose.");
    m.def("_ik_answer", &answer_rows, "solver"_a, "asked"_a, "goals"_a, "columns"_a, "values"_a, "first"_a,
          "is_partial"_a, "seeds"_a.none(), "samples"_a, "locked"_a.none(), "at"_a.none(), "threads"_a,
          "is_single"_a, "about"_a,
          "Answers goals that leave freedom: a result for one goal, arrays for many.");
    m.def("_ik_nearest_poses", &find_nearest_poses,
          "The configurations that come nearest to goals out of reach.");
}
