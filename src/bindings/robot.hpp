// The compiled half of a robot: a raw Python type, because a single call of it is worth less than a
// microsecond.
//
// `fk`, `jacobian` and `fk_jacobian` answer one float64 configuration here and now; whatever else they are
// asked goes to the free functions of cspace.kinematics, which check it, find the words for what is wrong,
// and come back through `_chain_rows` and `_tree_rows` with plain arrays.
#pragma once

#include <memory>

#include "cspace/model/robot_model.hpp"
#include "numpy_api.hpp"

struct RobotObject {
    PyObject_HEAD std::unique_ptr<const cspace::model::RobotModel>
        model;              // null until __init__; never replaced
    PyObject* frame_index;  // dict: name of a frame → its number
    int tip;                // the frame meant where none is named, or -1
    bool floating;
    std::shared_ptr<void>
        ik;  // the solver, built by the first call of ik; never replaced: threads may be in it
    std::shared_ptr<void> near;  // what near= needs (ik_near.cpp); likewise
    std::shared_ptr<void>
        locked;  // the plans of joints held by locked= (ik_locked_joints.cpp); grows under the GIL
};

extern PyTypeObject* robot_type;  // RobotBase; null until the module is filled

// robot.ik, in ik.cpp.
PyObject* robot_ik(PyObject* self, PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames);
extern const char robot_ik_doc[];

// The largest number of coordinates and of joints on a path for which a single call works on the stack.
inline constexpr int robot_stack_joints = 32;

// A configuration that can be read in place: one float64 row of the robot's size. q points to its values, in
// `copy` if they were not contiguous. False for everything else, and no error is set.
bool robot_read_configuration(const RobotObject* robot, PyObject* value, double* copy, const double*& q);
// Calls the free function of that name in a Python module, with the robot before the arguments. Complaints
// about the arguments name the method that was called.
PyObject* robot_call_python(const char* module, const char* function, const char* method, PyObject* self,
                            PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames);
