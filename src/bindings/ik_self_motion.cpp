// Families of configurations: in which direction one starts, and the curve that it runs along.
#include "library/ik_self_motion.hpp"

#include <algorithm>
#include <vector>

#include "ik_shared.hpp"

using namespace cspace;

namespace {

// The arm of a call whose first argument is a solver and the others rows of joints; null with an error set.
const ik::BuiltArm* arm_for(const char* function, PyObject* solver, std::initializer_list<PyObject*> rows,
                            npy_intp k) {
    const ik::BuiltArm* arm = arm_of(solver);
    bool fits = arm && arm->room && k >= 0;
    for (PyObject* row : rows) fits = fits && is_doubles(row, k * arm->dof);
    if (fits) return arm;
    PyErr_Format(PyExc_TypeError, "%s takes a solver and contiguous float64 rows of its joints", function);
    return nullptr;
}
PyObject* array_of(const std::vector<double>& values, npy_intp rows, npy_intp columns) {
    npy_intp shape[2] = {rows, columns};
    PyObject* out = PyArray_SimpleNew(2, shape, NPY_DOUBLE);
    if (out) std::copy(values.begin(), values.end(), data_of(out));
    return out;
}
// Joints in units of the arm, in which tangents are unit, from and to joints as numbers.

}  // namespace

// _ik_direction(solver, q (n,), whole_pose) → the unit joint velocity (n,) of the self-motion through q, or
// None
PyObject* ik_direction(PyObject*, PyObject* args) {
    PyObject *solver, *at;
    int whole_pose;
    if (!PyArg_ParseTuple(args, "OOp", &solver, &at, &whole_pose)) return nullptr;
    const ik::BuiltArm* arm = arm_for("_ik_direction", solver, {at}, 1);
    if (!arm) return nullptr;
    double d[ik::max_joints];
    if (!ik::self_motion_direction(*arm, data_of(at), whole_pose, d)) Py_RETURN_NONE;
    npy_intp n = arm->dof;
    PyObject* out = PyArray_SimpleNew(1, &n, NPY_DOUBLE);
    if (out) std::copy(d, d + n, data_of(out));
    return out;
}

// _ik_follow(solver, q (n,), direction (n,), whole_pose) → (configurations (m, n), tangents (m, n), end): the
// family through q from there on
PyObject* ik_follow(PyObject*, PyObject* args) {
    PyObject *solver, *at, *direction;
    int whole_pose;
    if (!PyArg_ParseTuple(args, "OOOp", &solver, &at, &direction, &whole_pose)) return nullptr;
    const ik::BuiltArm* arm = arm_for("_ik_follow", solver, {at, direction}, 1);
    if (!arm) return nullptr;
    const ik::SelfMotionCurve curve =
        ik::follow_self_motion(*arm, data_of(at), data_of(direction), whole_pose);
    const auto rows = npy_intp(curve.q.size()) / arm->dof;
    return Py_BuildValue("NNi", array_of(curve.q, rows, arm->dof), array_of(curve.tangents, rows, arm->dof),
                         curve.end);
}

// _ik_onto(solver, q (n,), near (k, n), along (k, n), whole_pose) → (configurations (k, n), tangents (k, n)):
// each row of `near` brought onto the family through q, NaN where that failed
PyObject* ik_onto(PyObject*, PyObject* args) {
    PyObject *solver, *at, *near, *along;
    int whole_pose;
    if (!PyArg_ParseTuple(args, "OOOOp", &solver, &at, &near, &along, &whole_pose)) return nullptr;
    const ik::BuiltArm* arm = arm_for("_ik_onto", solver, {at}, 1);
    if (!arm) return nullptr;
    const npy_intp n = arm->dof;
    const npy_intp k = PyArray_Check(near) ? PyArray_SIZE(reinterpret_cast<PyArrayObject*>(near)) / n : -1;
    if (!arm_for("_ik_onto", solver, {near, along}, k)) return nullptr;
    std::vector<double> rows(data_of(near), data_of(near) + k * n),
        tangents(data_of(along), data_of(along) + k * n);
    ik::project_on_self_motion(*arm, data_of(at), whole_pose, int(k), rows.data(), tangents.data());
    return Py_BuildValue("NN", array_of(rows, k, n), array_of(tangents, k, n));
}
