#include "dynamics.hpp"

#include <nanobind/stl/string.h>

#include <vector>

#include "cspace/dynamics/make_links.hpp"
#include "cspace/kinematics/pose_matrix.hpp"
#include "cspace/tolerances.hpp"
#include "kernels/dynamics.hpp"
#include "kinematics_rows.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

const char inverse_dynamics_doc[] =
    R"doc(inverse_dynamics($self, q, qd, qdd, *, gravity=(0, 0, -9.81), wrenches=None, expressed_in='base', friction=True, T_world_base=None, out=None, threads=None, dtype='float64')
--

The joint torques and forces behind a motion (inverse dynamics).

tau = M(q) q̈ + C(q, q̇) q̇ + g(q) + friction − Σ Jᵀ w.

q (..., n): joint coordinates [rad or m]. qd, qdd (..., dof): velocities and accelerations; of a floating base
[v; ω] and [v̇; ω̇] come first, of its origin in world axes. gravity (3,) [m/s²] in the axes of the base, of the
world for a robot that is mounted. wrenches: frame → (..., 6), force and torque [N, N·m] of the world on the
robot at the origin of that frame, in the same axes, or with expressed_in="tip" in those of the frame.
friction: with damping and dry friction of the joints; their armature always counts. T_world_base (..., 4, 4):
where the base is. out (..., dof): array of that dtype to write into. threads: as in fk. dtype: float32 computes
in single precision, twice as many rows at a time: arrays of float32 are taken as they are, the answer is one,
and errors are about a millionth of the largest torque; values of joints are then below 10,000.

Returns tau (..., dof) [N·m or N]; of a floating base the wrench [f; n] at its origin, in world axes, comes
first. Raises InputError for a wrong shape or NaN and where no link has a mass, UnknownNameError for an
unknown frame.

Luh, Walker and Paul 1980; Featherstone 2008, section 5.3.)doc";

const char forward_dynamics_doc[] =
    R"doc(forward_dynamics($self, q, qd, tau, *, gravity=(0, 0, -9.81), wrenches=None, expressed_in='base', friction=True, T_world_base=None, out=None, threads=None, dtype='float64')
--

The accelerations of the joints under given torques (forward dynamics).

q̈ = M(q)⁻¹ (tau − C(q, q̇) q̇ − g(q) − friction + Σ Jᵀ w).

q, qd, gravity, wrenches, expressed_in, friction, T_world_base, threads: as in inverse_dynamics. tau (..., dof)
[N·m or N]: of a floating base the wrench [f; n] on it comes first. out (..., dof): array of that dtype to write
into. dtype: as in inverse_dynamics; errors of float32 grow with the condition of M.

Returns qdd (..., dof) [rad/s² or m/s²]. Raises InputError for a wrong shape or NaN, and where a joint moves no
inertia, which it names.

Featherstone 2008, section 7.3.)doc";

const char mass_matrix_doc[] =
    R"doc(mass_matrix($self, q, *, T_world_base=None, out=None, threads=None, dtype='float64')
--

The mass matrix M of the kinetic energy ½ q̇ᵀ M(q) q̇, with the armature of the joints.

q (..., n): joint coordinates [rad or m]. T_world_base (..., 4, 4): where the base is. out (..., dof, dof):
array of that dtype to write into. threads: as in fk. dtype: as in inverse_dynamics.

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

const char coriolis_matrix_doc[] =
    R"doc(coriolis_matrix($self, q, qd, *, T_world_base=None, out=None, threads=None)
--

The Coriolis matrix C(q, q̇): C q̇ are the forces of velocities, and Ṁ = C + Cᵀ.

Of all matrices with these forces it is the one of Christoffel's symbols, so that Ṁ − 2 C is antisymmetric, as
control laws assume.

q (..., n) [rad or m], qd (..., dof) [rad/s or m/s]; of a floating base [v; ω] comes first. T_world_base
(..., 4, 4): where the base is. out (..., dof, dof): float64 array to write into. threads: as in fk.

