// Where the compiled robot takes its numbers from, and the words of its methods.
#pragma once

#include "numpy_api.hpp"

// RobotBase.__init__(assembly): reads the arrays of a cspace.kinematics.assembly.Assembly.
int robot_load(PyObject* self, PyObject* args, PyObject* kwargs);

extern const char robot_fk_doc[];
extern const char robot_jacobian_doc[];
extern const char robot_fk_jacobian_doc[];
