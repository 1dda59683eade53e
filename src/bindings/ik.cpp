// robot.ik(T): the compiled entry and its result. One 4×4 goal without keywords is answered here; everything
// else goes to cspace.ik, which finds the words and comes back with plain arrays.
#include "ik.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>
#include <memory>

#include "bindings.hpp"
#include "cspace/ik/arm.hpp"
#include "cspace/ik/goal.hpp"
#include "cspace/math/threads.hpp"
#include "robot.hpp"

using namespace cspace;

const char robot_ik_doc[] =
    "ik($self, goal, /, *, near=None, least_squares=False, threads=None)\n--\n\n"
    "Every configuration q with fk(q) = goal.\n\n"
    "goal: T_base_tip (4, 4) or (..., 4, 4), or anything as_pose takes. near (dof,) [rad, m]: the answer is "
    "the one\n"
    "solution nearest to it, and joints that the pose leaves free take its values. least_squares: where "
    "nothing\n"
    "reaches the goal, answer with the configuration that misses it least. threads: of a batch, all cores "
    "unless\n"
    "given.\n\n"
    "Returns Solutions for one goal: q (k, dof) with revolute joints in (-pi, pi], status, reason, residual, "
    "branch,\n"
    "within(), nearest(), wrapped(); falsy if nothing reaches the goal. Returns SolutionsBatch for many: q\n"
    "(..., k_max, dof) padded with NaN, count (...). Raises InputError for what is no pose, "
    "NoClosedFormError for an\n"
    "arm that this version does not solve.";