Returns C (..., dof, dof). Raises InputError for a wrong shape or NaN and where no link has a mass.

Echeandia and Wensing 2021, algorithm 1.)doc";

const char centroidal_momentum_doc[] =
    R"doc(centroidal_momentum($self, q, qd, *, T_world_base=None, out=None, threads=None)
--

The momentum of the whole robot: linear, and angular about its centre of mass.

Without external forces it does not change, apart from the weight, which changes the linear part alone.

q (..., n) [rad or m], qd (..., dof) [rad/s or m/s]; of a floating base [v; ω] comes first. T_world_base
(..., 4, 4): where the base is. out (..., 6): float64 array to write into. threads: as in fk.

Returns [l; k] (..., 6) [kg·m/s, kg·m²/s] in the axes of the base, of the world where the base is placed. Raises
InputError for a wrong shape or NaN and where no link has a mass.

Orin, Goswami and Lee 2013.)doc";

const char momentum_matrix_doc[] =
    R"doc(centroidal_momentum_matrix($self, q, *, T_world_base=None, out=None, threads=None)
--

The matrix A with [l; k] = A(q) q̇; see centroidal_momentum.

q (..., n) [rad or m], T_world_base (..., 4, 4), out (..., 6, dof), threads: as there. Returns A (..., 6, dof).
Raises InputError for a wrong shape or NaN and where no link has a mass.)doc";

const char kinetic_energy_doc[] =
    R"doc(kinetic_energy($self, q, qd, *, T_world_base=None, out=None, threads=None)
--

The kinetic energy ½ q̇ᵀ M(q) q̇, that of rotors (armature) included.

q (..., n) [rad or m], qd (..., dof) [rad/s or m/s], T_world_base (..., 4, 4), out (...). Returns (...) [J].
Raises InputError for a wrong shape or NaN and where no link has a mass.)doc";

const char potential_energy_doc[] =
    R"doc(potential_energy($self, q, *, gravity=(0, 0, -9.81), T_world_base=None, out=None, threads=None)
--

The energy −m g · c of the weight, zero with the centre of mass at the origin.

q (..., n) [rad or m], gravity (3,) [m/s²], T_world_base (..., 4, 4), out (...). Returns (...) [J]. Raises
InputError for a wrong shape or NaN and where no link has a mass.)doc";

const char inverse_derivatives_doc[] =
    R"doc(inverse_dynamics_derivatives($self, q, qd, qdd, *, gravity=(0, 0, -9.81), wrenches=None, expressed_in='base', friction=True, T_world_base=None, out=None, threads=None)
--

∂tau/∂q, ∂tau/∂q̇ and ∂tau/∂q̈ = M of inverse dynamics.

The position of a floating base is varied by a displacement [v; ω] in the axes of the world, its velocities and
accelerations in these axes kept. Dry friction counts as constant. Wrenches keep their numbers in the axes that
expressed_in names, and move with their frames.

q (..., n) [rad or m], qd, qdd (..., dof), gravity (3,), wrenches, expressed_in, friction, T_world_base (..., 4,
4), threads: as in inverse_dynamics. out (..., 3, dof, dof): float64 array to write into; the answers are parts
of it.

Returns dq, dqd and M, each (..., dof, dof): row i holds the derivatives of tau[i]. Raises InputError for a wrong
shape or NaN and where no link has a mass, UnknownNameError for an unknown frame.

Carpentier and Mansard 2018; Singh, Russell and Wensing 2022.)doc";

const char forward_derivatives_doc[] =
    R"doc(forward_dynamics_derivatives($self, q, qd, tau, *, gravity=(0, 0, -9.81), wrenches=None, expressed_in='base', friction=True, T_world_base=None, out=None, threads=None)
--

∂q̈/∂q, ∂q̈/∂q̇ and ∂q̈/∂tau = M⁻¹ of forward dynamics.

They are −M⁻¹ times those of inverse dynamics at the acceleration that tau causes.

