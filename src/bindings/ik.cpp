// solver.solve(T): the compiled entry. One 4×4 goal without keywords is answered here; everything else goes
// to cspace.ik.solve, which checks it and comes back with plain arrays.
#include "ik.hpp"

#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "arrays.hpp"
#include "bindings.hpp"
#include "library/ik_arm.hpp"

namespace nb = nanobind;
using namespace cspace;

const char solve_doc[] =
    R"doc(solve($self, goal=None, *, position=None, rotation=None, direction=None, look_at=None, ray=None, angle_to=None, tool_axis='z', angle=None, near=None, limits=None, locked=None, swivel=None, samples=None, least_squares=False, threads=None)
--

Every configuration q with fk(q) = goal.

goal: T_base_tip (4, 4) or (..., 4, 4), or anything that as_pose takes. A partial goal gives parts of a pose by
name instead. position (..., 3): of the tip [m], None for coordinates that do not matter, or (..., 2) for a planar
arm. rotation (..., 3, 3). direction (..., 3): where the tool axis points. position can be combined with rotation,
with direction, with angle_to=(axis of the base, angle from it to the tool axis [rad]), and for a planar arm with
angle (...): of the tip [rad]. look_at (..., 3): a point on the tool axis, ahead of the tip. ray=(p, d): the line of
the tool axis, through p along d. tool_axis: in the tip, "x", "-z" or any (3,).

near (dof,) or (..., dof) [rad, m]: the answer is the one solution within limits that is nearest to it, or none, with
the reason, if none is within limits. Joints that a singular pose leaves free take its values. limits: those that near=
keeps; the arm's own unless given, False for none, or Limits. locked: values of locked joints by name or number,
{"joint7": 0.3}; arrays of values are solved together with the goals. swivel [rad]: the arm angle of an arm with two spherical joints (see cs.ik.swivel). samples: the number of values of a
redundant joint at which branches are listed, 16 unless given. least_squares: for an unreachable goal, answer with
the configuration of least error (a radian weighs like the characteristic length of the arm). threads: for a batch,
all cores unless given; the answer does not depend on it.

An arm with more than six joints, or with dependent joints, leaves freedom, which s.freedom names. With locked= for
all redundant joints the answer lists every solution of the others; with near= it is the nearest of all within
limits. Otherwise, with one redundant joint, it lists all branches at values spread over the feasible intervals of that joint; with more,
it is the configuration nearest to the middle of the limits.

Returns Solutions for one goal: q (k, dof) with revolute joints in (-pi, pi], or as locked, or within limits where it
is one configuration that was chosen among infinitely many; status, reason, complete, residual,
branch, self_motions, freedom, derivative, within(), nearest(), wrapped(). It is falsy if nothing reaches the goal.
Returns SolutionsBatch for many: q (..., k_max, dof) padded with NaN, count (...). Type checkers know which of the two
it is for lists and for arrays whose number of axes they know (np.eye(4)), and accept either for other arrays.
Raises InputError for a goal that is not a pose, and NoClosedFormError for mimic joints, a floating base or more than sixteen joints.)doc";

namespace {

constexpr int most_threads = 1024;

// Null without an error for an invalid goal.
PyObject* answer_single(PyObject* solver, const ik::BuiltArm& arm, const double* goal,
                        const double* unconstrained = nullptr) {
    ik::SolutionStore store;
    ik::SolutionRows rows;
    return ik::list_solutions(arm, goal, unconstrained, store, rows) ? new_solutions(solver, goal, rows)
                                                                     : nullptr;
}

// The answer where near=, near= with limits=False, or locked= stands beside one goal; null without an error
// for what is not answered here.
PyObject* answer_keyword(PyObject* solver, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    if (nargs != 1 || !kwnames) return nullptr;
    PyObject *near = nullptr, *limits = nullptr, *locked = nullptr;
    for (Py_ssize_t k = 0; k < PyTuple_GET_SIZE(kwnames); ++k) {
        const auto is = [name = PyTuple_GET_ITEM(kwnames, k)](const char* word) {
            return PyUnicode_CompareWithASCIIString(name, word) == 0;
        };
        PyObject** const slot = is("near")     ? &near
                                : is("limits") ? &limits
                                : is("locked") ? &locked
                                               : nullptr;
        if (!slot) return nullptr;
        *slot = args[1 + k];
    }
    if (!near == !locked || (limits && (limits != Py_False || locked))) return nullptr;
    double copy[16];
    const double* goal = read_in_place(args[0], 4, 4, copy);
    if (!goal) return nullptr;
    return near ? solve_near(solver, goal, near, !limits) : solve_locked(solver, goal, locked);
}

}  // namespace

