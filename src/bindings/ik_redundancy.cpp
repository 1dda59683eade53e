// Arms with redundant joints: plain checked arrays in, filled arrays out.
#include "library/ik_redundancy.hpp"

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "ik_chains.hpp"
#include "ik_shared.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

using ik::RedundantSolver;

void make_solver(RedundantSolver* at, Matrix axes, Matrix points, Array<const bool, nb::ndim<1>> prismatic,
                 Goal T_zero, Row lower, Row upper, Row weight) {
    const int n = int(axes.shape(0));
    if (n < 1 || n > ik::max_joints || axes.shape(1) != 3 || points.shape(1) != 3 ||
        int(points.shape(0)) != n || int(prismatic.shape(0)) != n)
        throw nb::value_error("one to sixteen joints, with as many axes, points and types");
    const ik::Chain chain = chain_from(n, axes.data(), points.data(), prismatic.data(), T_zero.data());
    for (const Row& row : {lower, upper, weight})
        if (int(row.shape(0)) != n) throw nb::value_error("limits and weights need one number per joint");
    new (at) RedundantSolver(chain, lower.data(), upper.data(), weight.data());
}

void require_sizes(bool fit) {
    if (!fit) throw nb::value_error("arrays of matching sizes are needed");
}

// Fills q (N, room, n) with NaN behind the solutions; the solutions themselves stand for what they show.
void solve_rows(RedundantSolver& solver, const std::vector<int>& locked_joint, Matrix at, Goals goals,
                Row unconstrained, Array<double, nb::ndim<3>> q, Array<std::int8_t, nb::ndim<2>> branch,
                Array<bool, nb::ndim<2>> self_motion, Array<std::int64_t, nb::ndim<1>> count,
                Array<std::uint8_t, nb::ndim<1>> status, int threads) {
    const ik::LockedArm& locked = solver.lock(locked_joint);
    const std::size_t n = std::size_t(solver.chain().n), N = goals.shape(0), room = q.shape(1);
    require_sizes(at.shape(1) == n && (at.shape(0) == N || at.shape(0) == 1) && q.shape(0) == N &&
                  q.shape(2) == n && branch.shape(0) == N && self_motion.shape(0) == N &&
                  branch.shape(1) == room && self_motion.shape(1) == room && count.shape(0) == N &&
                  status.shape(0) == N && (unconstrained.shape(0) == n || unconstrained.shape(0) == 0));
    const nb::gil_scoped_release release;
    solver.solve(locked, {goals.data(), N, at.data(), at.shape(0) != 1,
                          unconstrained.shape(0) ? unconstrained.data() : nullptr, room, q.data(),
                          branch.data(), self_motion.data(), count.data(), status.data(), threads});
}

void nearest_rows(const RedundantSolver& solver, Goals goals, Matrix seeds, Array<double, nb::ndim<2>> q,
                  Array<bool, nb::ndim<1>> found, int threads) {
    const std::size_t n = std::size_t(solver.chain().n), N = goals.shape(0);
    require_sizes(seeds.shape(1) == n && (seeds.shape(0) == N || seeds.shape(0) == 1) && q.shape(0) == N &&
                  q.shape(1) == n && found.shape(0) == N);
    const nb::gil_scoped_release release;
    solver.find_nearest(goals.data(), N, seeds.data(), seeds.shape(0) != 1, q.data(), found.data(), threads);
}

// Per interval: (lower, upper, branch, what ends it below, at which side, what ends it above, at which side),
// and a configuration inside; and whether none is missing.
using IntervalRow = std::tuple<double, double, int, int, int, int, int, std::vector<double>>;
std::tuple<std::vector<IntervalRow>, bool> intervals_of(RedundantSolver& solver, int parameter, Goal goal) {
    bool complete;
    std::vector<ik::FeasibleInterval> found;
    {
        const nb::gil_scoped_release release;
        found = solver.intervals(parameter, goal.data(), complete);
    }
    std::vector<IntervalRow> rows;
    for (ik::FeasibleInterval& i : found)
        rows.emplace_back(i.lower, i.upper, i.branch, i.end[0], i.side[0], i.end[1], i.side[1],
                          std::move(i.q));
    return {std::move(rows), complete};
}

