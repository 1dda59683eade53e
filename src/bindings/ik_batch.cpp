// solver.solve of many goals in one call.
#include <algorithm>

#include "ik_shared.hpp"

using namespace cspace;

namespace {

constexpr Py_ssize_t most_threads = 1024;

// What a call for many goals works on.
struct Batch {
    PyObject *solver, *goals, *q, *count, *status;
    Py_ssize_t threads;
};
bool read_batch(PyObject* args, const char* function, npy_intp numbers, Batch& b) {
    if (!PyArg_ParseTuple(args, "OOOOOn", &b.solver, &b.goals, &b.q, &b.count, &b.status, &b.threads))
        return false;
    const ik::BuiltArm* arm = arm_of(b.solver);
    const npy_intp n = PyArray_Check(b.count) ? PyArray_SIZE(reinterpret_cast<PyArrayObject*>(b.count)) : -1;
    if (arm && arm->room && (numbers != 3 || arm->has_few_joints) && n >= 0 &&
        is_doubles(b.goals, numbers * n) && is_doubles(b.q, n * arm->room * arm->dof) &&
        is_plain(b.count, NPY_INT64, n) && is_plain(b.status, NPY_UINT8, n) && is_writable(b.q) &&
        is_writable(b.count) && is_writable(b.status))
        return true;
    PyErr_Format(PyExc_TypeError,
                 "%s takes a solver and contiguous arrays: float64, count int64, status uint8", function);
    return false;
}

using SolveRows = std::size_t (*)(const ik::BuiltArm&, const ik::GoalRows&);

// All goals. Returns the first one refused, or their number, as a Python integer.
PyObject* solve_all(const Batch& b, SolveRows solve) {
    const auto array = [](PyObject* value) { return PyArray_DATA(reinterpret_cast<PyArrayObject*>(value)); };
    const ik::GoalRows rows = {data_of(b.goals),
                               std::size_t(PyArray_SIZE(reinterpret_cast<PyArrayObject*>(b.count))),
                               data_of(b.q),
                               static_cast<std::int64_t*>(array(b.count)),
                               static_cast<unsigned char*>(array(b.status)),
                               int(std::clamp<Py_ssize_t>(b.threads, 1, most_threads))};
    std::size_t refused;
    Py_BEGIN_ALLOW_THREADS;
    refused = solve(*arm_of(b.solver), rows);
    Py_END_ALLOW_THREADS;
    return PyLong_FromSize_t(refused);
}

}  // namespace

// _ik_many(solver, goals (n, 4, 4), q (n, k_max, dof), count (n,), status (n,), threads) → index of the first
// goal that is not a pose, or n
PyObject* ik_many(PyObject*, PyObject* args) {
    Batch b;
    return read_batch(args, "_ik_many", 16, b) ? solve_all(b, ik::solve_goals) : nullptr;
}

// _ik_positions(solver, points (n, 3), q (n, k_max, dof), count (n,), status (n,), threads) → index of the
// first point that is not finite or too far away, or n
PyObject* ik_positions(PyObject*, PyObject* args) {
    Batch b;
    return read_batch(args, "_ik_positions", 3, b) ? solve_all(b, ik::solve_points) : nullptr;
}
