#include "dynamics.hpp"

#include <nanobind/stl/string.h>

#include "cspace/kinematics/forward.hpp"
#include "cspace/tolerances.hpp"
#include "kernels/dynamics.hpp"
#include "kinematics_rows.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

const char inverse_dynamics_doc[] =
    R"doc(inverse_dynamics($self, q, qd, qdd, *, gravity=(0, 0, -9.81), wrenches=None, expressed_in='base', friction=True, T_world_base=None, out=None, threads=None)
--

The joint torques and forces behind a motion (inverse dynamics).

tau = M(q) q̈ + C(q, q̇) q̇ + g(q) + friction − Σ Jᵀ w.

q (..., n): joint coordinates [rad or m]. qd, qdd (..., dof): velocities and accelerations; of a floating base
[v; ω] and [v̇; ω̇] come first, of its origin in world axes. gravity (3,) [m/s²] in the axes of the base, of the
world for a robot that is mounted. wrenches: frame → (..., 6), force and torque [N, N·m] of the world on the
robot at the origin of that frame, in the same axes, or with expressed_in="tip" in those of the frame. friction: with damping and dry friction of the joints;
their armature always counts. T_world_base (..., 4, 4): where the base is. out (..., dof): float64 array to
write into. threads: as in fk.

Returns tau (..., dof) [N·m or N]; of a floating base the wrench [f; n] at its origin, in world axes, comes
first. Raises InputError for a wrong shape or NaN and where no link has a mass, UnknownNameError for an
unknown frame.

Luh, Walker and Paul 1980; Featherstone 2008, section 5.3.)doc";

const char forward_dynamics_doc[] =
    R"doc(forward_dynamics($self, q, qd, tau, *, gravity=(0, 0, -9.81), wrenches=None, expressed_in='base', friction=True, T_world_base=None, out=None, threads=None)
--

The accelerations of the joints under given torques (forward dynamics).

q̈ = M(q)⁻¹ (tau − C(q, q̇) q̇ − g(q) − friction + Σ Jᵀ w).

q, qd, gravity, wrenches, expressed_in, friction, T_world_base, threads: as in inverse_dynamics. tau (..., dof) [N·m or N]:
of a floating base the wrench [f; n] on it comes first. out (..., dof): float64 array to write into.

Returns qdd (..., dof) [rad/s² or m/s²]. Raises InputError for a wrong shape or NaN, and where a joint moves no
inertia, which it names.

Featherstone 2008, section 7.3.)doc";

const char mass_matrix_doc[] =
    R"doc(mass_matrix($self, q, *, T_world_base=None, out=None, threads=None)
--

The mass matrix M of the kinetic energy ½ q̇ᵀ M(q) q̇, with the armature of the joints.

q (..., n): joint coordinates [rad or m]. T_world_base (..., 4, 4): where the base is. out (..., dof, dof):
float64 array to write into. threads: as in fk.

Returns M (..., dof, dof), symmetric; the rows and columns of a floating base, [v; ω] of its origin in world
axes, come first. Raises InputError for a wrong shape or NaN and where no link has a mass.

Walker and Orin 1982; Featherstone 2008, section 6.2.)doc";

const char gravity_torques_doc[] =
    R"doc(gravity_torques($self, q, *, gravity=(0, 0, -9.81), T_world_base=None, out=None, threads=None)
--

The torques and forces of the joints that hold the weight of the robot at rest.

q (..., n): joint coordinates [rad or m]. gravity (3,), T_world_base (..., 4, 4), threads: as in
inverse_dynamics. out (..., dof): float64 array to write into.

Returns g (..., dof) [N·m or N]; of a floating base the wrench that holds it comes first. Raises InputError for
a wrong shape or NaN and where no link has a mass.)doc";

namespace {

constexpr Vec3d earth = {0.0, 0.0, -9.81};
constexpr const char* words = "cspace.dynamics";

// The largest number of joints for which a single call works on the stack.
constexpr int stack_links = 64, stack_dof = stack_links + 6;
struct alignas(64) Stack {
    double values[80 * stack_links + stack_dof * (stack_dof + 5) + 8];
};

// Whether the rotation of T (4, 4) is one within tolerance::rotation_error and the rest fits, as in
// cspace.spatial.
bool is_pose(const double* T) {
    const Posed pose = kinematics::read_matrix(T);
    const Mat3d square = transpose(pose.R) * pose.R;
    double error = 0.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) error = std::max(error, std::fabs(square.m[i][j] - (i == j)));
    return error <= tolerance::rotation_error && norm(pose.t) < HUGE_VAL && T[12] == 0.0 && T[13] == 0.0 &&
           T[14] == 0.0 && T[15] == 1.0 &&
           dot(column(pose.R, 0), cross(column(pose.R, 1), column(pose.R, 2))) > 0.0;
}

// A call with as many configurations, velocities and forces as `count`, all of one row, and at most
// T_world_base besides: its arguments as rows.
struct Single {
    dynamics::Rows rows{};
    double copies[3][stack_dof], base[16];