// All solutions at the values of one locked joint: q (m, 16, n), NaN behind them.
bool sweep_rows(RedundantSolver& solver, int parameter, Goal goal, Row at, Row values,
                Array<double, nb::ndim<3>> q, Array<std::int8_t, nb::ndim<2>> branch,
                Array<std::int64_t, nb::ndim<1>> count) {
    const std::size_t n = std::size_t(solver.chain().n), m = values.shape(0);
    constexpr std::size_t room = ik::max_solutions;
    require_sizes(at.shape(0) == n && q.shape(0) == m && q.shape(1) == room && q.shape(2) == n &&
                  branch.shape(0) == m && branch.shape(1) == room && count.shape(0) == m);
    return solver.sweep(parameter, goal.data(), at.data(), values.data(), m, q.data(), branch.data(),
                        count.data());
}

}  // namespace

void bind_ik_redundancy(nb::module_& m) {
    nb::class_<RedundantSolver>(m, "RedundantSolver", "Inverse kinematics of an arm with joints to spare.")
        .def("__init__", &make_solver, "axes"_a, "points"_a, "prismatic"_a, "T_zero"_a, "lower"_a, "upper"_a,
             "weight"_a, "Builds the solver from screws at zero, limits, and weights of distances (n,).")
        .def_prop_ro("locked", &RedundantSolver::default_locked,
                     "The joints held unless others are named, ascending.")
        .def_prop_ro("redundancy_degree", &RedundantSolver::redundant_joints,
                     "Joints beyond those that the tip needs to move as it can.")
        .def("redundancy_degree_with", &RedundantSolver::redundant_with, "locked"_a,
             "How many dimensions stay free with joints held.")
        .def_prop_ro("closed_form", &RedundantSolver::has_closed_form,
                     "Whether the joints that move have a closed form.")
        .def(
            "serve_near",
            [](nb::handle self, nb::handle robot, nb::handle about) {
                if (!PyObject_TypeCheck(robot.ptr(), robot_type)) throw nb::type_error("a robot comes first");
                ik_set_near(robot.ptr(), &nb::cast<const RedundantSolver&>(self), self.ptr(), about.ptr());
            },
            "robot"_a, "about"_a,
            "Answers near= of this robot from now on, for one goal without other keywords.")
        .def(
            "serve_locked",
            [](nb::handle self, nb::handle robot, const std::vector<int>& locked_joint, nb::handle about) {
                if (!PyObject_TypeCheck(robot.ptr(), robot_type)) throw nb::type_error("a robot comes first");
                const nb::object names = robot.attr("joint_names");
                auto& solver = nb::cast<RedundantSolver&>(self);
                if (!PyTuple_CheckExact(names.ptr()) || int(nb::len(names)) != solver.chain().n)
                    throw nb::type_error("the solver is that of the robot's joints");
                ik_add_locked(robot.ptr(), self.ptr(), names.ptr(), about.ptr(), locked_joint,
                              &solver.lock(locked_joint));
            },
            "robot"_a, "locked"_a, "about"_a,
            "Answers locked= with these joints from now on, for one goal without other keywords.")
        .def(
            "room",
            [](RedundantSolver& solver, const std::vector<int>& locked_joint) {
                return solver.room_for(solver.lock(locked_joint));
            },
            "locked"_a, "Rows that the solutions of a goal may need.")
        .def("solve", &solve_rows, "locked"_a, "at"_a, "goals"_a, "unconstrained"_a, "q"_a, "branch"_a,
             "self_motion"_a, "count"_a, "status"_a, "threads"_a,
             "Every solution with joints held at their values.")
        .def("nearest", &nearest_rows, "goals"_a, "seeds"_a, "q"_a, "found"_a, "threads"_a,
             "The nearest configuration to each seed.")
        .def("intervals", &intervals_of, "parameter"_a, "goal"_a,
             "The feasible intervals of one locked joint.")
        .def("sweep", &sweep_rows, "parameter"_a, "goal"_a, "at"_a, "values"_a, "q"_a, "branch"_a, "count"_a,
             "Every solution at many values of one locked joint; whether none is missing.");
}
