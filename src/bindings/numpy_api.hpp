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
#include <cmath>
#include <cstdint>
#include <initializer_list>

// The numbers of an array that has this type.
template <class T = double>
T* data_of(PyObject* array) {
    return static_cast<T*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array)));
}

template <class T>
inline constexpr int numpy_type = NPY_DOUBLE;
template <>
inline constexpr int numpy_type<float> = NPY_FLOAT;
template <>
inline constexpr int numpy_type<std::int64_t> = NPY_INT64;
template <>
inline constexpr int numpy_type<std::int32_t> = NPY_INT32;
template <>
inline constexpr int numpy_type<std::uint32_t> = NPY_UINT32;
template <>
inline constexpr int numpy_type<std::int8_t> = NPY_INT8;
template <>
inline constexpr int numpy_type<std::uint8_t> = NPY_UINT8;
template <>
inline constexpr int numpy_type<bool> = NPY_BOOL;

// A new array, of the numbers at `values` unless it is null. Null with an error set.
template <class T = double>
PyObject* new_array(std::initializer_list<npy_intp> shape, const T* values = nullptr) {
    PyObject* made =
        PyArray_SimpleNew(int(shape.size()), const_cast<npy_intp*>(shape.begin()), numpy_type<T>);
    if (made && values)
        std::copy_n(values, PyArray_SIZE(reinterpret_cast<PyArrayObject*>(made)), data_of<T>(made));
    return made;
}

// Whether item is a float or an integer that fits into a double.
inline bool read_number(PyObject* item, double& number) {
    if (PyFloat_Check(item)) return number = PyFloat_AS_DOUBLE(item), true;
    if (!PyLong_CheckExact(item)) return false;
    number = PyLong_AsDouble(item);
    if (number != -1 || !PyErr_Occurred()) return true;
    PyErr_Clear();
    return false;
}

// The numbers of a list or tuple of `count` floats and integers, in `copy`; null for everything else.
inline const double* read_sequence(PyObject* value, npy_intp count, double* copy) {
    if (!PyList_CheckExact(value) && !PyTuple_CheckExact(value)) return nullptr;
    if (PySequence_Fast_GET_SIZE(value) != count) return nullptr;
    for (npy_intp j = 0; j < count; ++j)
        if (!read_number(PySequence_Fast_ITEMS(value)[j], copy[j])) return nullptr;
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

// Whether value holds so many finite numbers, which are written into row; else no error is set.
inline bool read_numbers(PyObject* value, double* row, int count) {
    const double* numbers = read_in_place(value, 0, count, row);
    if (numbers && numbers != row) std::copy_n(numbers, count, row);
    return numbers && std::all_of(row, row + count, [](double number) { return std::isfinite(number); });
}