q (..., n), qd, tau (..., dof), gravity, wrenches, expressed_in, friction, T_world_base, threads: as in
forward_dynamics. out (..., 3, dof, dof): as in inverse_dynamics_derivatives.

Returns dq, dqd and M⁻¹, each (..., dof, dof). Raises InputError for a wrong shape or NaN, and where a joint moves
no inertia, UnknownNameError for an unknown frame.)doc";

const char regressor_doc[] =
    R"doc(regressor($self, q, qd, qdd, *, gravity=(0, 0, -9.81), friction=True, T_world_base=None, out=None, threads=None)
--

The matrix Y with tau = Y(q, q̇, q̈) π; see cspace.dynamics.parameters for π.

The columns do not depend on the masses of the robot, which may have none.

q (..., n) [rad or m], qd, qdd (..., dof), gravity (3,) [m/s²]. friction: with columns for damping and dry
friction. T_world_base (..., 4, 4): where the base is. out (..., dof, p): float64 array to write into. threads:
as in fk.

Returns Y (..., dof, p). Raises InputError for a wrong shape or NaN.

Atkeson, An and Hollerbach 1986.)doc";

namespace {

constexpr Vec3d earth = {0.0, 0.0, -9.81};
constexpr const char* words = "cspace.dynamics";

// The largest number of joints for which a single call works on the stack.
constexpr int stack_links = 64, stack_dof = stack_links + 6;
struct alignas(64) Stack {
    double values[80 * stack_links + stack_dof * (5 * stack_dof + 18) + 16];
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
           dot(matrix_column(pose.R, 0), cross(matrix_column(pose.R, 1), matrix_column(pose.R, 2))) > 0.0;
}

// A call with as many configurations, velocities and forces as `count`, all of one row, and at most
// T_world_base besides: its arguments as rows.
struct Single {
    dynamics::Rows rows{};
    bool needs_mass = true;
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
        if (n > stack_links || robot->model->n_joints() > stack_links ||
            (needs_mass && robot->model->mass() == 0.0))
            return false;
        const double* given[3] = {};
        for (Py_ssize_t k = 0; k < count; ++k) {
            given[k] = read_in_place(args[k], 0, k == 0 ? n : dof, copies[k]);
            if (!given[k]) return false;
        }
        rows.bodies = links_of(*robot).view();
        rows.gravity = earth;
        rows.floating = robot->floating;
        rows.rubs = true;
        rows.q = given[0];
        rows.qd = given[1];
        rows.force = given[2];
        return true;
    }
};

enum class Shape { number, vector, six, square, six_rows };  // (), (dof,), (6,), (dof, dof), (6, dof)

PyObject* new_result(Shape shape, npy_intp dof) {
    switch (shape) {
        case Shape::number:
            return new_array({});
        case Shape::vector:
            return new_array({dof});
        case Shape::six:
            return new_array({6});
        case Shape::square:
            return new_array({dof, dof});
        default:
            return new_array({6, dof});
    }
}

// The answer of a single call, an array of that shape, or that of the free function of that name.
template <class Kernel>
PyObject* answer_call(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames,
                      Py_ssize_t count, Shape shape, Kernel kernel, const char* name,
                      dynamics::What what = {}) {
    Single call;
    if (call.read(self, args, nargs, kwnames, count)) {
        PyObject* result = new_result(shape, velocities_of(*kinematics_of(self)));
        if (!result) return nullptr;
        call.rows.result = data_of(result);
        call.rows.what = what;
        Stack stack;
        if (kernel(call.rows, 0, 1, &stack)) return result;
        Py_DECREF(result);
    }
    return call_python(words, name, name, self, args, nargs, kwnames);
}