PyObject* solver_solve(PyObject* self, const char* method, PyObject* const* args, Py_ssize_t nargs,
                       PyObject* kwnames) {
    ik::Solver* core = solver_object(self)->core.get();
    const ik::BuiltArm* arm = core ? &core->arm() : nullptr;
    double copy[16];
    const double* goal =
        arm && arm->room && nargs == 1 && !kwnames ? read_in_place(args[0], 4, 4, copy) : nullptr;
    PyObject* answer = goal ? answer_single(self, *arm, goal) : nullptr;
    if (!answer && arm && !PyErr_Occurred()) answer = answer_keyword(self, args, nargs, kwnames);
    if (answer || PyErr_Occurred()) return answer;
    return call_python("cspace.ik.solve", "solve", method, self, args, nargs, kwnames);
}

namespace {

const ik::BuiltArm& arm_for_points(const SolverArgument& solver, bool sizes_match) {
    if (!solver.arm().has_few_joints || !sizes_match)
        throw nb::type_error("points (3,) take an arm of up to three joints");
    return solver.arm();
}

nb::object solve_single(SolverArgument solver, nb::handle goal) {
    double copy[16];
    const double* T = read_in_place(goal.ptr(), 4, 4, copy);
    require_sizes(solver.arm().room && T);
    PyObject* answer = answer_single(solver.object, solver.arm(), T);
    return answer || PyErr_Occurred() ? solutions_from(answer) : nb::none();
}

nb::object solve_near_singular(SolverArgument solver, const ConstDoubles& goal,
                               const ConstDoubles& unconstrained) {
    const ik::BuiltArm& arm = solver.arm();
    require_sizes(arm.room && goal.size == 16 && unconstrained.size == arm.dof);
    PyObject* answer = answer_single(solver.object, arm, goal.data, unconstrained.data);
    return answer || PyErr_Occurred() ? solutions_from(answer) : nb::none();
}

std::tuple<Doubles, double, double> find_nearest_pose(SolverArgument solver, const ConstDoubles& goal,
                                                      double stiffness) {
    require_sizes(goal.size == 16);
    const ik::NearestPose best = ik::nearest_to_goal(solver.arm(), goal.data, stiffness);
    return {Doubles({solver.arm().dof}, best.q), best.position, best.rotation};
}

nb::object solve_position(SolverArgument solver, const ConstDoubles& p) {
    const ik::BuiltArm& arm = arm_for_points(solver, p.size == 3);
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const double goal[16] = {none, none, none, p.data[0], none, none, none, p.data[1],
                             none, none, none, p.data[2], none, none, none, none};
    const ik::Solutions found = ik::solve_point(arm, {p.data[0], p.data[1], p.data[2]});
    return solutions_from(new_solutions(solver.object, goal, ik::rows_of(found)));
}

std::tuple<Doubles, double> find_nearest_position(SolverArgument solver, const ConstDoubles& p) {
    const ik::BuiltArm& arm = arm_for_points(solver, p.size == 3);
    const ik::NearestPose best = ik::nearest_to_point(arm, {p.data[0], p.data[1], p.data[2]});
    return {Doubles({arm.dof}, best.q), best.position};
}

// Goals (n, 4, 4) or points (n, 3) into q (n, k_max, dof), count (n,) and status (n,). Returns the index of
// the first goal refused, or n.
template <int numbers, auto solve>
std::size_t solve_many(SolverArgument solver, const ConstDoubles& goals, const Doubles& q,
                       const Plain<std::int64_t>& count, const Plain<std::uint8_t>& status, int threads) {
    const ik::BuiltArm& arm = numbers == 3 ? arm_for_points(solver, true) : solver.arm();
    const npy_intp n = count.size;
    require_sizes(arm.room && goals.size == numbers * n && q.size == n * arm.room * arm.dof &&
                  status.size == n);
    const nb::gil_scoped_release release;
    return solve(arm, {goals.data, std::size_t(n), q.data, count.data, status.data,
                       std::clamp(threads, 1, most_threads)});
}

}  // namespace

void bind_ik(nb::module_& m) {
    m.attr("AXIS_RELATION") = tolerance::axis_relation;
    m.def(
        "_ik_room", [](SolverArgument solver) { return solver.arm().room; },
        "Rows that the solutions of a goal may need; 0 for a redundant arm.");
    m.def("_ik_single", solve_single, "Every solution of one goal; None for one that is not a pose.");
    m.def("_ik_near_singular", solve_near_singular,
          "The same with values of the joints that the goal leaves free.");
    m.def("_ik_nearest_pose", find_nearest_pose,
          "The configuration that comes nearest to a goal out of reach, and its errors [m], [rad].");
    m.def("_ik_position", solve_position, "Solves a position goal of an arm of up to three joints.");
    m.def("_ik_nearest_position", find_nearest_position,
          "The configuration that comes nearest to a position, and its error [m].");
    m.def("_ik_many", solve_many<16, ik::solve_goals>,
          "Solves many goals; returns the index of the first that is not a pose.");
    m.def("_ik_positions", solve_many<3, ik::solve_points>, "Solves many position goals, likewise.");
}
