// The type behind cspace.Robot: its kinematics, and the solver that its `ik` asks.
#include <cstring>
#include <string>

#include "bindings.hpp"
#include "ik.hpp"

namespace {

struct RobotObject {
    KinematicsObject kinematics;
    PyObject* solver;  // null until the first call of ik; never replaced
};
RobotObject* robot_of(PyObject* self) { return reinterpret_cast<RobotObject*>(self); }

using Slots = Collected<RobotObject, free_kinematics, &RobotObject::solver>;

// The property `solver` of the Python class builds the solver and leaves it in `_solver`.
PyObject* robot_ik(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    if (!robot_of(self)->solver) {
        PyObject* made = PyObject_GetAttrString(self, "solver");
        if (!made) return nullptr;
        Py_DECREF(made);
    }
    PyObject* solver = robot_of(self)->solver;
    if (solver) return solver_solve(solver, "ik", args, nargs, kwnames);
    PyErr_SetString(PyExc_TypeError, "the solver of a robot is a cspace.ik.Solver");
    return nullptr;
}
PyObject* get_solver(PyObject* self, void*) {
    PyObject* solver = robot_of(self)->solver;
    return Py_NewRef(solver ? solver : Py_None);
}
int set_solver(PyObject* self, PyObject* value, void*) {
    if (!value || !PyObject_TypeCheck(value, solver_type)) {
        PyErr_SetString(PyExc_TypeError, "the solver of a robot is a cspace.ik.Solver");
        return -1;
    }
    if (!robot_of(self)->solver) robot_of(self)->solver = Py_NewRef(value);
    return 0;
}

// A signature begins with the name of its method.
const std::string ik_doc = "ik" + std::string(solve_doc).substr(std::strlen("solve"));

PyMethodDef robot_methods[] = {{"ik", as_method(&robot_ik), METH_FASTCALL | METH_KEYWORDS, ik_doc.c_str()},
                               {nullptr, nullptr, 0, nullptr}};
PyGetSetDef robot_attributes[] = {
    {"_solver", &get_solver, &set_solver, "The solver, None before it is built; set once.", nullptr},
    {nullptr, nullptr, nullptr, nullptr, nullptr}};
PyType_Slot robot_slots[] = {{Py_tp_new, reinterpret_cast<void*>(&create_kinematics)},
                             {Py_tp_dealloc, reinterpret_cast<void*>(&Slots::destroy)},
                             {Py_tp_traverse, reinterpret_cast<void*>(&Slots::visit)},
                             {Py_tp_clear, reinterpret_cast<void*>(&Slots::clear)},
                             {Py_tp_methods, robot_methods},
                             {Py_tp_getset, robot_attributes},
                             {Py_tp_doc, const_cast<char*>("The compiled half of cspace.Robot.")},
                             {0, nullptr}};
PyType_Spec robot_spec = {"cspace._core.RobotBase", sizeof(RobotObject), 0,
                          Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_HAVE_GC, robot_slots};

}  // namespace

void bind_robot(nanobind::module_& m) { add_type(m, robot_spec, kinematics_type); }