// The matrices of an array (k, n, n), which they keep, as a tuple. Takes the reference to the array.
PyObject* split_matrices(PyObject* array) {
    auto* all = reinterpret_cast<PyArrayObject*>(array);
    const npy_intp count = PyArray_DIM(all, 0);
    PyObject* answer = PyTuple_New(count);
    for (npy_intp k = 0; answer && k < count; ++k) {
        PyObject* matrix =
            PyArray_New(&PyArray_Type, 2, PyArray_DIMS(all) + 1, NPY_DOUBLE, nullptr,
                        PyArray_BYTES(all) + k * PyArray_STRIDE(all, 0), 0, NPY_ARRAY_CARRAY, nullptr);
        if (matrix) {
            PyTuple_SET_ITEM(answer, k, matrix);
            Py_INCREF(array);
            if (PyArray_SetBaseObject(reinterpret_cast<PyArrayObject*>(matrix), array) == 0) continue;
        }
        Py_CLEAR(answer);
    }
    Py_DECREF(array);
    return answer;
}

// The three derivatives of inverse or of forward dynamics, of a single call or of the free function.
PyObject* answer_derivatives(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames,
                             bool forward) {
    Single call;
    if (call.read(self, args, nargs, kwnames, 3)) {
        const npy_intp n = velocities_of(*kinematics_of(self));
        PyObject* result = new_array({3, n, n});
        if (!result) return nullptr;
        dynamics::Rows& rows = call.rows;
        double qdd[stack_dof];
        Stack stack;
        bool done = true;
        if (forward) {
            rows.result = qdd;
            done = kernels::forward_rows(rows, 0, 1, &stack);
            rows.force = qdd;
        }
        rows.result = data_of(result);
        rows.what = forward ? dynamics::What::responses : dynamics::What::derivatives;
        if (done && kernels::spatial_rows(rows, 0, 1, &stack)) return split_matrices(result);
        Py_DECREF(result);
    }
    const char* name = forward ? "forward_dynamics_derivatives" : "inverse_dynamics_derivatives";
    return call_python(words, name, name, self, args, nargs, kwnames);
}

// The bodies with parameters: of a floating robot its base before those of the joints.
dynamics::RegressorRows regressor_of(const KinematicsObject& robot, const dynamics::Links& links,
                                     const dynamics::Rows& rows) {
    const int n = rows.bodies.n_links;
    return {rows, links.body_frames().data() + (robot.floating ? 0 : 1),
            dynamics::body_parameters * (n + robot.floating) + (rows.rubs ? 3 : 1) * n};
}

}  // namespace

PyObject* compute_inverse_dynamics(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                   PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 3, Shape::vector, kernels::inverse_rows,
                       "inverse_dynamics");
}
PyObject* compute_forward_dynamics(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                   PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 3, Shape::vector, kernels::forward_rows,
                       "forward_dynamics");
}
PyObject* compute_mass_matrix(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 1, Shape::square, kernels::mass_rows, "mass_matrix");
}
PyObject* compute_gravity_torques(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                  PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 1, Shape::vector, kernels::inverse_rows,
                       "gravity_torques");
}

PyObject* compute_coriolis_matrix(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                  PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 2, Shape::square, kernels::spatial_rows, "coriolis_matrix",
                       dynamics::What::coriolis);
}
PyObject* compute_centroidal_momentum(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                      PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 2, Shape::six, kernels::spatial_rows,
                       "centroidal_momentum", dynamics::What::momentum);
}
PyObject* compute_momentum_matrix(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                  PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 1, Shape::six_rows, kernels::spatial_rows,
                       "centroidal_momentum_matrix", dynamics::What::momentum_matrix);
}
PyObject* compute_kinetic_energy(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 2, Shape::number, kernels::spatial_rows, "kinetic_energy",
                       dynamics::What::kinetic);
}
PyObject* compute_potential_energy(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                   PyObject* kwnames) {
    return answer_call(self, args, nargs, kwnames, 1, Shape::number, kernels::spatial_rows,
                       "potential_energy", dynamics::What::potential);
}
PyObject* compute_inverse_derivatives(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                      PyObject* kwnames) {
    return answer_derivatives(self, args, nargs, kwnames, false);
}
PyObject* compute_forward_derivatives(PyObject* self, PyObject* const* args, Py_ssize_t nargs,
                                      PyObject* kwnames) {
    return answer_derivatives(self, args, nargs, kwnames, true);
}
PyObject* compute_regressor(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames) {
    Single call;
    call.needs_mass = false;
    if (call.read(self, args, nargs, kwnames, 3)) {
        KinematicsObject& robot = *kinematics_of(self);
        dynamics::RegressorRows task = regressor_of(robot, links_of(robot), call.rows);
        PyObject* result = new_array({velocities_of(robot), task.columns});
        if (!result) return nullptr;
        task.rows.result = data_of(result);
        Stack stack;
        if (kernels::regressor_rows(task, 0, 1, &stack)) return result;
        Py_DECREF(result);
    }
    return call_python(words, "regressor", "regressor", self, args, nargs, kwnames);
}

