// solver.solve(T, locked={…}): the compiled entry for one goal with joints locked at numbers. The first call
// with a set of joints goes through cspace.ik, which finds out whether they leave freedom.
#include <algorithm>
#include <cmath>
#include <vector>

#include "cspace/tolerances.hpp"
#include "ik_shared.hpp"

using namespace cspace;

namespace {

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

PyObject* ik_locked(PyObject* self, const double* goal, PyObject* locked_values) {
    const auto* object = reinterpret_cast<const SolverObject*>(self);
    double at[ik::max_joints] = {};
    const unsigned joints = read_locked(object->joint_names, locked_values, at);
    const std::vector<LockedSet>& known = object->locked_sets;
    const auto set =
        std::find_if(known.begin(), known.end(), [joints](const LockedSet& k) { return k.joints == joints; });
    if (!joints || set == known.end()) return nullptr;
    ik::Solutions found;
    double q[ik::max_solutions * ik::max_joints];
    // Where nothing reaches the goal there is more to say.
    if (!ik::solve_locked_goal(*set->plan, goal, at, found, q)) return nullptr;
    const int n = object->solver->chain().n;
    SolutionsObject* made = new_solutions(self, goal, found.count, n, found.status);
    if (!made) return nullptr;
    made->complete = found.complete;
    std::copy(q, q + n * found.count, made->q);
    for (int k = 0; k < found.count; ++k) {
        branches_of(made)[k] = std::int8_t(found.branch[k]);
        self_motions_of(made)[k] = found.self_motion[k];
    }
    made->about = Py_XNewRef(object->locked_about);
    return reinterpret_cast<PyObject*>(made);
}