namespace {

PyTypeObject* solutions_type = nullptr;  // the Python class that results are made of
PyTypeObject* base_type = nullptr;       // SolutionsBase

// The solver of a robot that has one; null for every other object.
const ik::Arm* arm_of(PyObject* robot) {
    if (!PyObject_TypeCheck(robot, robot_type)) return nullptr;
    return static_cast<const ik::Arm*>(reinterpret_cast<RobotObject*>(robot)->ik.get());
}

bool can_solve(const ik::Arm& arm) { return arm.has_plan || arm.is_short; }

Posed pose_from(const double* m) {
    return {{{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}}, {m[3], m[7], m[11]}};
}

// --- the result ----------------------------------------------------------------------------------------
// Followed in memory by count rows of dof angles, count branch numbers and count flags (families).
struct SolutionsObject {
    PyObject_VAR_HEAD PyObject* robot;
    PyObject* note;  // why rows are missing, where a filter removed them; or null
    double goal[16];
    int count, dof;
    ik::Status status;
    double q[1];
};
std::int8_t* branches_of(SolutionsObject* s) {
    return reinterpret_cast<std::int8_t*>(s->q + std::ptrdiff_t(s->count) * s->dof);
}
std::int8_t* families_of(SolutionsObject* s) { return branches_of(s) + s->count; }

SolutionsObject* new_solutions(PyObject* robot, const double* goal, int count, int dof, ik::Status status) {
    if (!solutions_type) {
        PyObject* room = PyImport_ImportModule("cspace.ik.solutions");
        if (!room) return nullptr;
        Py_DECREF(room);
        if (!solutions_type) {
            PyErr_SetString(PyExc_ImportError, "cspace.ik.solutions has not named the class of results");
            return nullptr;
        }
    }
    auto* made = reinterpret_cast<SolutionsObject*>(
        solutions_type->tp_alloc(solutions_type, count * dof + (2 * count + 7) / 8));
    if (!made) return nullptr;
    made->robot = Py_NewRef(robot);
    std::memcpy(made->goal, goal, sizeof made->goal);
    made->count = count;
    made->dof = dof;
    made->status = status;
    return made;
}

PyObject* from_careful(PyObject* robot, const ik::Arm& arm, const double* goal, const double* idle) {
    const ReadGoal<double> read = read_goal(goal);
    const ik::Solutions found = solve_pose(arm, read.T, idle);
    const int dof = arm.plan.chain.n;
    SolutionsObject* made = new_solutions(robot, goal, found.count, dof, found.status);
    if (!made) return nullptr;
    for (int k = 0; k < found.count; ++k) {
        std::memcpy(made->q + k * dof, found.q[k], dof * sizeof(double));
        branches_of(made)[k] = found.branch[k];
        families_of(made)[k] = found.family[k];
    }
    return reinterpret_cast<PyObject*>(made);
}

// A robot may hold its own results as an attribute, so results take part in the search for cycles.
int traverse(PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    Py_VISIT(reinterpret_cast<SolutionsObject*>(self)->robot);
    Py_VISIT(reinterpret_cast<SolutionsObject*>(self)->note);
    return 0;
}
int clear(PyObject* self) {
    Py_CLEAR(reinterpret_cast<SolutionsObject*>(self)->robot);
    Py_CLEAR(reinterpret_cast<SolutionsObject*>(self)->note);
    return 0;
}
void destroy(PyObject* self) {
    PyTypeObject* type = Py_TYPE(self);
    PyObject_GC_UnTrack(self);
    clear(self);
    type->tp_free(self);
    Py_DECREF(type);
}

PyObject* get_q(PyObject* self, void*) {
    auto* s = reinterpret_cast<SolutionsObject*>(self);
    npy_intp shape[2] = {s->count, s->dof};
    PyObject* array = PyArray_SimpleNew(2, shape, NPY_DOUBLE);
    if (array)
        std::memcpy(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array)), s->q,
                    sizeof(double) * std::size_t(s->count * s->dof));
    return array;
}
// A position goal is kept as a pose whose rotation is NaN.
PyObject* get_goal(PyObject* self, void*) {
    const double* goal = reinterpret_cast<SolutionsObject*>(self)->goal;
    const bool is_position = goal[0] != goal[0];
    npy_intp shape[2] = {is_position ? 3 : 4, 4};
    PyObject* array = PyArray_SimpleNew(is_position ? 1 : 2, shape, NPY_DOUBLE);
    if (!array) return nullptr;
    auto* out = static_cast<double*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array)));
    for (int i = 0; i < (is_position ? 3 : 16); ++i) out[i] = goal[is_position ? 4 * i + 3 : i];
    return array;
}
PyObject* get_robot(PyObject* self, void*) {
    return Py_NewRef(reinterpret_cast<SolutionsObject*>(self)->robot);
}
PyObject* get_note(PyObject* self, void*) {
    PyObject* note = reinterpret_cast<SolutionsObject*>(self)->note;
    return Py_NewRef(note ? note : Py_None);
}
PyObject* get_verdict(PyObject* self, void*) {
    return PyLong_FromLong(static_cast<long>(reinterpret_cast<SolutionsObject*>(self)->status));
}
PyObject* get_branch_numbers(PyObject* self, void*) {
    auto* s = reinterpret_cast<SolutionsObject*>(self);
    PyObject* list = PyTuple_New(s->count);
    for (int k = 0; list && k < s->count; ++k) PyTuple_SET_ITEM(list, k, PyLong_FromLong(branches_of(s)[k]));
    return list;
}
PyObject* get_is_family(PyObject* self, void*) {
    auto* s = reinterpret_cast<SolutionsObject*>(self);
    PyObject* list = PyTuple_New(s->count);
    for (int k = 0; list && k < s->count; ++k) PyTuple_SET_ITEM(list, k, PyBool_FromLong(families_of(s)[k]));
    return list;
}
Py_ssize_t length(PyObject* self) { return reinterpret_cast<SolutionsObject*>(self)->count; }
int truth(PyObject* self) { return reinterpret_cast<SolutionsObject*>(self)->count > 0; }

// --- calls ---------------------------------------------------------------------------------------------
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
PyObject* answer_single(PyObject* robot, const ik::Arm& arm, const double* goal) {
    double q[max_branches * 6];
    std::int8_t branch[max_branches];
    int count;
    const ik::Quick quick = arm.has_plan              ? kernels::ik_one(arm.plan, goal, q, branch, &count)
                            : read_goal(goal).is_pose ? ik::Quick::doubtful
                                                      : ik::Quick::refused;
    if (quick == ik::Quick::refused) return nullptr;
    if (quick == ik::Quick::doubtful) return from_careful(robot, arm, goal, nullptr);
    SolutionsObject* made =
        new_solutions(robot, goal, count, 6, count ? ik::Status::exact : ik::Status::unreachable);
    if (!made) return nullptr;
    std::memcpy(made->q, q, sizeof(double) * std::size_t(6 * count));
    std::memcpy(branches_of(made), branch, std::size_t(count));
    return reinterpret_cast<PyObject*>(made);
}

const char words[] = "cspace.ik.solve";

}  // namespace