namespace {

// Wrenches from a list of (number of the frame, whether in its axes, array (rows or 1, 6)).
template <class S>
struct Pushes {
    std::vector<dynamics::BasicPush<S>> list;
    std::vector<std::vector<int>> paths;

    Pushes(const model::Tree& tree, const dynamics::Links& links, const nb::list& given, npy_intp count) {
        for (const nb::handle item : given) {
            const auto one = nb::cast<nb::tuple>(item);
            const int number = nb::cast<int>(one[0]);
            if (number < 0 || number >= tree.n_frames) throw nb::value_error("unknown frame number");
            const model::Frame& frame = tree.frames[number];
            const Posed place = links.place(frame);
            const auto values = nb::cast<Plain<const S>>(one[2]);
            if (values.size != 6 && values.size != 6 * count)
                throw nb::value_error("a wrench has the wrong size");
            paths.push_back(links.path_to(frame.joint));
            list.push_back({paths.back().data(),
                            int(paths.back().size()),
                            nb::cast<bool>(one[1]),
                            {S(place.t.x), S(place.t.y), S(place.t.z)},
                            {},
                            values.data,
                            values.size == 6 ? 0u : 6u});
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) list.back().axes.m[i][j] = S(place.R.m[i][j]);
        }
    }
};

template <class S>
const dynamics::BasicMultibody<S>& bodies_of(const dynamics::Links& links) {
    if constexpr (std::is_same_v<S, float>)
        return links.float_view();
    else
        return links.view();
}

template <class S>
using Given = std::optional<Plain<const S>>;

// Reads the rows of a call and passes them to run(rows, count); the result is size_of(count) numbers.
template <class S, class Run>
bool with_rows(nb::handle robot, const Plain<const S>& q, const Given<S>& qd, const Given<S>& force,
               const Given<S>& T_world_base, const ConstDoubles& gravity, bool rubs, const Plain<S>& result,
               const nb::list& wrenches, const Run& run) {
    KinematicsObject& object = robot_from(robot);
    dynamics::BasicRows<S> rows{};
    const dynamics::Links& links = links_of(object);
    rows.bodies = bodies_of<S>(links);
    if (gravity.size != 3) throw nb::value_error("gravity has three numbers");
    rows.gravity = {gravity.data[0], gravity.data[1], gravity.data[2]};
    rows.floating = object.floating;
    rows.rubs = rubs;
    const int dof = velocities_of(object), n = rows.bodies.n_coordinates;
    if (q.ndim() != 2 || q.shape(1) != n) throw nb::value_error("q must have two axes, (rows, coordinates)");
    const npy_intp count = q.shape(0);
    rows.q = q.data;
    rows.qd = values_of(qd, count, dof);
    rows.force = values_of(force, count, dof);
    rows.base_stride = !T_world_base || T_world_base->size == 16 ? 0 : 16;
    rows.T_world_base = values_of(T_world_base, rows.base_stride ? count : 1, 16);
    rows.result = result.data;
    const Pushes<S> pushes(object.model->tree(), links, wrenches, count);
    rows.wrenches = pushes.list.data();
    rows.n_wrenches = int(pushes.list.size());
    return run(object, rows, count, dof);
}
void require_size(npy_intp size, npy_intp wanted) {
    if (size != wanted) throw nb::value_error("the result has the wrong size");
}

