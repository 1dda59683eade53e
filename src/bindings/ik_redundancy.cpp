// Arms with redundant joints: plain checked arrays in, filled arrays out.
#include "library/ik_redundancy.hpp"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "ik.hpp"

namespace nb = nanobind;
using namespace cspace;

namespace {

using ik::RedundantSolver;

// A member as a function of the solver.
template <class Result, class... Arguments>
auto of_redundant(Result (RedundantSolver::*member)(Arguments...) const) {
    return [member](SolverArgument solver, Arguments... arguments) -> Result {
        return (solver.core().redundant().*member)(arguments...);
    };
}

// Fills q (N, room, n) with NaN behind the solutions; the solutions themselves stand for what they show.
void solve_rows(SolverArgument solver, const std::vector<int>& locked_joint, Matrix at, Goals goals,
                Row unconstrained, Array<double, nb::ndim<3>> q, Array<std::int8_t, nb::ndim<2>> branch,
                Array<bool, nb::ndim<2>> self_motion, Array<std::int64_t, nb::ndim<1>> count,
                Array<std::uint8_t, nb::ndim<1>> status, int threads) {
    RedundantSolver& arm = solver.core().redundant();
    const ik::LockedArm& locked = arm.lock(locked_joint);
    const std::size_t n = std::size_t(arm.chain().n), N = goals.shape(0), room = q.shape(1);
    require_sizes(at.shape(1) == n && (at.shape(0) == N || at.shape(0) == 1) && has_shape(q, N, room, n) &&
                  has_shape(branch, N, room) && has_shape(self_motion, N, room) && has_shape(count, N) &&
                  has_shape(status, N) && (unconstrained.shape(0) == n || unconstrained.shape(0) == 0));
    const nb::gil_scoped_release release;
    arm.solve(locked, {goals.data(), N, at.data(), at.shape(0) != 1,
                       unconstrained.shape(0) ? unconstrained.data() : nullptr, room, q.data(), branch.data(),
                       self_motion.data(), count.data(), status.data(), threads});
}

// Rows (lower, upper, branch, end below, side, end above, side), a configuration inside each (k, n), and
// whether none is missing.
nb::tuple intervals_of(SolverArgument solver, int parameter, Goal goal) {
    RedundantSolver& arm = solver.core().redundant();
    std::vector<ik::Interval> found;
    bool complete;
    {
        const nb::gil_scoped_release release;
        found = arm.intervals(parameter, goal.data(), complete);
    }
    const int n = arm.chain().n;
    const Doubles q({npy_intp(found.size()), n});
    nb::list rows;
    for (const ik::Interval& i : found) {
        std::copy_n(i.q, n, q.data + n * npy_intp(nb::len(rows)));
        rows.append(nb::make_tuple(i.lower, i.upper, i.branch, i.end[0], i.side[0], i.end[1], i.side[1]));
    }
    return nb::make_tuple(rows, q, complete);
}

// near= is answered by the compiled entry from now on.
void enable_near(SolverArgument solver, nb::handle about) {
    PyObject*& slot = solver_object(solver.object)->nearest_about;
    if (!slot) slot = about.inc_ref().ptr();
}
// locked= with these joints is answered by the compiled entry from now on.
void enable_locked(SolverArgument solver, const std::vector<int>& locked_joint, nb::handle about) {
    SolverObject& slots = *solver_object(solver.object);
    LockedSet made = {0, &solver.core().redundant().lock(locked_joint)};
    for (const int joint : locked_joint) made.joints |= 1u << joint;
    for (const LockedSet& known : slots.locked_sets)
        if (known.joints == made.joints) return;
    if (!slots.locked_about) slots.locked_about = about.inc_ref().ptr();
    slots.locked_sets.push_back(made);
}

// The solver of an arm by the swivel of its elbow.
const RedundantSolver& swivel_solver(const SolverArgument& solver, bool sizes_match) {
    const RedundantSolver& arm = solver.core().redundant();
    if (!arm.has_swivel()) throw nb::value_error("the arm has no swivel");
    require_sizes(sizes_match);
    return arm;
}
void solve_swivels(SolverArgument solver, Goals goals, Row swivels, Array<double, nb::shape<-1, 8, 7>> q) {
    const std::size_t n = swivels.shape(0), N = goals.shape(0);
    const RedundantSolver& arm = swivel_solver(solver, (N == 1 || N == n) && q.shape(0) == n);
    const nb::gil_scoped_release release;
    arm.solve_swivels(goals.data(), N == 1, swivels.data(), n, q.data());
}
void measure_swivels(SolverArgument solver, Array<const double, nb::shape<-1, 7>> q, RowOut out) {
    const RedundantSolver& arm = swivel_solver(solver, out.shape(0) == q.shape(0));
    for (std::size_t i = 0; i < q.shape(0); ++i) out.data()[i] = arm.swivel_at(q.data() + 7 * i);
}

}  // namespace

void bind_ik_redundancy(nb::module_& m) {
    m.def("_ik_default_locked", of_redundant(&RedundantSolver::default_locked),
          "The redundant joints that are locked unless others are named, ascending.");
    m.def("_ik_redundancy_degree", of_redundant(&RedundantSolver::redundant_with),
          "How many dimensions a goal leaves free with these joints locked.");
    m.def("_ik_has_closed_form", of_redundant(&RedundantSolver::has_closed_form),
          "Whether the joints that move have a closed form.");
    m.def("_ik_enable_near", &enable_near, "Answers near= from now on, for one goal without other keywords.");
    m.def("_ik_enable_locked", &enable_locked,
          "Answers locked= with these joints from now on, for one goal without other keywords.");
    m.def("_ik_locked_room", of_redundant(&RedundantSolver::room_for),
          "Rows that the solutions of a goal may need with these joints locked.");
    m.def("_ik_locked_rows", &solve_rows, "Every solution with joints locked at their values.");
    m.def("_ik_intervals", &intervals_of, "The feasible intervals of one joint.");
    m.def("_ik_has_swivel", of_redundant(&RedundantSolver::has_swivel),
          "Whether axes 1, 2, 3 and 5, 6, 7 of an arm of seven revolute joints meet.");
    m.def("_ik_swivel_rows", &solve_swivels, "Every solution at given swivels.");
    m.def("_ik_swivels", &measure_swivels, "The swivel of configurations.");
    m.def("_ik_union", ik::unite_intervals, "Intervals (k, 2) as disjoint ones, ascending.");
    m.def("_ik_spread", ik::spread_values,
          "The middles of n equal parts of all that intervals (k, 2) cover.");
}
