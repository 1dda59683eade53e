#include <climits>
#include <string>
#include <vector>

#include "arrays_in_place.hpp"
#include "bindings.hpp"
#include "cspace/kinematics/pose_matrix.hpp"
#include "kinematics.hpp"

namespace nb = nanobind;
using namespace cspace;

namespace {

// An attribute of an assembly as doubles.
ConstDoubles numbers_of(nb::handle assembly, const char* name, npy_intp size) {
    const nb::object given = assembly.attr(name);
    const nb::object doubles = nb::steal(PyArray_FROM_OTF(given.ptr(), NPY_DOUBLE, NPY_ARRAY_IN_ARRAY));
    if (!doubles) throw nb::python_error();
    ConstDoubles numbers;
    if (!numbers.read(doubles.ptr()) || numbers.size != size)
        throw nb::value_error((std::string(name) + " has the wrong number of values").c_str());
    return numbers;
}
long integer_of(nb::handle assembly, const char* name) { return nb::cast<long>(assembly.attr(name)); }

// The indices that the compiled loops follow blindly must be right.
bool indices_fit(const std::vector<model::Joint>& joints, const std::vector<model::Frame>& frames, long n,
                 long tip) {
    for (int k = 0; k < int(joints.size()); ++k) {
        if (joints[k].parent < -1 || joints[k].parent >= k) return false;
        if (joints[k].coordinate < 0 || joints[k].coordinate >= n) return false;
    }
    for (const model::Frame& frame : frames) {
        if (frame.joint < -1 || frame.joint >= int(joints.size())) return false;
    }
    return tip >= -1 && tip < int(frames.size());
}

// A copy of the dict of names, whose every value must be the number of a frame.
nb::dict read_names(nb::handle assembly, long n_frames) {
    nb::dict names;
    for (auto [name, number] : nb::cast<nb::dict>(assembly.attr("frame_index"))) {
        const long frame = nb::isinstance<nb::int_>(number) ? PyLong_AsLong(number.ptr()) : -1;
        if (PyErr_Occurred()) throw nb::python_error();
        if (frame < 0 || frame >= n_frames)
            throw nb::type_error("frame_index must be a dict of names to numbers of frames");
        names[name] = number;
    }
    return names;
}

std::unique_ptr<const model::RobotModel> read_model(nb::handle assembly, long n_joints, long n_frames, long n,
                                                    long tip) {
    const auto T_joint = numbers_of(assembly, "T_parent_joint", 16 * n_joints),
               parent = numbers_of(assembly, "parent", n_joints),
               coordinate = numbers_of(assembly, "coordinate", n_joints),
               ratio = numbers_of(assembly, "ratio", n_joints),
               offset = numbers_of(assembly, "offset", n_joints),
               prismatic = numbers_of(assembly, "prismatic", n_joints),
               T_frame = numbers_of(assembly, "T_joint_frame", 16 * n_frames),
               carrier = numbers_of(assembly, "frame_joint", n_frames),
               mass = numbers_of(assembly, "mass", n_joints + 1),
               center = numbers_of(assembly, "center", 3 * (n_joints + 1)),
               inertia = numbers_of(assembly, "inertia", 9 * (n_joints + 1)),
               armature = numbers_of(assembly, "armature", n_joints),
               damping = numbers_of(assembly, "damping", n_joints),
               friction = numbers_of(assembly, "friction", n_joints);
    std::vector<model::Joint> joints(n_joints);
    for (long k = 0; k < n_joints; ++k) {
        joints[k] = {kinematics::read_matrix(T_joint.data + 16 * k),
                     int(parent.data[k]),
                     int(coordinate.data[k]),
                     ratio.data[k],
                     offset.data[k],
                     prismatic.data[k] != 0.0,
                     0.0,
                     armature.data[k],
                     damping.data[k],
                     friction.data[k]};
    }
    std::vector<model::Frame> frames(n_frames);
    for (long k = 0; k < n_frames; ++k)
        frames[k] = {kinematics::read_matrix(T_frame.data + 16 * k), int(carrier.data[k])};
    std::vector<model::Body> bodies(n_joints + 1);
    for (long k = 0; k <= n_joints; ++k) {
        const double *at = center.data + 3 * k, *I = inertia.data + 9 * k;
        bodies[k] = {{at[0], at[1], at[2]}, mass.data[k], {I[0], I[1], I[2], I[4], I[5], I[8]}};
    }
    if (n < 0 || n > INT_MAX || !indices_fit(joints, frames, n, tip))
        throw nb::value_error("the joints, coordinates and frames of the assembly do not fit together");
    return std::make_unique<const model::RobotModel>(std::move(joints), std::move(frames), std::move(bodies),
                                                     int(n));
}

}  // namespace

int kinematics_load(PyObject* self, PyObject* args, PyObject* kwargs) {
    PyObject* given;
    if (!PyArg_ParseTuple(args, "O:KinematicsBase", &given)) return -1;
    const auto load = [&] {
        KinematicsObject* robot = kinematics_of(self);
        if (kwargs && PyDict_GET_SIZE(kwargs) > 0)
            throw nb::type_error("KinematicsBase takes an assembly and no keywords");
        if (robot->model) throw nb::type_error("a robot is immutable; make another one");
        const nb::handle assembly = given;
        const long n_frames = integer_of(assembly, "n_frames"), tip = integer_of(assembly, "tip_index");
        nb::dict names = read_names(assembly, n_frames);
        robot->model = read_model(assembly, integer_of(assembly, "n_joints"), n_frames,
                                  integer_of(assembly, "n_coordinates"), tip);
        robot->floating = integer_of(assembly, "floating") != 0;
        robot->tip = int(tip);
        Py_XSETREF(robot->frame_index, names.release().ptr());
        return self;
    };
    return or_error(load) ? 0 : -1;
}
