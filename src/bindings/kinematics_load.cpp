#include "kinematics_load.hpp"

#include <climits>
#include <vector>

#include "cspace/kinematics/forward.hpp"
#include "kinematics.hpp"

using namespace cspace;

namespace {

// An attribute of a Python object as a contiguous array of doubles of a known size; empty, with an error,
// if not.
struct Column {
    PyObject* array = nullptr;
    const double* data = nullptr;

    Column(PyObject* owner, const char* name, npy_intp size) {
        PyObject* value = PyObject_GetAttrString(owner, name);
        if (!value) return;
        array = PyArray_FROM_OTF(value, NPY_DOUBLE, NPY_ARRAY_IN_ARRAY);
        Py_DECREF(value);
        if (!array) return;
        auto* a = reinterpret_cast<PyArrayObject*>(array);
        if (PyArray_SIZE(a) != size) {
            PyErr_Format(PyExc_ValueError, "%s has %zd numbers, expected %zd", name, PyArray_SIZE(a), size);
            return;
        }
        data = static_cast<const double*>(PyArray_DATA(a));
    }
    Column(const Column&) = delete;
    Column& operator=(const Column&) = delete;
    ~Column() { Py_XDECREF(array); }
};

long integer(PyObject* owner, const char* name) {
    PyObject* value = PyObject_GetAttrString(owner, name);
    if (!value) return -1;
    const long number = PyLong_AsLong(value);
    Py_DECREF(value);
    return number;
}

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

// Every value of the dict is the number of a frame.
bool names_fit(PyObject* names, long n_frames) {
    PyObject *name, *number;
    for (Py_ssize_t at = 0; PyDict_Next(names, &at, &name, &number);) {
        const long frame = PyLong_Check(number) ? PyLong_AsLong(number) : -1;
        if (frame < 0 || frame >= n_frames) return false;
    }
    return !PyErr_Occurred();
}

std::unique_ptr<const model::RobotModel> read_model(PyObject* assembly, long n_joints, long n_frames, long n,
                                                    long tip) {
    const Column T_joint(assembly, "T_parent_joint", 16 * n_joints), parent(assembly, "parent", n_joints),
        coordinate(assembly, "coordinate", n_joints), ratio(assembly, "ratio", n_joints),
        offset(assembly, "offset", n_joints), prismatic(assembly, "prismatic", n_joints),
        T_frame(assembly, "T_joint_frame", 16 * n_frames), carrier(assembly, "frame_joint", n_frames),
        mass(assembly, "mass", n_joints + 1), center(assembly, "center", 3 * (n_joints + 1));
    if (PyErr_Occurred()) return nullptr;

    std::vector<model::Joint> joints(n_joints);
    for (long k = 0; k < n_joints; ++k) {
        joints[k] = {kinematics::read_matrix(T_joint.data + 16 * k),
                     int(parent.data[k]),
                     int(coordinate.data[k]),
                     ratio.data[k],
                     offset.data[k],
                     prismatic.data[k] != 0.0,
                     0.0};
    }
    std::vector<model::Frame> frames(n_frames);
    for (long k = 0; k < n_frames; ++k)
        frames[k] = {kinematics::read_matrix(T_frame.data + 16 * k), int(carrier.data[k])};
    std::vector<model::Body> bodies(n_joints + 1);
    for (long k = 0; k <= n_joints; ++k) {
        bodies[k] = {{center.data[3 * k], center.data[3 * k + 1], center.data[3 * k + 2]}, mass.data[k]};
    }
    if (!indices_fit(joints, frames, n, tip)) {
        PyErr_SetString(PyExc_ValueError,
                        "the joints, coordinates and frames of the assembly do not fit together");
        return nullptr;
    }
    return std::make_unique<const model::RobotModel>(std::move(joints), std::move(frames), std::move(bodies),
                                                     int(n));
}

}  // namespace

int kinematics_load(PyObject* self, PyObject* args, PyObject* kwargs) {
    auto* robot = reinterpret_cast<KinematicsObject*>(self);
    PyObject* assembly;
    if (!PyArg_ParseTuple(args, "O:KinematicsBase", &assembly)) return -1;
    if (kwargs && PyDict_GET_SIZE(kwargs) > 0) {
        PyErr_SetString(PyExc_TypeError, "KinematicsBase takes an assembly and no keywords");
        return -1;
    }
    if (robot->model) {
        PyErr_SetString(PyExc_TypeError, "a robot is immutable; make another one");
        return -1;
    }
    const long n_joints = integer(assembly, "n_joints"), n_frames = integer(assembly, "n_frames"),
               n = integer(assembly, "n_coordinates"), tip = integer(assembly, "tip_index"),
               floating = integer(assembly, "floating");
    if (PyErr_Occurred()) return -1;
    PyObject* names = PyObject_GetAttrString(assembly, "frame_index");
    if (!names) return -1;
    Py_XSETREF(robot->frame_index, PyDict_Check(names) ? PyDict_Copy(names) : nullptr);
    Py_DECREF(names);
    if (!robot->frame_index || n < 0 || n > INT_MAX || !names_fit(robot->frame_index, n_frames)) {
        if (!PyErr_Occurred())
            PyErr_SetString(PyExc_TypeError, "frame_index must be a dict of names to numbers of frames");
        return -1;
    }
    try {
        robot->model = read_model(assembly, n_joints, n_frames, n, tip);
    } catch (const std::bad_alloc&) {
        PyErr_NoMemory();
    }
    if (!robot->model) return -1;
    robot->tip = int(tip);
    robot->floating = floating != 0;
    return 0;
}
