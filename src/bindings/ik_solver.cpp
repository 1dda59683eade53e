// The type behind cspace.ik.Solver, and how a solver is made.
#include <new>

#include "bindings.hpp"
#include "cspace/kinematics/pose_matrix.hpp"
#include "ik.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

PyTypeObject* solver_type = nullptr;

namespace {

PyObject* create_solver(PyTypeObject* type, PyObject* args, PyObject* kwargs) {
    PyObject* self = create_kinematics(type, args, kwargs);
    if (!self) return nullptr;
    new (&solver_object(self)->core) std::unique_ptr<ik::Solver>();
    new (&solver_object(self)->locked_sets) std::vector<LockedSet>();
    return self;
}
void free_solver(PyObject* self) {
    SolverObject* object = solver_object(self);
    object->core.~unique_ptr();
    object->locked_sets.~vector();
    Py_CLEAR(object->joint_names);
    Py_CLEAR(object->nearest_about);
    Py_CLEAR(object->locked_about);
    free_kinematics(self);
}

PyObject* solve_goal(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    return solver_solve(self, "solve", args, nargs, kwnames);
}

PyMethodDef methods[] = {{"solve", as_method(&solve_goal), METH_FASTCALL | METH_KEYWORDS, solve_doc},
                         {nullptr, nullptr, 0, nullptr}};
PyType_Slot slots[] = {{Py_tp_new, reinterpret_cast<void*>(&create_solver)},
                       {Py_tp_dealloc, reinterpret_cast<void*>(&free_solver)},
                       {Py_tp_methods, methods},
                       {Py_tp_doc, const_cast<char*>("The compiled half of cspace.ik.Solver.")},
                       {0, nullptr}};
PyType_Spec spec = {"cspace._core.SolverBase", sizeof(SolverObject), 0,
                    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE, slots};

// The arm of a new solver from its joint axes at zero: axes (n, 3), points (n, 3), prismatic (n,), T_zero
// (4, 4), lower (n,), upper (n,), weight (n,).
void build_solver(nb::handle self, const ConstDoubles& axes, const ConstDoubles& points,
                  const ConstDoubles& prismatic, const ConstDoubles& T_zero, const ConstDoubles& lower,
                  const ConstDoubles& upper, const ConstDoubles& weight, double reach) {
    const npy_intp n = prismatic.size;
    if (n < 1 || n > ik::max_joints || axes.size != 3 * n || points.size != 3 * n || lower.size != n ||
        upper.size != n || weight.size != n || T_zero.size != 16)
        throw nb::type_error("_ik_build takes arrays of matching sizes");
    if (!PyObject_TypeCheck(self.ptr(), solver_type) || solver_object(self.ptr())->core)
        throw nb::type_error("_ik_build takes a new solver");
    nb::object names = self.attr("joint_names");
    if (!nb::isinstance<nb::tuple>(names) || nb::len(names) != std::size_t(n))
        throw nb::type_error("joint_names must be a tuple of n names");
    ik::Chain chain;
    chain.n = int(n);
    for (int i = 0; i < chain.n; ++i) {
        const double *axis = axes.data + 3 * i, *point = points.data + 3 * i;
        chain.axis[i] = {axis[0], axis[1], axis[2]};
        chain.point[i] = {point[0], point[1], point[2]};
        chain.prismatic[i] = prismatic.data[i] != 0;
    }
    chain.tip = kinematics::read_matrix(T_zero.data);
    SolverObject* object = solver_object(self.ptr());
    object->joint_names = names.release().ptr();
    object->core = std::make_unique<ik::Solver>(chain, lower.data, upper.data, weight.data, reach);
}

}  // namespace

void bind_ik_solver(nb::module_& m) {
    solver_type = add_type(m, spec, kinematics_type);
    m.def("_ik_build", build_solver, "solver"_a, "axes"_a, "points"_a, "prismatic"_a, "T_zero"_a, "lower"_a,
          "upper"_a, "weight"_a, "reach"_a, "Reads the arm of a new solver.");
}
