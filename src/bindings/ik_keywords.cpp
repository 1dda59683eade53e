// solver.solve(T, near=q), with limits=False or without, and solver.solve(T, locked={…}): the compiled entry
// for one goal.
// The first call with a set of joints goes through cspace.ik, which finds out whether they leave freedom.
#include <algorithm>
#include <cmath>
#include <limits>

#include "cspace/tolerances.hpp"
#include "ik.hpp"

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

// What answers say of themselves, with the values of the locked joints; null with an error.
PyObject* name_locked(PyObject* about, unsigned joints, const double* at) {
    PyObject *const none = PyTuple_New(0), *const values = PyDict_New();
    PyObject* const keywords = values ? Py_BuildValue("{sO}", "locked", values) : nullptr;
    bool is_good = none && keywords;
    for (int i = 0; i < ik::max_joints && is_good; ++i) {
        if (!(joints >> i & 1)) continue;
        PyObject *const joint = PyLong_FromLong(i), *const value = PyFloat_FromDouble(at[i]);
        is_good = joint && value && PyDict_SetItem(values, joint, value) == 0;
        Py_XDECREF(joint);
        Py_XDECREF(value);
    }
    PyObject* const made =
        is_good ? PyObject_Call(reinterpret_cast<PyObject*>(Py_TYPE(about)), none, keywords) : nullptr;
    Py_XDECREF(none);
    Py_XDECREF(values);
    Py_XDECREF(keywords);
    return made;
}

}  // namespace

PyObject* solve_near(PyObject* self, const double* goal, PyObject* near, bool within_limits) {
    ik::Solver& solver = *solver_object(self)->core;
    const int n = solver.chain().n;
    double copy[ik::max_joints], q[ik::max_joints];
    const double* seed = read_in_place(near, 0, n, copy);
    if (!seed || !std::all_of(seed, seed + n, [](double x) { return std::fabs(x) <= tolerance::farthest; }))
        return nullptr;
    std::int8_t branch = -1;
    PyObject* about = nullptr;
    if (solver.is_redundant()) {
        if (solver.exceeds_reach(goal)) return nullptr;
        about = solver_object(self)->nearest_about;
        ik::RedundantSolver& own = solver.redundant();
        ik::RedundantSolver& asked = within_limits ? own : own.without_limits();
        const bool is_same = within_limits || asked.default_locked() == own.default_locked();
        if (!about || !is_same || !asked.find_nearest_within(goal, seed, q).is_within) return nullptr;
    } else {
        double lower[ik::max_joints], upper[ik::max_joints];
        std::fill(lower, lower + n, -std::numeric_limits<double>::infinity());
        std::fill(upper, upper + n, std::numeric_limits<double>::infinity());
        const double* const bounds[2] = {within_limits ? solver.lower() : lower,
                                         within_limits ? solver.upper() : upper};
        if (!ik::nearest_listed(solver.arm(), bounds[0], bounds[1], goal, seed, q, &branch)) return nullptr;
    }
    return new_solutions(self, goal, {1, q, n, &branch, nullptr, ik::Status::exact}, about);
}

PyObject* solve_locked(PyObject* self, const double* goal, PyObject* locked) {
    const SolverObject* object = solver_object(self);
    double at[ik::max_joints] = {};
    const unsigned joints = read_locked(object->joint_names, locked, at);
    const std::vector<LockedSet>& known = object->locked_sets;
    const auto set =
        std::find_if(known.begin(), known.end(), [joints](const LockedSet& k) { return k.joints == joints; });
    if (!joints || set == known.end()) return nullptr;
    ik::SolutionStore store;
    ik::SolutionRows rows;
    if (!ik::solve_locked_goal(*set->plan, goal, at, store, rows)) return nullptr;
    if (rows.count) return new_solutions(self, goal, rows, object->locked_about);
    // The reason names the values.
    PyObject* const about = name_locked(object->locked_about, joints, at);
    PyObject* const out = about ? new_solutions(self, goal, rows, about) : nullptr;
    Py_XDECREF(about);
    return out;
}