PyObject* robot_ik(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    double copy[16];
    const auto* arm = static_cast<const ik::Arm*>(reinterpret_cast<RobotObject*>(self)->ik.get());
    const double* goal =
        arm && can_solve(*arm) && nargs == 1 && !kwnames ? goal_in_place(args[0], copy) : nullptr;
    if (goal) {
        PyObject* answer = answer_single(self, *arm, goal);
        if (answer || PyErr_Occurred()) return answer;
    }
    return robot_call_python(words, "inverse_kinematics", self, args, nargs, kwnames);
}

namespace {

double* data_of(PyObject* array) {
    return static_cast<double*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array)));
}
bool is_plain(PyObject* value, int type, npy_intp size) {
    if (!PyArray_Check(value)) return false;
    auto* array = reinterpret_cast<PyArrayObject*>(value);
    return PyArray_EquivTypenums(PyArray_TYPE(array), type) && PyArray_ISCARRAY_RO(array) &&
           PyArray_SIZE(array) == size;
}
bool is_doubles(PyObject* value, npy_intp size) { return is_plain(value, NPY_DOUBLE, size); }
bool is_writable(PyObject* array) { return PyArray_ISWRITEABLE(reinterpret_cast<PyArrayObject*>(array)); }

// _ik_build(robot, axes (n, 3), points (n, 3), prismatic (n,), T_zero (4, 4)) → bool: is there a closed form?
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
    if (const ik::Arm* built = arm_of(robot)) return PyBool_FromLong(can_solve(*built));
    ik::Chain chain;
    chain.n = int(n);
    for (int i = 0; i < chain.n; ++i) {
        const double *h = data_of(axes) + 3 * i, *p = data_of(points) + 3 * i;
        chain.axis[i] = {h[0], h[1], h[2]};
        chain.point[i] = {p[0], p[1], p[2]};
        chain.prismatic[i] = data_of(prismatic)[i] != 0;
    }
    chain.tip = pose_from(data_of(tip));
    auto arm = std::make_shared<ik::Arm>(make_arm(chain));
    const bool solvable = can_solve(*arm);
    reinterpret_cast<RobotObject*>(robot)->ik = std::move(arm);
    return PyBool_FromLong(solvable);
}

// _ik_careful(robot, goal (4, 4), idle (n,)) → solutions
PyObject* careful(PyObject*, PyObject* args) {
    PyObject *robot, *goal, *idle;
    if (!PyArg_ParseTuple(args, "OOO", &robot, &goal, &idle)) return nullptr;
    const ik::Arm* arm = arm_of(robot);
    if (!arm || !can_solve(*arm) || !is_doubles(goal, 16) || !is_doubles(idle, arm->plan.chain.n)) {
        PyErr_SetString(PyExc_TypeError,
                        "_ik_careful takes a robot with a solver and contiguous float64 arrays");
        return nullptr;
    }
    return from_careful(robot, *arm, data_of(goal), data_of(idle));
}

// _ik_miss(robot, goal (4, 4), stiffness) → (q, position error [m], rotation error [rad])
PyObject* miss(PyObject*, PyObject* args) {
    PyObject *robot, *goal;
    double stiffness;
    if (!PyArg_ParseTuple(args, "OOd", &robot, &goal, &stiffness)) return nullptr;
    const ik::Arm* arm = arm_of(robot);
    if (!arm || !can_solve(*arm) || !is_doubles(goal, 16)) {
        PyErr_SetString(PyExc_TypeError,
                        "_ik_miss takes a robot with a solver and a contiguous float64 goal");
        return nullptr;
    }
    const ik::Miss best = nearest_miss(*arm, read_goal(data_of(goal)).T, stiffness);
    npy_intp n = arm->plan.chain.n;
    PyObject* q = PyArray_SimpleNew(1, &n, NPY_DOUBLE);
    if (!q) return nullptr;
    std::memcpy(data_of(q), best.q, sizeof(double) * std::size_t(n));
    return Py_BuildValue("Ndd", q, best.position, best.rotation);
}

// _ik_direction(robot, q (n,)) → the unit joint velocity (n,) of the self-motion through q, or None
PyObject* direction(PyObject*, PyObject* args) {
    PyObject *robot, *at;
    if (!PyArg_ParseTuple(args, "OO", &robot, &at)) return nullptr;
    const ik::Arm* arm = arm_of(robot);
    if (!arm || !can_solve(*arm) || !is_doubles(at, arm->plan.chain.n)) {
        PyErr_SetString(PyExc_TypeError,
                        "_ik_direction takes a robot with a solver and a contiguous float64 (n,)");
        return nullptr;
    }
    const ik::Chain& chain = arm->plan.chain;
    const double length = characteristic_length(chain), *q = data_of(at);
    const Posed goal = forward(chain, q);
    PoseError error;
    measure(chain, goal, length, q, error);
    decompose(error.jacobian);
    double d[ik::max_joints];
    if (!find_self_motion(chain, goal, length, q, error.jacobian, d)) Py_RETURN_NONE;
    npy_intp n = chain.n;
    PyObject* out = PyArray_SimpleNew(1, &n, NPY_DOUBLE);
    if (out) std::memcpy(data_of(out), d, sizeof(double) * std::size_t(n));
    return out;
}

