// Goals that leave freedom: plain checked arrays in, one result or filled arrays out.
#include "library/ik_goals.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "ik_shared.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

std::uint8_t verdict_of(const ik::GoalAnswer& answer) {
    return std::uint8_t(int(answer.status) + (answer.complete ? 0 : ik::incomplete));
}

bool was_interrupted() {
    const nb::gil_scoped_acquire acquire;
    return PyErr_CheckSignals() != 0;
}

ik::RowMap row_map(const ik::Solver& core, const std::vector<int>& columns, const Row& values) {
    ik::RowMap whole = {int(columns.size()), {}, {}};
    bool fits = columns.size() <= std::size_t(ik::max_joints) && values.shape(0) == columns.size();
    for (std::size_t j = 0; fits && j < columns.size(); ++j) {
        fits = columns[j] < core.chain().n;
        whole.column[j] = columns[j];
        whole.value[j] = values.data()[j];
    }
    if (!fits) throw nb::value_error("columns and values need one number per joint of the whole arm");
    return whole;
}

nb::object array_of(PyObject* array) {
    if (!array) throw nb::python_error();
    return nb::steal(array);
}
template <class T>
T* fresh(nb::object& array, std::initializer_list<npy_intp> shape, int type) {
    array = array_of(PyArray_SimpleNew(int(shape.size()), const_cast<npy_intp*>(shape.begin()), type));
    return static_cast<T*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array.ptr())));
}

// One goal's result. What `about` says of it: the rows of the longer arm of a partial goal, and over how many
// values of a redundant joint its rows are spread.
nb::object to_result(nb::handle solver, const double* goal, const ik::GoalAnswer& answer, int n, int columns,
                     bool is_partial, nb::handle about) {
    SolutionsObject* made = new_solutions(solver.ptr(), goal, answer.count, n, answer.status);
    if (!made) throw nb::python_error();
    nb::object result = nb::steal(reinterpret_cast<PyObject*>(made));
    made->complete = answer.complete;
    std::copy(answer.q.begin(), answer.q.end(), made->q);
    std::copy(answer.branch.begin(), answer.branch.end(), branches_of(made));
    std::copy(answer.self_motion.begin(), answer.self_motion.end(), self_motions_of(made));
    if (is_partial) {
        nb::object whole;
        std::copy(answer.whole.begin(), answer.whole.end(),
                  fresh<double>(whole, {answer.count, columns}, NPY_DOUBLE));
        about.attr("q") = whole;
    }
    about.attr("values") = answer.values;
    about.attr("feasible") = answer.feasible;
    made->about = about.inc_ref().ptr();
    return result;
}

// q (N, room, n), the longer arm's rows (N, room, columns) of a partial goal or None, count, verdict,
// self_motion (N, room).
nb::object to_arrays(const std::vector<ik::GoalAnswer>& answers, int n, int columns, bool is_partial) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    int room = 1;
    for (const ik::GoalAnswer& answer : answers) room = std::max(room, answer.count);
    const npy_intp N = npy_intp(answers.size());
    nb::object q, whole = nb::none(), count, verdict, self_motion;
    double* row = fresh<double>(q, {N, room, n}, NPY_DOUBLE);
    double* whole_row = is_partial ? fresh<double>(whole, {N, room, columns}, NPY_DOUBLE) : nullptr;
    auto* counts = fresh<std::int64_t>(count, {N}, NPY_INT64);
    auto* verdicts = fresh<std::uint8_t>(verdict, {N}, NPY_UINT8);
    auto* flags = fresh<bool>(self_motion, {N, room}, NPY_BOOL);
    std::fill(flags, flags + N * room, false);
    for (npy_intp i = 0; i < N; ++i) {
        const ik::GoalAnswer& answer = answers[std::size_t(i)];
        std::fill(std::copy(answer.q.begin(), answer.q.end(), row), row + room * n, none);
        row += room * n;
        std::copy(answer.self_motion.begin(), answer.self_motion.end(), flags + i * room);
        if (whole_row) {
            std::fill(std::copy(answer.whole.begin(), answer.whole.end(), whole_row),
                      whole_row + room * columns, none);
            whole_row += room * columns;
        }
        counts[i] = answer.count;
        verdicts[i] = verdict_of(answer);
    }
    return nb::make_tuple(q, whole, count, verdict, self_motion);
}

nb::object answer(nb::handle solver, nb::handle asked, Goals goals, const std::vector<int>& columns,
                  Row values, int first, bool is_partial, std::optional<Matrix> seeds, int samples,
                  std::optional<std::vector<int>> locked, std::optional<Matrix> at, int threads,
                  bool is_single, nb::handle about) {
    ik::Solver *core = solver_of(asked.ptr()), *own = solver_of(solver.ptr());
    if (!core || !own) throw nb::type_error("a solver and the one asked come first");
    const std::size_t n = std::size_t(core->chain().n), N = goals.shape(0);
    const auto require_rows = [N](const std::optional<Matrix>& rows, std::size_t joints) {
        if (rows && (rows->shape(1) != joints || (rows->shape(0) != 1 && rows->shape(0) != N)))
            throw nb::value_error(
                "rows of joints need one number per joint and one row per goal, or one row");
    };
    require_rows(seeds, std::size_t(own->chain().n));
    require_rows(at, n);
    if (first < 0 || std::size_t(first + own->chain().n) > columns.size() || samples < 1 ||
        locked.has_value() != at.has_value() || (is_single && N != 1))
        throw nb::value_error("samples, locked joints, values and goals do not fit together");
    const ik::GoalRequest request = {goals.data(),
                                     N,
                                     row_map(*core, columns, values),
                                     first,
                                     own->chain().n,
                                     is_partial,
                                     seeds ? seeds->data() : nullptr,
                                     seeds && seeds->shape(0) != 1,
                                     samples,
                                     locked ? &core->redundant().lock(*locked) : nullptr,
                                     at ? at->data() : nullptr,
                                     at && at->shape(0) != 1,
                                     threads,
                                     was_interrupted};
    std::vector<ik::GoalAnswer> answers;
    {
        const nb::gil_scoped_release release;
        answers = ik::answer_goals(*core, request);
    }
    if (answers.size() != N) throw nb::python_error();
    return is_single
               ? to_result(solver, goals.data(), answers[0], request.own, request.whole.n, is_partial, about)
               : to_arrays(answers, request.own, request.whole.n, is_partial);
}

nb::object nearest_poses(nb::handle solver, Goals goals, double stiffness, int threads) {
    ik::Solver* core = solver_of(solver.ptr());
    if (!core) throw nb::type_error("a solver comes first");
    const npy_intp n = core->chain().n;
    nb::object out;
    double* q = fresh<double>(out, {npy_intp(goals.shape(0)), n}, NPY_DOUBLE);
    const nb::gil_scoped_release release;
    ik::nearest_to_goals(core->arm(), goals.data(), goals.shape(0), stiffness, q, threads);
    return out;
}

}  // namespace

void bind_ik_goals(nb::module_& m) {
    m.def("_ik_answer", &answer, "solver"_a, "asked"_a, "goals"_a, "columns"_a, "values"_a, "first"_a,
          "is_partial"_a, "seeds"_a.none(), "samples"_a, "locked"_a.none(), "at"_a.none(), "threads"_a,
          "is_single"_a, "about"_a,
          "Answers goals that leave freedom: a result for one goal, arrays for many.");
    m.def("_ik_nearest_poses", &nearest_poses, "solver"_a, "goals"_a, "stiffness"_a, "threads"_a,
          "The configurations that come nearest to goals out of reach.");
}
