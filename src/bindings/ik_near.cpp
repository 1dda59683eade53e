// robot.ik(T, near=q): the compiled entry for one goal and one seed. The first call goes through cspace.ik,
// which leaves here what it takes: the solver of joints to spare, or the limits.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "cspace/tolerances.hpp"
#include "ik_shared.hpp"
#include "library/ik_redundancy.hpp"

using namespace cspace;

namespace {

struct NearEntry {
    const ik::RedundantSolver* arm = nullptr;  // of redundant joints; null where a goal settles the joints
    PyObject* solver = nullptr;                // keeps the arm; null likewise
    PyObject* about = nullptr;                 // which freedom is left; null likewise
    double lower[ik::max_joints], upper[ik::max_joints];  // where a goal settles the joints

    ~NearEntry() {
        Py_XDECREF(solver);
        Py_XDECREF(about);
    }
};

bool is_seed(PyObject* value, int n) {
    if (!PyArray_CheckExact(value) || !is_doubles(value, n) ||
        PyArray_NDIM(reinterpret_cast<PyArrayObject*>(value)) != 1)
        return false;
    for (int i = 0; i < n; ++i)
        if (!(std::fabs(data_of(value)[i]) <= tolerance::farthest)) return false;
    return true;
}

PyObject* one_row(PyObject* robot, const double* goal, const double* q, int n, int branch, PyObject* about) {
    SolutionsObject* made = new_solutions(robot, goal, 1, n, ik::Status::exact);
    if (!made) return nullptr;
    std::copy(q, q + n, made->q);
    branches_of(made)[0] = std::int8_t(branch);
    self_motions_of(made)[0] = 0;
    made->about = Py_XNewRef(about);
    return reinterpret_cast<PyObject*>(made);
}

// Among redundant joints.
PyObject* nearest_of_manifold(PyObject* robot, const NearEntry& entry, const double* goal,
                              const double* seed) {
    double q[ik::max_joints];
    if (!entry.arm->find_nearest_turned(goal, seed, q)) return nullptr;
    return one_row(robot, goal, q, entry.arm->chain().n, -1, entry.about);
}

// Among solutions that are listed and stand alone.
PyObject* nearest_of_list(PyObject* robot, const NearEntry& entry, const double* goal, const double* seed) {
    const ik::BuiltArm* arm = arm_of(robot);
    double q[ik::max_joints];
    std::int8_t branch;
    if (!arm || !arm->room || !ik::nearest_listed(*arm, entry.lower, entry.upper, goal, seed, q, &branch))
        return nullptr;
    return one_row(robot, goal, q, arm->dof, branch, nullptr);
}

NearEntry* new_entry(PyObject* robot) {
    auto& slot = reinterpret_cast<RobotObject*>(robot)->near;
    if (slot) return nullptr;
    auto made = std::make_shared<NearEntry>();
    NearEntry* entry = made.get();
    slot = std::move(made);
    return entry;
}

}  // namespace

void ik_set_near(PyObject* robot, const ik::RedundantSolver* arm, PyObject* solver, PyObject* about) {
    NearEntry* entry = new_entry(robot);
    if (!entry) return;
    entry->arm = arm;
    entry->solver = Py_NewRef(solver);
    entry->about = Py_NewRef(about);
}

// _ik_serve_near(robot, lower (n,), upper (n,)): near= of this robot is answered here from now on.
PyObject* ik_serve_near(PyObject*, PyObject* args) {
    PyObject *robot, *lower, *upper;
    if (!PyArg_ParseTuple(args, "OOO", &robot, &lower, &upper)) return nullptr;
    const ik::BuiltArm* arm = arm_of(robot);
    const int n = arm ? arm->dof : 0;
    if (!arm || !arm->room || !is_doubles(lower, n) || !is_doubles(upper, n)) {
        PyErr_SetString(PyExc_TypeError, "_ik_serve_near takes a robot with a solver and its limits");
        return nullptr;
    }
    if (NearEntry* entry = new_entry(robot)) {
        std::copy(data_of(lower), data_of(lower) + n, entry->lower);
        std::copy(data_of(upper), data_of(upper) + n, entry->upper);
    }
    Py_RETURN_NONE;
}

// Null without an error for what is not answered here.
PyObject* ik_near(PyObject* robot, const double* goal, PyObject* seed) {
    const auto* entry = static_cast<const NearEntry*>(reinterpret_cast<RobotObject*>(robot)->near.get());
    if (!entry) return nullptr;
    const int n = entry->arm ? entry->arm->chain().n : arm_of(robot)->dof;
    if (!is_seed(seed, n)) return nullptr;
    const auto answer = entry->arm ? nearest_of_manifold : nearest_of_list;
    return answer(robot, *entry, goal, data_of(seed));
}