// _ik_position(robot, p (3,)) → (status, q (k, n), families (k), missing [m], q that comes nearest (n,))
PyObject* position(PyObject*, PyObject* args) {
    PyObject *robot, *goal;
    if (!PyArg_ParseTuple(args, "OO", &robot, &goal)) return nullptr;
    const ik::Arm* arm = arm_of(robot);
    if (!arm || !arm->is_short || !is_doubles(goal, 3)) {
        PyErr_SetString(PyExc_TypeError,
                        "_ik_position takes an arm of up to three joints and a float64 point (3,)");
        return nullptr;
    }
    const double* p = data_of(goal);
    const ik::PositionSolutions found = solve_position(arm->plan.chain, {p[0], p[1], p[2]});
    const ik::Solutions all = from_short(arm->plan.chain, found);
    npy_intp shape[2] = {all.count, arm->plan.chain.n};
    PyObject* q = PyArray_SimpleNew(2, shape, NPY_DOUBLE);
    PyObject* nearest = PyArray_SimpleNew(1, shape + 1, NPY_DOUBLE);
    PyObject* families = PyTuple_New(all.count);
    if (!q || !nearest || !families) return nullptr;
    for (int k = 0; k < all.count; ++k) {
        std::copy(all.q[k], all.q[k] + shape[1], data_of(q) + k * shape[1]);
        PyTuple_SET_ITEM(families, k, PyBool_FromLong(all.family[k]));
    }
    std::copy(found.nearest, found.nearest + shape[1], data_of(nearest));
    return Py_BuildValue("iNNdN", int(all.status), q, families, found.missing, nearest);
}

constexpr int last_status = static_cast<int>(ik::Status::nearest);

// _ik_make(robot, goal (4, 4), status, q (k, dof), branches (k), families (k), note) → solutions
PyObject* make(PyObject*, PyObject* args) {
    PyObject *robot, *goal, *q, *branches, *families, *note;
    int status;
    if (!PyArg_ParseTuple(args, "OOiOO!O!O", &robot, &goal, &status, &q, &PyTuple_Type, &branches,
                          &PyTuple_Type, &families, &note))
        return nullptr;
    const Py_ssize_t k = PyTuple_GET_SIZE(branches);
    const bool shaped = PyArray_Check(q) && PyArray_NDIM(reinterpret_cast<PyArrayObject*>(q)) == 2;
    const npy_intp dof = shaped ? PyArray_DIM(reinterpret_cast<PyArrayObject*>(q), 1) : -1;
    if (!PyObject_TypeCheck(robot, robot_type) || status < 0 || status > last_status) {
        PyErr_SetString(PyExc_TypeError, "_ik_make takes a robot and a status it knows");
        return nullptr;
    }
    if (!shaped || k > 1 << 24 || PyTuple_GET_SIZE(families) != k || !is_doubles(q, k * dof) ||
        !is_doubles(goal, 16)) {
        PyErr_SetString(PyExc_TypeError, "_ik_make takes contiguous float64 arrays and tuples of one length");
        return nullptr;
    }
    SolutionsObject* made =
        new_solutions(robot, data_of(goal), int(k), int(dof), static_cast<ik::Status>(status));
    if (!made) return nullptr;
    std::memcpy(made->q, data_of(q), sizeof(double) * std::size_t(k * dof));
    for (Py_ssize_t i = 0; i < k; ++i) {
        branches_of(made)[i] = static_cast<std::int8_t>(PyLong_AsLong(PyTuple_GET_ITEM(branches, i)));
        families_of(made)[i] = PyObject_IsTrue(PyTuple_GET_ITEM(families, i)) == 1;
    }
    made->note = note == Py_None ? nullptr : Py_NewRef(note);
    if (PyErr_Occurred()) Py_CLEAR(made);
    return reinterpret_cast<PyObject*>(made);
}

