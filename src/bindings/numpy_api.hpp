// The C API of NumPy, one table for all files of the extension; robot.cpp fills it.
#pragma once

#define PY_SSIZE_T_CLEAN
#include <Python.h>

#define PY_ARRAY_UNIQUE_SYMBOL cspace_numpy_api
#if !defined(CSPACE_FILLS_NUMPY_API)
#define NO_IMPORT_ARRAY
#endif
#include <numpy/arrayobject.h>
