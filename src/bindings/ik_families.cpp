// Families of configurations: in which direction one starts, and the curve that it runs along.
#include <algorithm>
#include <vector>

#include "cspace/ik/family_curve.hpp"
#include "ik_shared.hpp"

using namespace cspace;

namespace {

// The arm of a call whose first argument is a robot and the others rows of joints; null with an error set.
const ik::Arm* arm_for(const char* function, PyObject* robot, std::initializer_list<PyObject*> rows,
                       npy_intp k) {
    const ik::Arm* arm = arm_of(robot);
    bool fits = arm && can_solve(*arm) && k >= 0;
    for (PyObject* row : rows) fits = fits && is_doubles(row, k * arm->plan.chain.n);
    if (fits) return arm;
    PyErr_Format(PyExc_TypeError, "%s takes a robot with a solver and contiguous float64 rows of its joints",
                 function);
    return nullptr;
}
ik::Held held_at(const ik::Chain& chain, const double* q, bool whole_pose) {
    return {forward(chain, q), whole_pose, characteristic_length(chain)};
}
PyObject* array_of(const std::vector<double>& values, npy_intp rows, npy_intp columns) {
    npy_intp shape[2] = {rows, columns};
    PyObject* out = PyArray_SimpleNew(2, shape, NPY_DOUBLE);
    if (out) std::copy(values.begin(), values.end(), data_of(out));
    return out;
}
// Joints in units of the arm, in which tangents are unit, from and to joints as numbers.
void scale(const ik::Chain& chain, double length, double* v, bool to_units) {
    for (int i = 0; i < chain.n; ++i)
        if (chain.prismatic[i]) v[i] *= to_units ? 1 / length : length;
}

}  // namespace

// _ik_direction(robot, q (n,), whole_pose) → the unit joint velocity (n,) of the self-motion through q, or
// None
PyObject* ik_direction(PyObject*, PyObject* args) {
    PyObject *robot, *at;
    int whole_pose;
    if (!PyArg_ParseTuple(args, "OOp", &robot, &at, &whole_pose)) return nullptr;
    const ik::Arm* arm = arm_for("_ik_direction", robot, {at}, 1);
    if (!arm) return nullptr;
    const ik::Chain& chain = arm->plan.chain;
    const double* q = data_of(at);
    const ik::Held held = held_at(chain, q, whole_pose);
    PoseError error;
    measure_held(chain, held, q, error);
    double d[ik::max_joints];
    const bool found = whole_pose
                           ? find_self_motion(chain, held.goal, held.length, q, error.jacobian, d)
                           : start_direction(chain, held, q, error.jacobian.v[weakest(error.jacobian)], d);
    if (!found) Py_RETURN_NONE;
    if (!whole_pose) scale(chain, held.length, d, false);
    const double size = std::sqrt(dot_n(d, d, chain.n));
    npy_intp n = chain.n;
    PyObject* out = PyArray_SimpleNew(1, &n, NPY_DOUBLE);
    for (int i = 0; out && i < chain.n; ++i) data_of(out)[i] = d[i] / size;
    return out;
}

// _ik_follow(robot, q (n,), direction (n,), whole_pose) → (configurations (m, n), tangents (m, n), end): the
// family through q from there on
PyObject* ik_follow(PyObject*, PyObject* args) {
    PyObject *robot, *at, *direction;
    int whole_pose;
    if (!PyArg_ParseTuple(args, "OOOp", &robot, &at, &direction, &whole_pose)) return nullptr;
    const ik::Arm* arm = arm_for("_ik_follow", robot, {at, direction}, 1);
    if (!arm) return nullptr;
    const ik::Chain& chain = arm->plan.chain;
    const ik::Held held = held_at(chain, data_of(at), whole_pose);
    std::vector<double> curve, tangents;
    double along[ik::max_joints];
    std::copy(data_of(direction), data_of(direction) + chain.n, along);
    scale(chain, held.length, along, true);
    const auto visit = [&](const double* q, const double* t) {
        curve.insert(curve.end(), q, q + chain.n);
        tangents.insert(tangents.end(), t, t + chain.n);
        scale(chain, held.length, tangents.data() + tangents.size() - chain.n, false);
    };
    const ik::CurveEnd end = follow_curve(chain, held, data_of(at), along, visit);
    const auto rows = npy_intp(curve.size()) / chain.n;
    return Py_BuildValue("NNi", array_of(curve, rows, chain.n), array_of(tangents, rows, chain.n), int(end));
}

// _ik_onto(robot, q (n,), near (k, n), along (k, n), whole_pose) → (configurations (k, n), tangents (k, n)):
// each row of `near` brought onto the family through q, NaN where that failed
PyObject* ik_onto(PyObject*, PyObject* args) {
    PyObject *robot, *at, *near, *along;
    int whole_pose;
    if (!PyArg_ParseTuple(args, "OOOOp", &robot, &at, &near, &along, &whole_pose)) return nullptr;
    const ik::Arm* arm = arm_for("_ik_onto", robot, {at}, 1);
    if (!arm) return nullptr;
    const ik::Chain& chain = arm->plan.chain;
    const npy_intp n = chain.n;
    const npy_intp k = PyArray_Check(near) ? PyArray_SIZE(reinterpret_cast<PyArrayObject*>(near)) / n : -1;
    if (!arm_for("_ik_onto", robot, {near, along}, k)) return nullptr;
    const ik::Held held = held_at(chain, data_of(at), whole_pose);
    std::vector<double> rows(data_of(near), data_of(near) + k * n),
        tangents(data_of(along), data_of(along) + k * n);
    for (npy_intp i = 0; i < k; ++i) {
        double *q = rows.data() + i * n, *t = tangents.data() + i * n, tangent[ik::max_joints];
        PoseError error;
        scale(chain, held.length, t, true);
        const bool arrived =
            onto_curve(chain, held, q, error) && tangent_at(chain, error.jacobian, t, tangent);
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        for (int j = 0; j < n; ++j) t[j] = arrived ? tangent[j] : none;
        if (!arrived) std::fill(q, q + n, none);
        scale(chain, held.length, t, false);
    }
    return Py_BuildValue("NN", array_of(rows, k, n), array_of(tangents, k, n));
}
