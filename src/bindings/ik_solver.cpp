// The type behind cspace.ik.Solver, and how a solver is made.
#include "ik_solver.hpp"

#include <new>

#include "bindings.hpp"
#include "ik_chains.hpp"
#include "ik_shared.hpp"

using namespace cspace;

PyTypeObject* solver_type = nullptr;

namespace {

SolverObject* object_of(PyObject* self) { return reinterpret_cast<SolverObject*>(self); }

PyObject* create_solver(PyTypeObject* type, PyObject* args, PyObject* kwargs) {
    PyObject* self = create_kinematics(type, args, kwargs);
    if (!self) return nullptr;
    new (&object_of(self)->solver) std::unique_ptr<ik::Solver>();
    new (&object_of(self)->locked_sets) std::vector<LockedSet>();
    return self;
}
void free_solver(PyObject* self) {
    SolverObject* object = object_of(self);
    object->solver.~unique_ptr();
    object->locked_sets.~vector();
    Py_CLEAR(object->joint_names);
    Py_CLEAR(object->nearest_about);
    Py_CLEAR(object->locked_about);
    free_kinematics(self);
}

PyObject* solve(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    return solver_solve(self, "solve", args, nargs, kwnames);
}

PyMethodDef solver_methods[] = {{"solve", as_method(&solve), METH_FASTCALL | METH_KEYWORDS, solve_doc},
                                {nullptr, nullptr, 0, nullptr}};
PyType_Slot solver_slots[] = {{Py_tp_new, reinterpret_cast<void*>(&create_solver)},
                              {Py_tp_dealloc, reinterpret_cast<void*>(&free_solver)},
                              {Py_tp_methods, solver_methods},
                              {Py_tp_doc, const_cast<char*>("The compiled half of cspace.ik.Solver.")},
                              {0, nullptr}};
PyType_Spec solver_spec = {"cspace._core.SolverBase", sizeof(SolverObject), 0,
                           Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE, solver_slots};

}  // namespace

void bind_ik_solver(nanobind::module_& m) {
    PyObject* type = PyType_FromSpecWithBases(&solver_spec, reinterpret_cast<PyObject*>(kinematics_type));
    if (!type || PyModule_AddObjectRef(m.ptr(), "SolverBase", type) < 0) throw nanobind::python_error();
    solver_type = reinterpret_cast<PyTypeObject*>(type);  // kept for good
}

// _ik_build(solver, axes (n, 3), points (n, 3), prismatic (n,), T_zero (4, 4), lower (n,), upper (n,),
// weight (n,), reach): reads the arm of a new solver
PyObject* ik_build(PyObject*, PyObject* args) {
    PyObject *self, *axes, *points, *prismatic, *tip, *lower, *upper, *weight;
    double reach;
    if (!PyArg_ParseTuple(args, "OOOOOOOOd", &self, &axes, &points, &prismatic, &tip, &lower, &upper, &weight,
                          &reach))
        return nullptr;
    const npy_intp n =
        PyArray_Check(prismatic) ? PyArray_SIZE(reinterpret_cast<PyArrayObject*>(prismatic)) : -1;
    bool fits = n >= 1 && n <= ik::max_joints && is_doubles(axes, 3 * n) && is_doubles(points, 3 * n) &&
                is_doubles(tip, 16);
    for (PyObject* row : {prismatic, lower, upper, weight}) fits = fits && is_doubles(row, n);
    if (!fits) {
        PyErr_SetString(PyExc_TypeError, "_ik_build takes contiguous float64 arrays of matching sizes");
        return nullptr;
    }
    if (!PyObject_TypeCheck(self, solver_type) || solver_of(self)) {
        PyErr_SetString(PyExc_TypeError, "_ik_build takes a new solver");
        return nullptr;
    }
    PyObject* names = PyObject_GetAttrString(self, "joint_names");
    if (!names || !PyTuple_CheckExact(names) || PyTuple_GET_SIZE(names) != n) {
        Py_XDECREF(names);
        if (!PyErr_Occurred()) PyErr_SetString(PyExc_TypeError, "joint_names must be a tuple of n names");
        return nullptr;
    }
    object_of(self)->joint_names = names;
    object_of(self)->solver = std::make_unique<ik::Solver>(
        chain_from(int(n), data_of(axes), data_of(points), data_of(prismatic), data_of(tip)), data_of(lower),
        data_of(upper), data_of(weight), reach);
    Py_RETURN_NONE;
}
