// robot.ik(T): the compiled entry. One 4×4 goal without keywords is answered here; everything else goes to
// cspace.ik, which finds the words and comes back with plain arrays.
#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#include "bindings.hpp"
#include "ik_chains.hpp"
#include "ik_shared.hpp"
#include "kernels/ik_closed_form.hpp"
#include "library/ik_arm.hpp"

using namespace cspace;

const char robot_ik_doc[] =
    R"doc(ik($self, goal=None, *, position=None, rotation=None, direction=None, look_at=None, ray=None, angle_to=None, tool_axis='z', angle=None, near=None, locked=None, swivel=None, samples=None, least_squares=False, threads=None)
--

Every configuration q with fk(q) = goal.

goal: T_base_tip (4, 4) or (..., 4, 4), or anything as_pose takes. Instead of it parts of a pose by name:
position (..., 3) [m], None for coordinates that do not matter, or (..., 2) for an arm in the plane; rotation
(3, 3); direction (3,) of the tool axis; position with rotation, direction, angle_to=(axis of the base, angle of
the tool axis to it [rad]) or, in the plane, angle [rad]; look_at (3,), a point ahead on the tool axis; ray=(p,
d), the line on which the tool axis lies. tool_axis: "x", "y", "z", "-z" or a direction in the tip. near (dof,)
[rad, m]: the answer is the one solution nearest to it, and joints that the pose leaves free take its values.
locked: joints held at given values, {"joint7": 0.3}, by name or number. swivel [rad]: of the elbow of an arm with
two spherical joints. samples: of an arm with one joint to spare, at how many of its values the branches are
listed (16). least_squares: where nothing reaches the goal, answer with the configuration that misses it least.
threads: of a batch, all cores unless given.

Returns Solutions for one goal: q (k, dof) with revolute joints in (-pi, pi], status, reason, complete, residual,
branch, self_motions, freedom, derivative, within(), nearest(), wrapped(); falsy if nothing reaches the goal. Returns
SolutionsBatch for many: q (..., k_max, dof) padded with NaN, count (...). Raises InputError for what is no goal,
NoClosedFormError for an arm that this version does not solve.)doc";

