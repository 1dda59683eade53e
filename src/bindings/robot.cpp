// The type behind cspace.Robot: its kinematics, the solver of its `ik` and the checks of its `collides`.
#include <cmath>
#include <cstring>
#include <string>

#include "bindings.hpp"
#include "collision.hpp"
#include "dynamics.hpp"
#include "ik.hpp"

using namespace nanobind::literals;

namespace {

struct RobotObject {
    KinematicsObject kinematics;
    PyObject* solver;  // null until the first call of ik; never replaced
    // The scene that was checked last and its CollisionChecker, without a margin; null before.
    PyObject *scene, *checker;
};
PyTypeObject* robot_type = nullptr;
RobotObject* robot_of(PyObject* self) { return reinterpret_cast<RobotObject*>(self); }

using Slots =
    Collected<RobotObject, free_kinematics, &RobotObject::solver, &RobotObject::scene, &RobotObject::checker>;

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

// The answer for one configuration in the scene that was checked last; null, without an error, for other
// calls.
PyObject* collides_in_last_scene(RobotObject* robot, PyObject* const* args, Py_ssize_t nargs) {
    if (!robot->checker || nargs < 1 || nargs > 2 || (nargs == 2 ? args[1] : Py_None) != robot->scene)
        return nullptr;
    const auto& checker = *nanobind::inst_ptr<cspace::collision::Checker>(robot->checker);
    ConstDoubles q;
    if (!q.read(args[0]) || q.ndim() != 1 || q.size != checker.dof() || !checker.takes(q.data))
        return nullptr;
    const auto memory = checker.borrow_workspace();
    return Py_NewRef(checker.is_free(q.data, *memory) ? Py_False : Py_True);
}
PyObject* robot_collides(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    return or_error([&]() -> PyObject* {
        if (!kwnames)
            if (PyObject* known = collides_in_last_scene(robot_of(self), args, nargs)) return known;
        const nanobind::object check = nanobind::module_::import_("cspace.collision").attr("collides");
        const Py_ssize_t named = kwnames ? PyTuple_GET_SIZE(kwnames) : 0;
        std::vector<PyObject*> all = {self};
        all.insert(all.end(), args, args + nargs + named);
        return PyObject_Vectorcall(check.ptr(), all.data(), std::size_t(nargs) + 1, kwnames);
    });
}
const char collides_doc[] =
    "collides(q, scene=None, *, margin=0.0, threads=None)\n--\n\n"
    "Whether the robot touches an obstacle or itself at q (..., dof) [rad or m].\n\n"
    "Returns a bool, for a batch an array (...) of bool. scene: None for self-collision alone. margin [m]:\n"
    "everything closer than this counts as touching. threads: 0 for all. See collision.collides, which also\n"
    "names the errors.";

// A signature begins with the name of its method.
const std::string ik_doc = "ik" + std::string(solve_doc).substr(std::strlen("solve"));

PyMethodDef robot_methods[] = {
    {"ik", as_method(&robot_ik), METH_FASTCALL | METH_KEYWORDS, ik_doc.c_str()},
    {"collides", as_method(&robot_collides), METH_FASTCALL | METH_KEYWORDS, collides_doc},
    {"inverse_dynamics", as_method(&compute_inverse_dynamics), METH_FASTCALL | METH_KEYWORDS,
     inverse_dynamics_doc},
    {"forward_dynamics", as_method(&compute_forward_dynamics), METH_FASTCALL | METH_KEYWORDS,
     forward_dynamics_doc},
    {"mass_matrix", as_method(&compute_mass_matrix), METH_FASTCALL | METH_KEYWORDS, mass_matrix_doc},
    {"gravity_torques", as_method(&compute_gravity_torques), METH_FASTCALL | METH_KEYWORDS,
     gravity_torques_doc},
    {"coriolis_matrix", as_method(&compute_coriolis_matrix), METH_FASTCALL | METH_KEYWORDS,
     coriolis_matrix_doc},
    {"centroidal_momentum", as_method(&compute_centroidal_momentum), METH_FASTCALL | METH_KEYWORDS,
     centroidal_momentum_doc},
    {"centroidal_momentum_matrix", as_method(&compute_momentum_matrix), METH_FASTCALL | METH_KEYWORDS,
     momentum_matrix_doc},
    {"kinetic_energy", as_method(&compute_kinetic_energy), METH_FASTCALL | METH_KEYWORDS, kinetic_energy_doc},
    {"potential_energy", as_method(&compute_potential_energy), METH_FASTCALL | METH_KEYWORDS,
     potential_energy_doc},
    {"inverse_dynamics_derivatives", as_method(&compute_inverse_derivatives), METH_FASTCALL | METH_KEYWORDS,
     inverse_derivatives_doc},
    {"forward_dynamics_derivatives", as_method(&compute_forward_derivatives), METH_FASTCALL | METH_KEYWORDS,
     forward_derivatives_doc},
    {"regressor", as_method(&compute_regressor), METH_FASTCALL | METH_KEYWORDS, regressor_doc},
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

// The scene that was checked last, and its checker without a margin: `collides` asks it again.
void remember_checker(nanobind::handle robot, nanobind::object scene, nanobind::object checker) {
    if (!PyObject_TypeCheck(robot.ptr(), robot_type) ||
        !nanobind::isinstance<cspace::collision::Checker>(checker))
        throw nanobind::type_error("_remember_checker takes a robot, a scene and a CollisionChecker");
    Py_XSETREF(robot_of(robot.ptr())->scene, scene.release().ptr());
    Py_XSETREF(robot_of(robot.ptr())->checker, checker.release().ptr());
}

}  // namespace

void bind_robot(nanobind::module_& m) {
    robot_type = add_type(m, robot_spec, kinematics_type);
    m.def("_remember_checker", remember_checker, "robot"_a, "scene"_a.none(), "checker"_a);
}
