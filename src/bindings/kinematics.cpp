#define CSPACE_FILLS_NUMPY_API
#include "kinematics.hpp"

#include <nanobind/stl/string.h>

#include <new>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "cspace/dynamics/make_links.hpp"
#include "kernels/kinematics.hpp"

namespace nb = nanobind;
using namespace cspace;

PyTypeObject* kinematics_type = nullptr;

PyObject* call_python(const char* module, const char* function, const char* method, PyObject* self,
                      PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    return or_error([&]() -> PyObject* {
        const nb::object callee = nb::module_::import_(module).attr(function);
        std::vector<PyObject*> all = {self};
        all.insert(all.end(), args, args + nargs + (kwnames ? PyTuple_GET_SIZE(kwnames) : 0));
        PyObject* answer = PyObject_Vectorcall(callee.ptr(), all.data(), std::size_t(nargs) + 1, kwnames);
        if (answer || !PyErr_ExceptionMatches(PyExc_TypeError)) return answer;
        // "function() got an unexpected …" becomes "method() got an unexpected …".
        nb::python_error error;
        const std::string text = nb::str(error.value()).c_str(), name = function;
        if (!text.starts_with(name + "()")) {
            error.restore();
            return nullptr;
        }
        const nb::object renamed =
            nb::module_::import_("cspace.errors")  // which knows names that people bring
                .attr("keyword_error")(method + text.substr(name.size()));
        PyErr_SetObject(renamed.type().ptr(), renamed.ptr());
        return nullptr;
    });
}

// It holds no reference that could come back to it (a dict of strings and integers), so it takes no part in
// the search for cycles; a Python subclass does, through its own dictionary.
PyObject* create_kinematics(PyTypeObject* type, PyObject*, PyObject*) {
    auto* made = reinterpret_cast<KinematicsObject*>(type->tp_alloc(type, 0));
    if (!made) return nullptr;
    new (&made->model) std::unique_ptr<const model::RobotModel>();
    new (&made->links) std::unique_ptr<const dynamics::Links>();
    made->frame_index = nullptr;
    made->tip = -1;
    made->floating = false;
    return reinterpret_cast<PyObject*>(made);
}
void free_kinematics(PyObject* self) {
    Py_CLEAR(kinematics_of(self)->frame_index);
    kinematics_of(self)->links.~unique_ptr();
    kinematics_of(self)->model.~unique_ptr();
    free_object(self);
}

const dynamics::Links& links_of(KinematicsObject& robot) {
    if (!robot.links) robot.links = std::make_unique<const dynamics::Links>(robot.model->tree());
    return *robot.links;
}

namespace {

constexpr char fk_doc[] =
    R"doc(fk($self, q, frame=None, *, T_world_base=None, out=None, threads=None)
--

The pose of a frame at a configuration (forward kinematics).

T_base_frame(q) = L₀ M₁(q₁) L₁ M₂(q₂) … Lₙ, with the joint motions Mᵢ (a turn or a slide) and the fixed Lᵢ
between.

q (..., n): joint coordinates [rad or m], in the order of `joint_names`. frame: its name; without it the tip.
T_world_base (..., 4, 4): where the base is, for a floating base or to place the robot; the result is then
T_world_frame. out (..., 4, 4): float64 array to write into. threads: 1 for one configuration, for a batch all
processors (0 or None).

Returns T (..., 4, 4), which maps coordinates in the frame to coordinates in the base. In a batch, rows of NaN
alone, such as robot.ik(Ts).q has behind the last solution of a goal, give poses of NaN.
Raises InputError for a wrong shape or any other NaN, UnknownNameError for an unknown frame.

Murray, Li and Sastry 1994, section 3.2.)doc";

constexpr char jacobian_doc[] =
    R"doc(jacobian($self, q, frame=None, *, point=None, expressed_in='base', T_world_base=None, out=None, threads=None)
--

The geometric Jacobian of a frame, or of a point fixed to it.

[v; ω] = J(q) q̇, where v [m/s] is the velocity of the point and ω [rad/s] the angular velocity of the frame.

q (..., n): joint coordinates [rad or m]. frame: its name; without it the tip. point (..., 3): in
coordinates of that frame [m]; without it the origin. expressed_in: "base" (the axes in which fk gives its
result) or "tip" (the axes of the frame itself). T_world_base (..., 4, 4): where the base is. out (..., 6,
dof): float64 array to write into. threads: as in fk.

Returns J (..., 6, dof), rows [v; ω]; the columns of a floating base, [v; ω] of the base at its origin in
world axes, come first; rows of NaN as in fk. Raises InputError for a wrong shape or any other NaN,
UnknownNameError for an unknown frame or axes.

Whitney 1969; Siciliano et al. 2009, section 3.1.)doc";

constexpr char fk_jacobian_doc[] =
    R"doc(fk_jacobian($self, q, frame=None, *, point=None, expressed_in='base', T_world_base=None, out=None, threads=None)
--

The pose and the Jacobian of a frame in one pass, for less than the price of both.

q, frame, point, expressed_in, T_world_base, threads: as in jacobian. out: the pair of arrays to write into.

Returns (T, J): T (..., 4, 4) as of fk, J (..., 6, dof) as of jacobian.)doc";

// The largest number of coordinates and of joints on a path for which a single call works on the stack.
constexpr int stack_joints = 32;

