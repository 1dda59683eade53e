// The compiled kinematics of a robot or a chain: a raw Python type, because a single call of it is worth less
// than a microsecond.
//
// `fk`, `jacobian` and `fk_jacobian` answer one float64 configuration here and now; whatever else they are
// asked goes to the free functions of cspace.kinematics, which check it, find the words for what is wrong,
// and come back through `_chain_rows` and `_tree_rows` with plain arrays.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>

#include "bindings.hpp"
#include "cspace/model/robot_model.hpp"
#include "numpy_api.hpp"

namespace cspace::dynamics {
class Links;
}  // namespace cspace::dynamics

struct KinematicsObject {
    PyObject_HEAD std::unique_ptr<const cspace::model::RobotModel>
        model;                                             // null until __init__; never replaced
    std::unique_ptr<const cspace::dynamics::Links> links;  // the same for dynamics, made when first asked for
    PyObject* frame_index;                                 // dict: name of a frame → its number
    int tip;                                               // the frame meant where none is named, or -1
    bool floating;
};
inline KinematicsObject* kinematics_of(PyObject* self) { return reinterpret_cast<KinematicsObject*>(self); }

extern PyTypeObject* kinematics_type;  // KinematicsBase; null until the module is filled

// KinematicsBase.__init__(assembly): reads the arrays of a cspace.kinematics.assembly.Assembly.
int kinematics_load(PyObject* self, PyObject* args, PyObject* kwargs);

// For the types built on this one: an object whose kinematics are still to be read, and the end of them.
PyObject* create_kinematics(PyTypeObject* type, PyObject*, PyObject*);
void free_kinematics(PyObject* self);

// Calls the free function of that name in a Python module, with the robot before the arguments. Complaints
// about the arguments name the method that was called.
PyObject* call_python(const char* module, const char* function, const char* method, PyObject* self,
                      PyObject* const* args, Py_ssize_t nargs, PyObject* kwnames);

// The links of a robot, for dynamics. Call it with the interpreter lock.
const cspace::dynamics::Links& links_of(KinematicsObject& robot);

// A robot as an argument, and the chain to one of its frames. Throws for an object that is not a robot, and
// for a frame that it does not have.
inline KinematicsObject& robot_from(nanobind::handle robot) {
    if (!PyObject_TypeCheck(robot.ptr(), kinematics_type) || !kinematics_of(robot.ptr())->model)
        throw nanobind::type_error("the first argument must be a robot");
    return *kinematics_of(robot.ptr());
}
inline const cspace::model::Chain& chain_on(nanobind::handle robot, int frame) {
    const auto& model = robot_from(robot).model;
    if (frame < 0 || frame >= model->n_frames()) throw nanobind::value_error("unknown frame number");
    return model->chain(frame);
}
