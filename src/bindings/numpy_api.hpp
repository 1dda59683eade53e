// The C API of NumPy, one table for all files of the extension; kinematics.cpp fills it.
#pragma once

#define PY_SSIZE_T_CLEAN
#include <Python.h>

#define PY_ARRAY_UNIQUE_SYMBOL cspace_numpy_api
#if !defined(CSPACE_FILLS_NUMPY_API)
#define NO_IMPORT_ARRAY
#endif
#include <numpy/arrayobject.h>

#include <algorithm>

// The numbers of an array that has this type.
template <class T = double>
T* data_of(PyObject* array) {
    return static_cast<T*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array)));
}

// The numbers of a list or tuple of `count` floats and integers, in `copy`; null for everything else.
inline const double* read_sequence(PyObject* value, npy_intp count, double* copy) {
    if (!PyList_CheckExact(value) && !PyTuple_CheckExact(value)) return nullptr;
    if (PySequence_Fast_GET_SIZE(value) != count) return nullptr;
    PyObject** const items = PySequence_Fast_ITEMS(value);
    for (npy_intp j = 0; j < count; ++j) {
        if (!PyFloat_Check(items[j]) && !PyLong_CheckExact(items[j])) return nullptr;
        copy[j] = PyFloat_AsDouble(items[j]);
        if (copy[j] == -1 && PyErr_Occurred()) {  // an integer beyond all doubles
            PyErr_Clear();
            return nullptr;
        }
    }
    return copy;
}

// The numbers of a float64 array (rows, columns), or of an array, list or tuple (columns,) if rows is 0: in
// `copy` if they are not contiguous. Null for everything else, and no error is set.
inline const double* read_in_place(PyObject* value, npy_intp rows, npy_intp columns, double* copy) {
    if (!PyArray_CheckExact(value)) return rows ? nullptr : read_sequence(value, columns, copy);
    auto* array = reinterpret_cast<PyArrayObject*>(value);
    const int last = rows ? 1 : 0;
    if (PyArray_TYPE(array) != NPY_DOUBLE || PyArray_NDIM(array) != last + 1 ||
        PyArray_DIM(array, last) != columns || (rows && PyArray_DIM(array, 0) != rows) ||
        !PyArray_ISBEHAVED_RO(array))
        return nullptr;
    if (PyArray_IS_C_CONTIGUOUS(array)) return data_of(value);
    for (npy_intp i = 0; i < std::max<npy_intp>(rows, 1); ++i)
        for (npy_intp j = 0; j < columns; ++j)
            copy[columns * i + j] = *reinterpret_cast<const double*>(
                PyArray_BYTES(array) + (rows ? i * PyArray_STRIDE(array, 0) : 0) +
                j * PyArray_STRIDE(array, last));
    return copy;
}
