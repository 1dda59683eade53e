// Where the compiled robot takes its numbers from, and the words of its methods.
#pragma once

#include "numpy_api.hpp"

// KinematicsBase.__init__(assembly): reads the arrays of a cspace.kinematics.assembly.Assembly.
int kinematics_load(PyObject* self, PyObject* args, PyObject* kwargs);

extern const char kinematics_fk_doc[];
extern const char kinematics_jacobian_doc[];
extern const char kinematics_fk_jacobian_doc[];