namespace {

// The solutions as Python sees them; null with an error set.
PyObject* to_python(PyObject* robot, const double* goal, int dof, const ik::Solutions& found) {
    SolutionsObject* made = new_solutions(robot, goal, found.count, dof, found.status);
    if (!made) return nullptr;
    made->complete = found.complete;
    for (int k = 0; k < found.count; ++k) {
        std::memcpy(made->q + k * dof, found.q[k], dof * sizeof(double));
        branches_of(made)[k] = found.branch[k];
        self_motions_of(made)[k] = found.self_motion[k];
    }
    return reinterpret_cast<PyObject*>(made);
}
PyObject* answer_slowly(PyObject* robot, const ik::BuiltArm& arm, const double* goal,
                        const double* unconstrained) {
    return to_python(robot, goal, arm.dof, ik::solve_goal(arm, goal, unconstrained));
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

// Null without an error for a goal that is no pose.
PyObject* answer_single(PyObject* robot, const ik::BuiltArm& arm, const double* goal) {
    double q[ik::max_branches * 6];
    std::int8_t branch[ik::max_branches];
    int count;
    const ik::FastPath quick = kernels::ik_one(*arm.arm, goal, q, branch, &count);
    if (quick == ik::FastPath::refused) return nullptr;
    if (quick == ik::FastPath::doubtful) return answer_slowly(robot, arm, goal, nullptr);
    SolutionsObject* made =
        new_solutions(robot, goal, count, 6, count ? ik::Status::exact : ik::Status::unreachable);
    if (!made) return nullptr;
    std::memcpy(made->q, q, sizeof(double) * std::size_t(6 * count));
    std::memcpy(branches_of(made), branch, std::size_t(count));
    return reinterpret_cast<PyObject*>(made);
}

const char words[] = "cspace.ik.solve";

// The answer where near= or locked= is the one keyword beside one goal; null without an error for what is not
// answered here.
PyObject* answer_keyword(PyObject* robot, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    const auto* self = reinterpret_cast<RobotObject*>(robot);
    if ((!self->near && !self->locked) || nargs != 1 || !kwnames || PyTuple_GET_SIZE(kwnames) != 1)
        return nullptr;
    double copy[16];
    PyObject* name = PyTuple_GET_ITEM(kwnames, 0);
    if (PyUnicode_CompareWithASCIIString(name, "near") == 0) {
        const double* goal = self->near ? goal_in_place(args[0], copy) : nullptr;
        return goal ? ik_near(robot, goal, args[1]) : nullptr;
    }
    if (PyUnicode_CompareWithASCIIString(name, "locked") != 0) return nullptr;
    const double* goal = self->locked ? goal_in_place(args[0], copy) : nullptr;
    return goal ? ik_locked(robot, goal, args[1]) : nullptr;
}

}  // namespace

PyObject* robot_ik(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    double copy[16];
    const auto* arm = static_cast<const ik::BuiltArm*>(reinterpret_cast<RobotObject*>(self)->ik.get());
    const double* goal = arm && arm->room && nargs == 1 && !kwnames ? goal_in_place(args[0], copy) : nullptr;
    if (goal) {
        PyObject* answer = answer_single(self, *arm, goal);
        if (answer || PyErr_Occurred()) return answer;
    }
    PyObject* answer = answer_keyword(self, args, nargs, kwnames);
    if (answer || PyErr_Occurred()) return answer;
    return robot_call_python(words, "inverse_kinematics", "ik", self, args, nargs, kwnames);
}

namespace {

// _ik_build(robot, axes (n, 3), points (n, 3), prismatic (n,), T_zero (4, 4)) → rows that a goal's solutions
// may need; 0 if nothing solves the arm
PyObject* build(PyObject*, PyObject* args) {
    PyObject *robot, *axes, *points, *prismatic, *tip;
    if (!PyArg_ParseTuple(args, "OOOOO", &robot, &axes, &points, &prismatic, &tip)) return nullptr;
    const npy_intp n =
        PyArray_Check(prismatic) ? PyArray_SIZE(reinterpret_cast<PyArrayObject*>(prismatic)) : -1;
    if (n < 1 || n > ik::max_joints || !is_doubles(axes, 3 * n) || !is_doubles(points, 3 * n) ||
        !is_doubles(prismatic, n) || !is_doubles(tip, 16)) {
        PyErr_SetString(PyExc_TypeError, "_ik_build takes contiguous float64 arrays of matching sizes");
        return nullptr;
    }
    if (!PyObject_TypeCheck(robot, robot_type)) {
        PyErr_SetString(PyExc_TypeError, "_ik_build takes a robot");
        return nullptr;
    }
    // Two threads may both come here first: the later one takes what the earlier one built and may be using.
    if (const ik::BuiltArm* built = arm_of(robot)) return PyLong_FromLong(built->room);
    const ik::Chain chain =
        chain_from(int(n), data_of(axes), data_of(points), data_of(prismatic), data_of(tip));
    auto arm = std::make_shared<ik::BuiltArm>(ik::build_arm(chain));
    const int room = arm->room;
    reinterpret_cast<RobotObject*>(robot)->ik = std::move(arm);
    return PyLong_FromLong(room);
}

// _ik_near_singular(robot, goal (4, 4), unconstrained (n,)) → solutions
PyObject* careful(PyObject*, PyObject* args) {
    PyObject *robot, *goal, *unconstrained;
    if (!PyArg_ParseTuple(args, "OOO", &robot, &goal, &unconstrained)) return nullptr;
    const ik::BuiltArm* arm = arm_of(robot);
    if (!arm || !arm->room || !is_doubles(goal, 16) || !is_doubles(unconstrained, arm->dof)) {
        PyErr_SetString(PyExc_TypeError,
                        "_ik_near_singular takes a robot with a solver and contiguous float64 arrays");
        return nullptr;
    }
    return answer_slowly(robot, *arm, data_of(goal), data_of(unconstrained));
}

// _ik_nearest_pose(robot, goal (4, 4), stiffness) → (q, position error [m], rotation error [rad])
PyObject* miss(PyObject*, PyObject* args) {
    PyObject *robot, *goal;
    double stiffness;
    if (!PyArg_ParseTuple(args, "OOd", &robot, &goal, &stiffness)) return nullptr;
    const ik::BuiltArm* arm = arm_of(robot);
    if (!arm || !is_doubles(goal, 16)) {
        PyErr_SetString(PyExc_TypeError,
                        "_ik_nearest_pose takes a robot with a solver and a contiguous float64 goal");
        return nullptr;
    }
    const ik::NearestMiss best = ik::nearest_to_goal(*arm, data_of(goal), stiffness);
    npy_intp n = arm->dof;
    PyObject* q = PyArray_SimpleNew(1, &n, NPY_DOUBLE);
    if (!q) return nullptr;
    std::memcpy(data_of(q), best.q, sizeof(double) * std::size_t(n));
    return Py_BuildValue("Ndd", q, best.position, best.rotation);
}

// _ik_exceeds_reach(robot, goal (4, 4)) → whether the lengths and directions of its axes rule the goal out
PyObject* beyond(PyObject*, PyObject* args) {
    PyObject *robot, *goal;
    if (!PyArg_ParseTuple(args, "OO", &robot, &goal)) return nullptr;
    const ik::BuiltArm* arm = arm_of(robot);
    if (!arm || !is_doubles(goal, 16)) {
        PyErr_SetString(PyExc_TypeError,
                        "_ik_exceeds_reach takes a robot with a solver and a contiguous float64 goal");
        return nullptr;
    }
    return PyBool_FromLong(ik::is_ruled_out(*arm, data_of(goal)));
}

// The arm and the goal of a call about a position; null with an error set.
const ik::BuiltArm* position_arm(PyObject* args, const char* function, PyObject*& robot, Vec3d& p) {
    PyObject* goal;
    if (!PyArg_ParseTuple(args, "OO", &robot, &goal)) return nullptr;
    const ik::BuiltArm* arm = arm_of(robot);
    if (!arm || !arm->has_few_joints || !is_doubles(goal, 3)) {
        PyErr_Format(PyExc_TypeError, "%s takes an arm of up to three joints and a float64 point (3,)",
                     function);
        return nullptr;
    }
    const double* x = data_of(goal);
    p = {x[0], x[1], x[2]};
    return arm;
}

// _ik_position(robot, p (3,)) → solutions
PyObject* position(PyObject*, PyObject* args) {
    PyObject* robot;
    Vec3d p;
    const ik::BuiltArm* arm = position_arm(args, "_ik_position", robot, p);
    if (!arm) return nullptr;
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const double goal[16] = {none, none, none, p.x, none, none, none, p.y,
                             none, none, none, p.z, none, none, none, none};
    return to_python(robot, goal, arm->dof, ik::solve_point(*arm, p));
}

// _ik_nearest_position(robot, p (3,)) → (q that comes nearest (n,), what is missing there [m])
PyObject* position_miss(PyObject*, PyObject* args) {
    PyObject* robot;
    Vec3d p;
    const ik::BuiltArm* arm = position_arm(args, "_ik_nearest_position", robot, p);
    if (!arm) return nullptr;
    const ik::NearestMiss best = ik::nearest_to_point(*arm, p);
    npy_intp n = arm->dof;
    PyObject* q = PyArray_SimpleNew(1, &n, NPY_DOUBLE);
    if (!q) return nullptr;
    std::copy(best.q, best.q + n, data_of(q));
    return Py_BuildValue("Nd", q, best.position);
}

// _ik_single(robot, goal (4, 4)) → solutions, or None for a goal that is no pose
PyObject* single(PyObject*, PyObject* args) {
    PyObject *robot, *goal;
    if (!PyArg_ParseTuple(args, "OO", &robot, &goal)) return nullptr;
    double copy[16];
    const ik::BuiltArm* arm = arm_of(robot);
    const double* T = goal_in_place(goal, copy);
    if (!arm || !arm->room || !T) {
        PyErr_SetString(PyExc_TypeError, "_ik_single takes a robot with a solver and a float64 (4, 4) goal");
        return nullptr;
    }
    PyObject* answer = answer_single(robot, *arm, T);
    if (answer || PyErr_Occurred()) return answer;
    Py_RETURN_NONE;
}

// _ik_geometry(robot) → what the classification saw, for cspace.ik to put into words.
PyObject* geometry(PyObject*, PyObject* robot) {
    const ik::BuiltArm* arm = arm_of(robot);
    if (!arm) Py_RETURN_NONE;
    const ik::ArmGeometry seen = ik::geometry_of(*arm);
    return Py_BuildValue("{s:i,s:O,s:i,s:i,s:O,s:O,s:d,s:d}", "family", seen.family, "general",
                         seen.is_general ? Py_True : Py_False, "virtual_joints", seen.virtual_joints,
                         "first_three", seen.first_three, "reversed", seen.reversed ? Py_True : Py_False,
                         "polish", seen.polish ? Py_True : Py_False, "deviation", seen.deviation, "length",
                         seen.length);
}

PyMethodDef functions[] = {
    {"_ik_build", build, METH_VARARGS, "Builds the solver of a robot from its screws at zero."},
    {"_ik_near_singular", careful, METH_VARARGS,
     "Solves one goal by the careful path, free joints as given."},
    {"_ik_exceeds_reach", beyond, METH_VARARGS, "Whether the axes of an arm alone rule a goal out."},
    {"_ik_nearest_pose", miss, METH_VARARGS, "The configuration that comes nearest to a goal out of reach."},
    {"_ik_follow", ik_follow, METH_VARARGS, "The family through a configuration, as a curve."},
    {"_ik_onto", ik_onto, METH_VARARGS, "Configurations brought onto the family through another one."},
    {"_ik_direction", ik_direction, METH_VARARGS,
     "The direction of the self-motion through a configuration."},
    {"_ik_position", position, METH_VARARGS, "Solves a position goal of an arm of up to three joints."},
    {"_ik_nearest_position", position_miss, METH_VARARGS,
     "The configuration that comes nearest to a position."},
    {"_ik_positions", ik_positions, METH_VARARGS, "Solves many position goals."},
    {"_ik_make", ik_make, METH_VARARGS, "A result from its parts."},
    {"_ik_serve_near", ik_serve_near, METH_VARARGS, "Answers near= of a robot from now on."},
    {"_ik_single", single, METH_VARARGS, "Solves one goal."},
    {"_ik_many", ik_many, METH_VARARGS, "Solves many goals."},
    {"_ik_results", ik_results, METH_O, "Sets the class that results are made of."},
    {"_ik_geometry", geometry, METH_O, "What the classification of a robot saw."},
    {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_ik(nanobind::module_& m) {
    if (ik_add_result_type(m.ptr()) < 0 || PyModule_AddFunctions(m.ptr(), functions) < 0)
        throw nanobind::python_error();
    m.attr("AXIS_RELATION") = tolerance::axis_relation;
}
