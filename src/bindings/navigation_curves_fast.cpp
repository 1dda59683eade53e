// One Dubins or Reeds–Shepp curve as a C-level entry, as it takes less than a microsecond. What is no plain
// pose or radius is answered by None, and Python's checks say why.
#include <cmath>

#include "bindings.hpp"
#include "library/navigation_curves.hpp"
#include "navigation_route.hpp"

namespace nb = nanobind;
using namespace cspace::navigation;

namespace {

constexpr double largest = 1e12;  // LARGEST_NUMBER of the package

bool read_number(PyObject* item, double& number) {
    if (PyFloat_Check(item))
        number = PyFloat_AS_DOUBLE(item);
    else if (PyLong_CheckExact(item))
        number = PyLong_AsDouble(item);
    else
        return false;
    if (number == -1 && PyErr_Occurred()) return PyErr_Clear(), false;
    return std::fabs(number) <= largest;
}

bool read_pose(PyObject* value, double radius, CarPose& pose) {
    double row[3];
    if (PyArray_Check(value)) {
        auto* array = reinterpret_cast<PyArrayObject*>(value);
        if (PyArray_TYPE(array) != NPY_DOUBLE || PyArray_NDIM(array) != 1 || PyArray_DIM(array, 0) != 3 ||
            !PyArray_ISCARRAY_RO(array))
            return false;
        std::copy_n(static_cast<const double*>(PyArray_DATA(array)), 3, row);
    } else if (PyTuple_CheckExact(value) && PyTuple_GET_SIZE(value) == 3) {
        for (int k = 0; k < 3; ++k)
            if (!read_number(PyTuple_GET_ITEM(value, k), row[k])) return false;
    } else {
        return false;
    }
    pose = {row[0], row[1], row[2]};
    const double most = largest * std::min(radius, 1.0);
    return std::fabs(row[0]) <= most && std::fabs(row[1]) <= most && std::fabs(row[2]) <= largest;
}

struct Question {
    bool reverses;
    CarPose start, goal;
    double radius;

    bool read(PyObject* const* args, Py_ssize_t count) {
        if (count != 4 || !read_number(args[3], radius) || !(radius > 0)) return false;
        reverses = args[0] == Py_True;
        return read_pose(args[1], radius, start) && read_pose(args[2], radius, goal);
    }
};

// _car_distance(reverses, start, goal, radius) → length [m], or None.
PyObject* distance(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Question q;
    if (!q.read(args, count)) Py_RETURN_NONE;
    return PyFloat_FromDouble(curve_length(q.reverses, q.start, q.goal, q.radius));
}

PyObject* pose_array(const CarPose& pose) {
    const npy_intp three = 3;
    PyObject* made = PyArray_SimpleNew(1, &three, NPY_DOUBLE);
    if (!made) return nullptr;
    auto* row = static_cast<double*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(made)));
    row[0] = pose.x, row[1] = pose.y, row[2] = pose.theta;
    return made;
}

// _car_shortest(reverses, start, goal, radius) → (start, goal, radius, pieces), or None.
PyObject* shortest(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Question q;
    if (!q.read(args, count)) Py_RETURN_NONE;
    const Curve curve = find_shortest_curve(q.reverses, q.start, q.goal, q.radius);
    PyObject* pieces = PyTuple_New(curve.count);
    if (!pieces) return nullptr;
    for (int k = 0; k < curve.count; ++k) {
        PyObject* piece = Py_BuildValue("(id)", curve.piece[k].turn, q.radius * curve.piece[k].length);
        if (!piece) return Py_DECREF(pieces), nullptr;
        PyTuple_SET_ITEM(pieces, k, piece);
    }
    return Py_BuildValue("(NNdN)", pose_array(q.start), pose_array(q.goal), q.radius, pieces);
}

PyMethodDef methods[] = {{"_car_distance", fast(distance), METH_FASTCALL, nullptr},
                         {"_car_shortest", fast(shortest), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_curves_fast(nb::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
}