bool dynamics_rows(nb::handle robot, const std::string& what, const ConstDoubles& q, const In& qd,
                   const In& force, const In& T_world_base, const ConstDoubles& gravity, bool rubs,
                   const Doubles& result, int threads, const nb::list& wrenches) {
    const auto choose = [&](const KinematicsObject& object, dynamics::Rows& rows, npy_intp count, int dof) {
        const auto run = [&](npy_intp size, auto kernel) {
            require_size(result.size, count * size);
            return run_kernel(rows, count, threads, kernel);
        };
        if (what == "inverse_dynamics") return run(dof, kernels::inverse_rows);
        if (what == "mass_matrix") return run(dof * dof, kernels::mass_rows);
        if (what == "forward_dynamics" && rows.force) return run(dof, kernels::forward_rows);
        if (what == "regressor" && rows.qd && rows.force) {
            const auto task = regressor_of(object, *object.links, rows);
            require_size(result.size, count * dof * task.columns);
            return run_kernel(task, count, threads, kernels::regressor_rows);
        }
        const auto run_spatial = [&](dynamics::What which, npy_intp size) {
            rows.what = which;
            return run(size, kernels::spatial_rows);
        };
        if (what == "coriolis_matrix") return run_spatial(dynamics::What::coriolis, dof * dof);
        if (what == "derivatives") return run_spatial(dynamics::What::derivatives, 3 * dof * dof);
        if (what == "responses") return run_spatial(dynamics::What::responses, 3 * dof * dof);
        if (what == "momentum") return run_spatial(dynamics::What::momentum, 6);
        if (what == "momentum_matrix") return run_spatial(dynamics::What::momentum_matrix, 6 * dof);
        if (what == "kinetic_energy" && rows.qd) return run_spatial(dynamics::What::kinetic, 1);
        if (what == "potential_energy") return run_spatial(dynamics::What::potential, 1);
        throw nb::value_error(("unknown or incomplete: " + what).c_str());
    };
    return with_rows<double>(robot, q, qd, force, T_world_base, gravity, rubs, result, wrenches, choose);
}

bool float_dynamics_rows(nb::handle robot, const std::string& what, const Plain<const float>& q,
                         const Given<float>& qd, const Given<float>& force, const Given<float>& T_world_base,
                         const ConstDoubles& gravity, bool rubs, const Plain<float>& result, int threads,
                         const nb::list& wrenches) {
    const auto choose = [&](const KinematicsObject&, dynamics::FloatRows& rows, npy_intp count, int dof) {
        const auto run = [&](npy_intp size, auto kernel) {
            require_size(result.size, count * size);
            return run_kernel(rows, count, threads, kernel);
        };
        if (what == "inverse_dynamics") return run(dof, kernels::inverse_float_rows);
        if (what == "mass_matrix") return run(dof * dof, kernels::mass_float_rows);
        if (what == "forward_dynamics" && rows.force) return run(dof, kernels::forward_float_rows);
        throw nb::value_error(("unknown or incomplete: " + what).c_str());
    };
    return with_rows<float>(robot, q, qd, force, T_world_base, gravity, rubs, result, wrenches, choose);
}

}  // namespace

void bind_dynamics(nb::module_& m) {
    m.def("_dynamics_rows", dynamics_rows, "robot"_a, "what"_a, "q"_a, "qd"_a.none(), "force"_a.none(),
          "T_world_base"_a.none(), "gravity"_a, "rubs"_a, "result"_a, "threads"_a, "wrenches"_a,
          "Fills in the result; False if an argument is not finite, or M singular in forward dynamics.");
    m.def("_float_dynamics_rows", float_dynamics_rows, "robot"_a, "what"_a, "q"_a, "qd"_a.none(),
          "force"_a.none(), "T_world_base"_a.none(), "gravity"_a, "rubs"_a, "result"_a, "threads"_a,
          "wrenches"_a, "The same in floats; also False for values of joints that are too large.");
}
