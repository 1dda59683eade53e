// The compiled kinematics of a robot or a chain: a raw Python type, because a single call of it is worth less
// than a microsecond.
//
// `fk`, `jacobian` and `fk_jacobian` answer one float64 configuration here and now; whatever else they are
// asked goes to the free functions of cspace.kinematics, which check it, find the words for what is wrong,
// and come back through `_chain_rows` and `_tree_rows` with plain arrays.
#pragma once

#include <memory>

#include "cspace/model/robot_model.hpp"
#include "numpy_api.hpp"

struct KinematicsObject {
    PyObject_HEAD std::unique_ptr<const cspace::model::RobotModel>
        model;              // null until __init__; never replaced
    PyObject* frame_index;  // dict: name of a frame → its number
    int tip;                // the frame meant where none is named, or -1
    bool floating;
};

extern PyTypeObject* kinematics_type;  // KinematicsBase; null until the module is filled

// For the types built on this one: an object whose kinematics are still to be read, and the end of them.
PyObject* create_kinematics(PyTypeObject* type, PyObject*, PyObject*);
void free_kinematics(PyObject* self);
template <class F>
PyCFunction as_method(F* f) {
    return reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(f));
}

// The largest number of coordinates and of joints on a path for which a single call works on the stack.
inline constexpr int stack_joints = 32;

// A configuration that can be read in place: one float64 row of the robot's size. q points to its values, in
// `copy` if they were not contiguous. False for everything else, and no error is set.
bool read_configuration(const KinematicsObject* robot, PyObject* value, double* copy, const double*& q);
// Calls the free function of that name in a Python module, with the robot before the arguments. Complaints
// about the arguments name the method that was called.
PyObject* call_python(const char* module, const char* function, const char* method, PyObject* self,
                      PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames);
