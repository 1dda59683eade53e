// solver.solve(T): the compiled entry. One 4×4 goal without keywords is answered here; everything else goes
// to cspace.ik.solve, which checks it and comes back with plain arrays.
#include <algorithm>
#include <cstring>
#include <limits>

#include "bindings.hpp"
#include "ik_shared.hpp"
#include "kernels/ik_closed_form.hpp"
#include "library/ik_arm.hpp"

using namespace cspace;

const char solve_doc[] =
    R"doc(solve($self, goal=None, *, position=None, rotation=None, direction=None, look_at=None, ray=None, angle_to=None, tool_axis='z', angle=None, near=None, locked=None, swivel=None, samples=None, least_squares=False, threads=None)
--

Every configuration q with fk(q) = goal.

goal: T_base_tip (4, 4) or (..., 4, 4), or anything that as_pose takes. A partial goal gives parts of a pose by
name instead. position (..., 3): of the tip [m], None for coordinates that do not matter, or (..., 2) for a planar
arm. rotation (..., 3, 3). direction (..., 3): where the tool axis points. position can be combined with rotation,
with direction, with angle_to=(axis of the base, angle from it to the tool axis [rad]), and for a planar arm with
angle (...): of the tip [rad]. look_at (..., 3): a point on the tool axis, ahead of the tip. ray=(p, d): the line of
the tool axis, through p along d. tool_axis: in the tip, "x", "-z" or any (3,).

near (dof,) or (..., dof) [rad, m]: the answer is the one solution nearest to it, and joints that a singular pose
leaves free take its values. Limits choose among the multiples of 2π of a joint, not among solutions. locked: values
of locked joints by name or number, {"joint7": 0.3}; arrays of values are solved together with the goals. swivel
[rad]: the arm angle of an arm with two spherical joints (see cs.ik.swivel). samples: the number of values of a
redundant joint at which branches are listed, 16 unless given. least_squares: for an unreachable goal, answer with
the configuration of least error (a radian weighs like the characteristic length of the arm). threads: for a batch,
all cores unless given; the answer does not depend on it.

An arm with more than six joints, or with dependent joints, leaves freedom, which s.freedom names. With locked= for
all redundant joints the answer lists every solution of the others; with near= it is the nearest of all. Otherwise,
with one redundant joint, it lists all branches at values spread over the feasible intervals of that joint; with more,
it is the configuration nearest to the middle of the limits.

Returns Solutions for one goal: q (k, dof) with revolute joints in (-pi, pi], status, reason, complete, residual,
branch, self_motions, freedom, derivative, within(), nearest(), wrapped(). It is falsy if nothing reaches the goal.
Returns SolutionsBatch for many: q (..., k_max, dof) padded with NaN, count (...). Raises InputError for a goal that
is not a pose, and NoClosedFormError for mimic joints, a floating base or more than sixteen joints.)doc";

namespace {

// The solutions as Python sees them; null with an error set.
PyObject* to_python(PyObject* solver, const double* goal, int dof, const ik::Solutions& found) {
    SolutionsObject* made = new_solutions(solver, goal, found.count, dof, found.status);
    if (!made) return nullptr;
    made->complete = found.complete;
    for (int k = 0; k < found.count; ++k) {
        std::memcpy(made->q + k * dof, found.q[k], dof * sizeof(double));
        branches_of(made)[k] = found.branch[k];
        self_motions_of(made)[k] = found.self_motion[k];
    }
    return reinterpret_cast<PyObject*>(made);
}
PyObject* answer_slowly(PyObject* solver, const ik::BuiltArm& arm, const double* goal,
                        const double* unconstrained) {
    return to_python(solver, goal, arm.dof, ik::solve_goal(arm, goal, unconstrained));
}

// The 16 numbers of a float64 4×4 array, in `copy` if they are not contiguous; null if it is something else.
const double* goal_in_place(PyObject* value, double* copy) {
    if (!PyArray_CheckExact(value)) return nullptr;
    auto* array = reinterpret_cast<PyArrayObject*>(value);
    if (PyArray_TYPE(array) != NPY_DOUBLE || PyArray_NDIM(array) != 2 || PyArray_DIM(array, 0) != 4 ||
        PyArray_DIM(array, 1) != 4 || !PyArray_ISBEHAVED_RO(array))
        return nullptr;
    if (PyArray_IS_C_CONTIGUOUS(array)) return static_cast<const double*>(PyArray_DATA(array));
    const npy_intp rows = PyArray_STRIDE(array, 0), columns = PyArray_STRIDE(array, 1);
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            copy[4 * i + j] = *reinterpret_cast<const double*>(PyArray_BYTES(array) + i * rows + j * columns);
    return copy;
}

// Null without an error for an invalid goal.
PyObject* answer_single(PyObject* solver, const ik::BuiltArm& arm, const double* goal) {
    double q[ik::max_branches * 6];
    std::int8_t branch[ik::max_branches];
    int count;
    const ik::FastPath quick = kernels::ik_one(*arm.arm, goal, q, branch, &count);
    if (quick == ik::FastPath::refused) return nullptr;
    if (quick == ik::FastPath::doubtful) return answer_slowly(solver, arm, goal, nullptr);
    SolutionsObject* made =
        new_solutions(solver, goal, count, 6, count ? ik::Status::exact : ik::Status::unreachable);
    if (!made) return nullptr;
    std::memcpy(made->q, q, sizeof(double) * std::size_t(6 * count));
    std::memcpy(branches_of(made), branch, std::size_t(count));
    return reinterpret_cast<PyObject*>(made);
}

// The answer where near= or locked= is the one keyword of one goal; null without an error for what is not
// answered here.
PyObject* answer_keyword(PyObject* solver, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    if (nargs != 1 || !kwnames || PyTuple_GET_SIZE(kwnames) != 1) return nullptr;
    PyObject* name = PyTuple_GET_ITEM(kwnames, 0);
    const bool near = PyUnicode_CompareWithASCIIString(name, "near") == 0;
    if (!near && PyUnicode_CompareWithASCIIString(name, "locked") != 0) return nullptr;
    double copy[16];
    const double* goal = goal_in_place(args[0], copy);
    if (!goal) return nullptr;
    return near ? ik_near(solver, goal, args[1]) : ik_locked(solver, goal, args[1]);
}

}  // namespace

