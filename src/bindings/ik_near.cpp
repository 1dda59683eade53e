// solver.solve(T, near=q): the compiled entry for one goal and one seed.
#include <algorithm>
#include <cmath>

#include "cspace/tolerances.hpp"
#include "ik_shared.hpp"

using namespace cspace;

namespace {

bool is_seed(PyObject* value, int n) {
    if (!PyArray_CheckExact(value) || !is_doubles(value, n) ||
        PyArray_NDIM(reinterpret_cast<PyArrayObject*>(value)) != 1)
        return false;
    for (int i = 0; i < n; ++i)
        if (!(std::fabs(data_of(value)[i]) <= tolerance::farthest)) return false;
    return true;
}

PyObject* one_row(PyObject* solver, const double* goal, const double* q, int n, int branch, PyObject* about) {
    SolutionsObject* made = new_solutions(solver, goal, 1, n, ik::Status::exact);
    if (!made) return nullptr;
    std::copy(q, q + n, made->q);
    branches_of(made)[0] = std::int8_t(branch);
    self_motions_of(made)[0] = 0;
    made->about = Py_XNewRef(about);
    return reinterpret_cast<PyObject*>(made);
}

}  // namespace

PyObject* ik_near(PyObject* self, const double* goal, PyObject* seed) {
    ik::Solver& solver = *solver_of(self);
    const int n = solver.chain().n;
    if (!is_seed(seed, n)) return nullptr;
    double q[ik::max_joints];
    std::int8_t branch = -1;
    PyObject* about = nullptr;
    if (solver.is_redundant()) {
        about = reinterpret_cast<SolverObject*>(self)->nearest_about;
        if (!about || !solver.redundant().find_nearest_turned(goal, data_of(seed), q)) return nullptr;
    } else if (!ik::nearest_listed(solver.arm(), solver.lower(), solver.upper(), goal, data_of(seed), q,
                                   &branch)) {
        return nullptr;
    }
    return one_row(self, goal, q, n, branch, about);
}