// What a single call needs, if it is one: `call(q)` or `call(q, frame)`, the frame by position or by name.
struct Single {
    const model::Chain* chain = nullptr;
    const double* q = nullptr;
    double copy[stack_joints];
};
bool read_single(const KinematicsObject* robot, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames,
                 Single& call) {
    if (!robot->model || nargs < 1) return false;
    int frame = robot->tip;
    const Py_ssize_t given = nargs + (kwnames ? PyTuple_GET_SIZE(kwnames) : 0);
    if (given > 2) return false;
    if (given == 2) {
        if (kwnames && nargs == 1 &&
            PyUnicode_CompareWithASCIIString(PyTuple_GET_ITEM(kwnames, 0), "frame") != 0) {
            return false;
        }
        if (!PyUnicode_CheckExact(args[1])) return false;
        PyObject* number = PyDict_GetItemWithError(robot->frame_index, args[1]);
        if (!number) {
            PyErr_Clear();
            return false;
        }
        frame = int(PyLong_AsLong(number));
    }
    if (frame < 0) return false;
    call.chain = &robot->model->chain(frame);
    const int n = robot->model->n_coordinates();
    if (call.chain->n > stack_joints || n > stack_joints) return false;
    call.q = read_in_place(args[0], 0, n, call.copy);
    return call.q != nullptr;
}

// Scratch memory of one configuration: two sines and an axis per joint.
struct alignas(64) Stack {
    double values[8 * (stack_joints + 4)];
};

constexpr const char* words = "cspace.kinematics";

// --- methods -------------------------------------------------------------------------------------------
PyObject* compute_fk(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    const KinematicsObject* robot = kinematics_of(self);
    Single call;
    if (read_single(robot, args, nargs, kwnames, call)) {
        PyObject* T = new_array({4, 4});
        if (!T) return nullptr;
        Stack stack;
        if (kernels::chain_pose(*call.chain, call.q, data_of(T), &stack)) return T;
        Py_DECREF(T);
    }
    return call_python(words, "forward_kinematics", "fk", self, args, nargs, kwnames);
}

// The Jacobian, and with the pose a tuple of both.
template <bool with_pose>
PyObject* compute_jacobian(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    const KinematicsObject* robot = kinematics_of(self);
    Single call;
    if (!robot->floating && read_single(robot, args, nargs, kwnames, call)) {
        PyObject* J = new_array({6, robot->model->n_coordinates()});
        PyObject* T = with_pose && J ? new_array({4, 4}) : nullptr;
        PyObject* answer = !with_pose ? J : T ? PyTuple_New(2) : nullptr;
        if (with_pose && answer) {
            PyTuple_SET_ITEM(answer, 0, T);
            PyTuple_SET_ITEM(answer, 1, J);
        } else if (with_pose) {
            Py_XDECREF(T);
            Py_XDECREF(J);
        }
        Stack stack;
        const bool is_found = answer && kernels::chain_jacobian(*call.chain, call.q, T ? data_of(T) : nullptr,
                                                                data_of(J), &stack);
        if (is_found) return answer;
        Py_XDECREF(answer);
        if (PyErr_Occurred()) return nullptr;
    }
    const char* name = with_pose ? "fk_jacobian" : "jacobian";
    return call_python(words, name, name, self, args, nargs, kwnames);
}

PyObject* get_dof(PyObject* self, void*) {
    const KinematicsObject* robot = kinematics_of(self);
    if (!robot->model) return PyLong_FromLong(0);
    return PyLong_FromLong(robot->model->n_coordinates() + (robot->floating ? 6 : 0));
}

// --- the type ------------------------------------------------------------------------------------------
PyMethodDef methods[] = {
    {"fk", as_method(&compute_fk), METH_FASTCALL | METH_KEYWORDS, fk_doc},
    {"jacobian", as_method(&compute_jacobian<false>), METH_FASTCALL | METH_KEYWORDS, jacobian_doc},
    {"fk_jacobian", as_method(&compute_jacobian<true>), METH_FASTCALL | METH_KEYWORDS, fk_jacobian_doc},
    {nullptr, nullptr, 0, nullptr}};
PyGetSetDef attributes[] = {
    {"dof", &get_dof, nullptr, "Number of velocities: one per coordinate, and six more for a floating base.",
     nullptr},
    {nullptr, nullptr, nullptr, nullptr, nullptr}};
PyType_Slot slots[] = {
    {Py_tp_new, reinterpret_cast<void*>(&create_kinematics)},
    {Py_tp_init, reinterpret_cast<void*>(&kinematics_load)},
    {Py_tp_dealloc, reinterpret_cast<void*>(&free_kinematics)},
    {Py_tp_methods, methods},
    {Py_tp_getset, attributes},
    {Py_tp_doc, const_cast<char*>("The compiled half of cspace.kinematics.KinematicModel.")},
    {0, nullptr}};
PyType_Spec spec = {"cspace._core.KinematicsBase", sizeof(KinematicsObject), 0,
                    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE, slots};

int fill_numpy_api() {
    import_array1(-1);
    return 0;
}

}  // namespace

void bind_kinematics(nanobind::module_& m) {
    if (fill_numpy_api() < 0) throw nanobind::python_error();
    kinematics_type = add_type(m, spec);
}
