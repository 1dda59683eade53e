// robot.ik(T, locked={…}): the compiled entry for one goal with joints held at numbers. The first call with a
// set of joints goes through cspace.ik.redundancy.solve, which leaves their plan here.
#include <algorithm>
#include <cmath>
#include <vector>

#include "cspace/tolerances.hpp"
#include "ik_shared.hpp"
#include "library/ik_redundancy.hpp"

using namespace cspace;

namespace {

struct LockedPlan {
    unsigned joints;  // one bit each
    const ik::LockedArm* locked;
};
struct LockedEntry {
    PyObject* solver;  // keeps the plans
    PyObject* names;   // of all joints, a tuple
    PyObject* about;   // that no freedom is left
    std::vector<LockedPlan> plans;

    LockedEntry(PyObject* solver_, PyObject* names_, PyObject* about_)
        : solver(Py_NewRef(solver_)), names(Py_NewRef(names_)), about(Py_NewRef(about_)) {}
    ~LockedEntry() {
        Py_DECREF(solver);
        Py_DECREF(names);
        Py_DECREF(about);
    }
};

LockedEntry* entry_of(PyObject* robot) {
    return static_cast<LockedEntry*>(reinterpret_cast<RobotObject*>(robot)->locked.get());
}

// The joint that a key of locked= names; −1 for what is not answered here.
Py_ssize_t joint_of(PyObject* names, PyObject* key) {
    const Py_ssize_t n = PyTuple_GET_SIZE(names);
    if (PyUnicode_CheckExact(key)) {
        for (Py_ssize_t i = 0; i < n; ++i)
            if (PyTuple_GET_ITEM(names, i) == key || PyUnicode_Compare(PyTuple_GET_ITEM(names, i), key) == 0)
                return i;
        return -1;
    }
    if (!PyLong_CheckExact(key)) return -1;
    int overflow;
    const long number = PyLong_AsLongAndOverflow(key, &overflow);
    return overflow || number < -n || number >= n ? -1 : number < 0 ? number + n : number;
}

// Reads locked= into the values of the joints; returns which, and none for what is not answered here.
unsigned read_locked(PyObject* names, PyObject* locked_values, double* at) {
    if (!PyDict_CheckExact(locked_values) || PyTuple_GET_SIZE(names) > ik::max_joints) return 0;
    unsigned joints = 0;
    PyObject *key, *value;
    for (Py_ssize_t next = 0; PyDict_Next(locked_values, &next, &key, &value);) {
        const Py_ssize_t joint = joint_of(names, key);
        if (joint < 0 || joints >> joint & 1 || !PyFloat_Check(value)) return 0;
        at[joint] = PyFloat_AS_DOUBLE(value);
        if (!(std::fabs(at[joint]) <= tolerance::farthest)) return 0;
        joints |= 1u << joint;
    }
    return joints;
}

}  // namespace

void ik_add_locked(PyObject* robot, PyObject* solver, PyObject* names, PyObject* about,
                   const std::vector<int>& locked_joint, const ik::LockedArm* locked) {
    auto& slot = reinterpret_cast<RobotObject*>(robot)->locked;
    if (!slot) slot = std::make_shared<LockedEntry>(solver, names, about);
    unsigned joints = 0;
    for (const int joint : locked_joint) joints |= 1u << joint;
    std::vector<LockedPlan>& plans = entry_of(robot)->plans;
    const auto same = [joints](const LockedPlan& plan) { return plan.joints == joints; };
    if (std::none_of(plans.begin(), plans.end(), same)) plans.push_back({joints, locked});
}

// Null without an error for what is not answered here: where nothing reaches the goal there is more to say.
PyObject* ik_locked(PyObject* robot, const double* goal, PyObject* locked_values) {
    const LockedEntry* entry = entry_of(robot);
    double at[ik::max_joints] = {};
    const unsigned joints = entry ? read_locked(entry->names, locked_values, at) : 0;
    if (!joints) return nullptr;
    const auto plan = std::find_if(entry->plans.begin(), entry->plans.end(),
                                   [joints](const LockedPlan& known) { return known.joints == joints; });
    if (plan == entry->plans.end()) return nullptr;
    ik::Solutions found;
    double q[ik::max_solutions * ik::max_joints];
    if (!ik::solve_locked_goal(*plan->locked, goal, at, found, q)) return nullptr;
    const int n = int(PyTuple_GET_SIZE(entry->names));
    SolutionsObject* made = new_solutions(robot, goal, found.count, n, found.status);
    if (!made) return nullptr;
    made->complete = found.complete;
    std::copy(q, q + n * found.count, made->q);
    for (int k = 0; k < found.count; ++k) {
        branches_of(made)[k] = std::int8_t(found.branch[k]);
        self_motions_of(made)[k] = found.self_motion[k];
    }
    made->about = Py_NewRef(entry->about);
    return reinterpret_cast<PyObject*>(made);
}