// _ik_single(robot, goal (4, 4)) → solutions, or None for a goal that is no pose
PyObject* single(PyObject*, PyObject* args) {
    PyObject *robot, *goal;
    if (!PyArg_ParseTuple(args, "OO", &robot, &goal)) return nullptr;
    double copy[16];
    const ik::Arm* arm = arm_of(robot);
    const double* T = goal_in_place(goal, copy);
    if (!arm || !can_solve(*arm) || !T) {
        PyErr_SetString(PyExc_TypeError, "_ik_single takes a robot with a solver and a float64 (4, 4) goal");
        return nullptr;
    }
    PyObject* answer = answer_single(robot, *arm, T);
    if (answer || PyErr_Occurred()) return answer;
    Py_RETURN_NONE;
}

constexpr Py_ssize_t most_threads = 1024;
constexpr std::size_t rows_worth_a_thread = 256;

// --- batches -------------------------------------------------------------------------------------------
// The kernel over a slice, then the careful path where it hesitated. Returns the first goal refused, or n.
std::size_t solve_slice(const ik::Arm& arm, const double* T, std::size_t n, double* q, std::int64_t* count,
                        unsigned char* status) {
    auto* quick = reinterpret_cast<ik::Quick*>(status);
    const bool has_kernel = arm.has_plan && arm.plan.on_lanes && arm.plan.virtual_joints == 0;
    if (has_kernel) kernels::ik_many(arm.plan, T, n, q, count, quick);
    const int dof = arm.plan.chain.n, row = max_branches * dof;
    for (std::size_t i = 0; i < n; ++i) {
        if (!has_kernel) quick[i] = read_goal(T + 16 * i).is_pose ? ik::Quick::doubtful : ik::Quick::refused;
        if (quick[i] == ik::Quick::refused) return i;
        if (quick[i] == ik::Quick::settled) {
            status[i] = static_cast<unsigned char>(count[i] ? ik::Status::exact : ik::Status::unreachable);
            continue;
        }
        const ik::Solutions found = solve_pose(arm, read_goal(T + 16 * i).T, nullptr);
        double* out = q + i * std::size_t(row);
        std::fill(out, out + row, std::numeric_limits<double>::quiet_NaN());
        count[i] = std::min(found.count, max_branches);
        for (int k = 0; k < count[i]; ++k) std::copy(found.q[k], found.q[k] + dof, out + k * dof);
        status[i] = static_cast<unsigned char>(found.status);
    }
    return n;
}

// _ik_many(robot, goals (n, 4, 4), q (n, 8, dof), count (n,), status (n,), threads) → index of the first goal
// that is no pose, or n
PyObject* many(PyObject*, PyObject* args) {
    PyObject *robot, *goals, *q, *count, *status;
    Py_ssize_t threads;
    if (!PyArg_ParseTuple(args, "OOOOOn", &robot, &goals, &q, &count, &status, &threads)) return nullptr;
    const ik::Arm* arm = arm_of(robot);
    const npy_intp n = PyArray_Check(count) ? PyArray_SIZE(reinterpret_cast<PyArrayObject*>(count)) : -1;
    if (!arm || !can_solve(*arm) || n < 0 || !is_doubles(goals, 16 * n) ||
        !is_doubles(q, n * max_branches * arm->plan.chain.n) || !is_plain(count, NPY_INT64, n) ||
        !is_plain(status, NPY_UINT8, n) || !is_writable(q) || !is_writable(count) || !is_writable(status)) {
        PyErr_SetString(PyExc_TypeError,
                        "_ik_many takes a robot with a solver and contiguous arrays: float64, count int64, "
                        "status uint8");
        return nullptr;
    }
    const double* T = data_of(goals);
    double* out = data_of(q);
    auto* counts = static_cast<std::int64_t*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(count)));
    auto* verdicts = static_cast<unsigned char*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(status)));
    const std::size_t total = std::size_t(n), row = std::size_t(max_branches * arm->plan.chain.n);
    std::atomic<std::size_t> bad = total;
    Py_BEGIN_ALLOW_THREADS;
    const auto work = [&](std::size_t from, std::size_t to) {
        const std::size_t size = to - from;
        const std::size_t stopped =
            solve_slice(*arm, T + 16 * from, size, out + row * from, counts + from, verdicts + from);
        if (stopped == size) return true;
        std::size_t first = bad;
        while (from + stopped < first && !bad.compare_exchange_weak(first, from + stopped)) {
        }
        return false;
    };
    over_rows(total, int(std::clamp<Py_ssize_t>(threads, 1, most_threads)), 1, rows_worth_a_thread, work);
    Py_END_ALLOW_THREADS;
    return PyLong_FromSize_t(bad);
}