PyObject* solver_solve(PyObject* self, const char* method, PyObject* const* args, Py_ssize_t nargs,
                       PyObject* kwnames) {
    ik::Solver* solver = reinterpret_cast<SolverObject*>(self)->solver.get();
    const ik::BuiltArm* arm = solver ? &solver->arm() : nullptr;
    double copy[16];
    const double* goal = arm && arm->room && nargs == 1 && !kwnames ? goal_in_place(args[0], copy) : nullptr;
    PyObject* answer = goal ? answer_single(self, *arm, goal) : nullptr;
    if (!answer && arm && !PyErr_Occurred()) answer = answer_keyword(self, args, nargs, kwnames);
    if (answer || PyErr_Occurred()) return answer;
    return call_python("cspace.ik.solve", "solve", method, self, args, nargs, kwnames);
}

namespace {

// _ik_room(solver) → rows that a goal's solutions may need; 0 where some joints are redundant
PyObject* room(PyObject*, PyObject* solver) {
    const ik::BuiltArm* arm = arm_of(solver);
    if (arm) return PyLong_FromLong(arm->room);
    PyErr_SetString(PyExc_TypeError, "_ik_room takes a solver");
    return nullptr;
}

// _ik_near_singular(solver, goal (4, 4), unconstrained (n,)) → solutions
PyObject* careful(PyObject*, PyObject* args) {
    PyObject *solver, *goal, *unconstrained;
    if (!PyArg_ParseTuple(args, "OOO", &solver, &goal, &unconstrained)) return nullptr;
    const ik::BuiltArm* arm = arm_of(solver);
    if (!arm || !arm->room || !is_doubles(goal, 16) || !is_doubles(unconstrained, arm->dof)) {
        PyErr_SetString(PyExc_TypeError, "_ik_near_singular takes a solver and contiguous float64 arrays");
        return nullptr;
    }
    return answer_slowly(solver, *arm, data_of(goal), data_of(unconstrained));
}

// _ik_nearest_pose(solver, goal (4, 4), stiffness) → (q, position error [m], rotation error [rad])
PyObject* miss(PyObject*, PyObject* args) {
    PyObject *solver, *goal;
    double stiffness;
    if (!PyArg_ParseTuple(args, "OOd", &solver, &goal, &stiffness)) return nullptr;
    const ik::BuiltArm* arm = arm_of(solver);
    if (!arm || !is_doubles(goal, 16)) {
        PyErr_SetString(PyExc_TypeError, "_ik_nearest_pose takes a solver and a contiguous float64 goal");
        return nullptr;
    }
    const ik::NearestMiss best = ik::nearest_to_goal(*arm, data_of(goal), stiffness);
    npy_intp n = arm->dof;
    PyObject* q = PyArray_SimpleNew(1, &n, NPY_DOUBLE);
    if (!q) return nullptr;
    std::memcpy(data_of(q), best.q, sizeof(double) * std::size_t(n));
    return Py_BuildValue("Ndd", q, best.position, best.rotation);
}

// _ik_exceeds_reach(solver, goal (4, 4)) → whether the lengths and directions of its axes rule the goal out
PyObject* beyond(PyObject*, PyObject* args) {
    PyObject *solver, *goal;
    if (!PyArg_ParseTuple(args, "OO", &solver, &goal)) return nullptr;
    const ik::BuiltArm* arm = arm_of(solver);
    if (!arm || !is_doubles(goal, 16)) {
        PyErr_SetString(PyExc_TypeError, "_ik_exceeds_reach takes a solver and a contiguous float64 goal");
        return nullptr;
    }
    return PyBool_FromLong(solver_of(solver)->exceeds_reach(data_of(goal)));
}

// The arm and the goal of a call about a position; null with an error set.
const ik::BuiltArm* position_arm(PyObject* args, const char* function, PyObject*& solver, Vec3d& p) {
    PyObject* goal;
    if (!PyArg_ParseTuple(args, "OO", &solver, &goal)) return nullptr;
    const ik::BuiltArm* arm = arm_of(solver);
    if (!arm || !arm->has_few_joints || !is_doubles(goal, 3)) {
        PyErr_Format(PyExc_TypeError, "%s takes an arm of up to three joints and a float64 point (3,)",
                     function);
        return nullptr;
    }
    const double* x = data_of(goal);
    p = {x[0], x[1], x[2]};
    return arm;
}

// _ik_position(solver, p (3,)) → solutions
PyObject* position(PyObject*, PyObject* args) {
    PyObject* solver;
    Vec3d p;
    const ik::BuiltArm* arm = position_arm(args, "_ik_position", solver, p);
    if (!arm) return nullptr;
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const double goal[16] = {none, none, none, p.x, none, none, none, p.y,
                             none, none, none, p.z, none, none, none, none};
    return to_python(solver, goal, arm->dof, ik::solve_point(*arm, p));
}

// _ik_nearest_position(solver, p (3,)) → (q that comes nearest (n,), what is missing there [m])
PyObject* position_miss(PyObject*, PyObject* args) {
    PyObject* solver;
    Vec3d p;
    const ik::BuiltArm* arm = position_arm(args, "_ik_nearest_position", solver, p);
    if (!arm) return nullptr;
    const ik::NearestMiss best = ik::nearest_to_point(*arm, p);
    npy_intp n = arm->dof;
    PyObject* q = PyArray_SimpleNew(1, &n, NPY_DOUBLE);
    if (!q) return nullptr;
    std::copy(best.q, best.q + n, data_of(q));
    return Py_BuildValue("Nd", q, best.position);
}

// _ik_single(solver, goal (4, 4)) → solutions, or None for an invalid goal
PyObject* single(PyObject*, PyObject* args) {
    PyObject *solver, *goal;
    if (!PyArg_ParseTuple(args, "OO", &solver, &goal)) return nullptr;
    double copy[16];
    const ik::BuiltArm* arm = arm_of(solver);
    const double* T = goal_in_place(goal, copy);
    if (!arm || !arm->room || !T) {
        PyErr_SetString(PyExc_TypeError, "_ik_single takes a solver and a float64 (4, 4) goal");
        return nullptr;
    }
    PyObject* answer = answer_single(solver, *arm, T);
    if (answer || PyErr_Occurred()) return answer;
    Py_RETURN_NONE;
}

// _ik_geometry(solver) → what the classification saw, for cspace.ik to put into words.
PyObject* geometry(PyObject*, PyObject* solver) {
    const ik::BuiltArm* arm = arm_of(solver);
    if (!arm) Py_RETURN_NONE;
    const ik::ArmGeometry seen = ik::geometry_of(*arm);
    return Py_BuildValue("{s:i,s:O,s:i,s:i,s:O,s:O,s:d,s:d}", "family", seen.family, "general",
                         seen.is_general ? Py_True : Py_False, "virtual_joints", seen.virtual_joints,
                         "first_three", seen.first_three, "reversed", seen.reversed ? Py_True : Py_False,
                         "polish", seen.polish ? Py_True : Py_False, "deviation", seen.deviation, "length",
                         seen.length);
}

PyMethodDef functions[] = {
    {"_ik_build", ik_build, METH_VARARGS, "Reads the arm of a new solver."},
    {"_ik_room", room, METH_O, "Rows that the solutions of a goal may need; 0 for a redundant arm."},
    {"_ik_near_singular", careful, METH_VARARGS,
     "Solves one goal by the careful path, free joints as given."},
    {"_ik_exceeds_reach", beyond, METH_VARARGS, "Whether the axes of an arm alone rule a goal out."},
    {"_ik_nearest_pose", miss, METH_VARARGS, "The configuration that comes nearest to a goal out of reach."},
    {"_ik_follow", ik_follow, METH_VARARGS, "The self-motion through a configuration, as a curve."},
    {"_ik_onto", ik_onto, METH_VARARGS, "Configurations brought onto the self-motion through another one."},
    {"_ik_direction", ik_direction, METH_VARARGS,
     "The direction of the self-motion through a configuration."},
    {"_ik_position", position, METH_VARARGS, "Solves a position goal of an arm of up to three joints."},
    {"_ik_nearest_position", position_miss, METH_VARARGS,
     "The configuration that comes nearest to a position."},
    {"_ik_positions", ik_positions, METH_VARARGS, "Solves many position goals."},
    {"_ik_make", ik_make, METH_VARARGS, "A result from its parts."},
    {"_ik_single", single, METH_VARARGS, "Solves one goal."},
    {"_ik_many", ik_many, METH_VARARGS, "Solves many goals."},
    {"_ik_results", ik_results, METH_O, "Sets the class that results are made of."},
    {"_ik_geometry", geometry, METH_O, "What the classification of an arm saw."},
    {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_ik(nanobind::module_& m) {
    if (ik_add_result_type(m.ptr()) < 0 || PyModule_AddFunctions(m.ptr(), functions) < 0)
        throw nanobind::python_error();
    m.attr("AXIS_RELATION") = tolerance::axis_relation;
}
