// Batches of configurations: plain checked arrays in, filled arrays out, the interpreter free meanwhile.
#pragma once

#include "numpy_api.hpp"

PyObject* kinematics_chain_rows(PyObject* self, PyObject* const* args, Py_ssize_t nargs);
PyObject* kinematics_tree_rows(PyObject* self, PyObject* const* args, Py_ssize_t nargs);

extern const char kinematics_chain_rows_doc[];
extern const char kinematics_tree_rows_doc[];