// _ik_results(cls): results are made of this class from now on.
PyObject* results(PyObject*, PyObject* cls) {
    if (!PyType_Check(cls) || !PyType_IsSubtype(reinterpret_cast<PyTypeObject*>(cls), base_type)) {
        PyErr_SetString(PyExc_TypeError, "_ik_results takes a subclass of SolutionsBase");
        return nullptr;
    }
    Py_XDECREF(solutions_type);
    solutions_type = reinterpret_cast<PyTypeObject*>(Py_NewRef(cls));
    Py_RETURN_NONE;
}

// _ik_geometry(robot) → what the classification saw, for cspace.ik to put into words.
PyObject* geometry(PyObject*, PyObject* robot) {
    const ik::Arm* arm = arm_of(robot);
    if (!arm) Py_RETURN_NONE;
    const ik::Plan& plan = arm->plan;
    return Py_BuildValue("{s:i,s:i,s:i,s:O,s:O,s:d,s:d}", "family", arm->has_plan ? int(plan.family) : -1,
                         "virtual_joints", plan.virtual_joints, "first_three", int(plan.wrist.first.kind),
                         "reversed", plan.reversed ? Py_True : Py_False, "polish",
                         plan.polish ? Py_True : Py_False, "deviation", plan.form.deviation, "length",
                         plan.form.length);
}

PyMethodDef functions[] = {
    {"_ik_build", build, METH_VARARGS, "Builds the solver of a robot from its screws at zero."},
    {"_ik_careful", careful, METH_VARARGS, "Solves one goal by the careful path, free joints as given."},
    {"_ik_miss", miss, METH_VARARGS, "The configuration that comes nearest to a goal out of reach."},
    {"_ik_direction", direction, METH_VARARGS, "The direction of the self-motion through a configuration."},
    {"_ik_position", position, METH_VARARGS, "Solves a position goal of an arm of up to three joints."},
    {"_ik_make", make, METH_VARARGS, "A result from its parts."},
    {"_ik_single", single, METH_VARARGS, "Solves one goal."},
    {"_ik_many", many, METH_VARARGS, "Solves many goals."},
    {"_ik_results", results, METH_O, "Sets the class that results are made of."},
    {"_ik_geometry", geometry, METH_O, "What the classification of a robot saw."},
    {nullptr, nullptr, 0, nullptr}};

PyGetSetDef attributes[] = {
    {"q", get_q, nullptr, "The configurations (k, dof) [rad, m].", nullptr},
    {"goal", get_goal, nullptr, "The goal T_base_tip (4, 4).", nullptr},
    {"robot", get_robot, nullptr, "The robot that was asked.", nullptr},
    {"_note", get_note, nullptr, "Why rows are missing, if a filter removed them.", nullptr},
    {"_verdict", get_verdict, nullptr, "The status as a number.", nullptr},
    {"_branch_numbers", get_branch_numbers, nullptr, "Which branch of the closed form each row comes from.",
     nullptr},
    {"_is_family", get_is_family, nullptr, "Which rows stand for a family.", nullptr},
    {nullptr, nullptr, nullptr, nullptr, nullptr}};
PyType_Slot slots[] = {{Py_tp_dealloc, reinterpret_cast<void*>(&destroy)},
                       {Py_tp_traverse, reinterpret_cast<void*>(&traverse)},
                       {Py_tp_clear, reinterpret_cast<void*>(&clear)},
                       {Py_tp_getset, attributes},
                       {Py_sq_length, reinterpret_cast<void*>(&length)},
                       {Py_nb_bool, reinterpret_cast<void*>(&truth)},
                       {Py_tp_doc, const_cast<char*>("The compiled half of cspace.ik.Solutions.")},
                       {0, nullptr}};
PyType_Spec spec = {
    "cspace._core.SolutionsBase", offsetof(SolutionsObject, q), sizeof(double),
    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_HAVE_GC | Py_TPFLAGS_DISALLOW_INSTANTIATION, slots};

}  // namespace

void bind_ik(nanobind::module_& m) {
    PyObject* type = PyType_FromSpec(&spec);
    if (!type || PyModule_AddObjectRef(m.ptr(), "SolutionsBase", type) < 0 ||
        PyModule_AddFunctions(m.ptr(), functions) < 0)
        throw nanobind::python_error();
    base_type = reinterpret_cast<PyTypeObject*>(type);  // kept for good
    m.attr("AXIS_RELATION") = tolerance::axis_relation;
}