    bool read_keywords(PyObject* const* values, PyObject* kwnames) {
        if (!kwnames || PyTuple_GET_SIZE(kwnames) == 0) return true;
        if (PyTuple_GET_SIZE(kwnames) > 1 ||
            PyUnicode_CompareWithASCIIString(PyTuple_GET_ITEM(kwnames, 0), "T_world_base") != 0)
            return false;
        rows.T_world_base = read_in_place(values[0], 4, 4, base);
        return rows.T_world_base && is_pose(rows.T_world_base);
    }
    bool read(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames, Py_ssize_t count) {
        KinematicsObject* robot = kinematics_of(self);
        if (!robot->model || nargs != count || !read_keywords(args + nargs, kwnames)) return false;
        const int n = robot->model->n_coordinates(), dof = velocities_of(*robot);
        if (n > stack_links || robot->model->n_joints() > stack_links || robot->model->mass() == 0.0)
            return false;
        const double* given[3] = {};
        for (Py_ssize_t k = 0; k < count; ++k) {
            given[k] = read_in_place(args[k], 0, k == 0 ? n : dof, copies[k]);
            if (!given[k]) return false;
        }
        rows.bodies = multibody_of(*robot);
        rows.gravity = earth;
        rows.floating = robot->floating;
        rows.rubs = true;
        rows.q = given[0];
        rows.qd = given[1];
        rows.force = given[2];
        return true;
    }
};

// The answer of a single call, or that of the free function of that name.
template <class Kernel>
PyObject* answer_call(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames,
                      Py_ssize_t count, bool square, Kernel kernel, const char* name) {
    Single call;
    if (call.read(self, args, nargs, kwnames, count)) {
        const npy_intp n = velocities_of(*kinematics_of(self));
        PyObject* result = square ? new_array({n, n}) : new_array({n});
        if (!result) return nullptr;
        call.rows.result = data_of(result);
        Stack stack;
        if (kernel(call.rows, 0, 1, &stack)) return result;
        Py_DECREF(result);
    }
    return call_python(words, name, name, self, args, nargs, kwnames);
}

}  // namespace

PyObject* compute_inverse_dynamics(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                   PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 3, false, kernels::inverse_rows, "inverse_dynamics");
}
PyObject* compute_forward_dynamics(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                   PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 3, false, kernels::forward_rows, "forward_dynamics");
}
PyObject* compute_mass_matrix(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 1, true, kernels::mass_rows, "mass_matrix");
}
PyObject* compute_gravity_torques(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                  PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 1, false, kernels::inverse_rows, "gravity_torques");
}

namespace {

bool dynamics_rows(nb::handle robot, const std::string& what, const ConstDoubles& q, const In& qd,
                   const In& force, const In& T_world_base, const ConstDoubles& gravity, bool rubs,
                   const Doubles& result, int threads) {
    KinematicsObject& object = robot_from(robot);
    dynamics::Rows rows{};
    rows.bodies = multibody_of(object);
    if (gravity.size != 3) throw nb::value_error("gravity has three numbers");
    rows.gravity = {gravity.data[0], gravity.data[1], gravity.data[2]};
    rows.floating = object.floating;
    rows.rubs = rubs;
    const int dof = velocities_of(object);
    const npy_intp count = row_count(q, rows.bodies.n_coordinates);
    rows.q = q.data;
    rows.qd = values_of(qd, count, dof);
    rows.force = values_of(force, count, dof);
    rows.T_world_base = shared_values(T_world_base, count, 16, rows.base_stride);
    rows.result = result.data;
    const auto run = [&](npy_intp size, auto kernel) {
        if (result.size != count * size) throw nb::value_error("the result has the wrong size");
        return run_kernel(rows, count, threads, kernel);
    };
    if (what == "inverse_dynamics") return run(dof, kernels::inverse_rows);
    if (what == "mass_matrix") return run(dof * dof, kernels::mass_rows);
    if (what == "forward_dynamics" && rows.force) return run(dof, kernels::forward_rows);
    const auto run_spatial = [&](dynamics::What which, npy_intp size) {
        rows.what = which;
        return run(size, kernels::spatial_rows);
    };
    if (what == "coriolis_matrix") return run_spatial(dynamics::What::coriolis, dof * dof);
    if (what == "derivatives") return run_spatial(dynamics::What::derivatives, 2 * dof * dof);
    if (what == "momentum") return run_spatial(dynamics::What::momentum, 6);
    if (what == "momentum_matrix") return run_spatial(dynamics::What::momentum_matrix, 6 * dof);
    if (what == "kinetic_energy" && rows.qd) return run_spatial(dynamics::What::kinetic, 1);
    if (what == "potential_energy") return run_spatial(dynamics::What::potential, 1);
    throw nb::value_error(("unknown or incomplete: " + what).c_str());
}

}  // namespace

void bind_dynamics(nb::module_& m) {
    m.def("_dynamics_rows", dynamics_rows, "robot"_a, "what"_a, "q"_a, "qd"_a.none(), "force"_a.none(),
          "T_world_base"_a.none(), "gravity"_a, "rubs"_a, "result"_a, "threads"_a,
          "Fills in the result; False if an argument is not finite, or M singular in forward dynamics.");
}
