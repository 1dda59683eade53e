// Batches of configurations: plain checked arrays in, filled arrays out, the interpreter free meanwhile.
#pragma once

#include "numpy_api.hpp"

PyObject* robot_chain_rows(PyObject* self, PyObject* const* args, Py_ssize_t nargs);
PyObject* robot_tree_rows(PyObject* self, PyObject* const* args, Py_ssize_t nargs);

extern const char robot_chain_rows_doc[];
extern const char robot_tree_rows_doc[];
