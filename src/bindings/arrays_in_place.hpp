// Contiguous arrays of NumPy as arguments and results of nanobind, read in place and never converted.
#pragma once

#include <nanobind/ndarray.h>

#include <type_traits>

#include "numpy_api.hpp"

// A contiguous array of T: an argument, which is read in place, or a new one. Of const T it may be read-only.
template <class T>
struct Plain {
    nanobind::object array;
    T* data = nullptr;
    npy_intp size = 0;

    Plain() = default;
    explicit Plain(std::initializer_list<npy_intp> shape, const T* values = nullptr)
        : array(nanobind::steal(new_array<T>(shape, values))) {
        if (!array) throw nanobind::python_error();
        data = data_of<T>(array.ptr());
        size = PyArray_SIZE(reinterpret_cast<PyArrayObject*>(array.ptr()));
    }

    // Whether value is such an array.
    bool read(PyObject* value) {
        auto* given = reinterpret_cast<PyArrayObject*>(value);
        if (!PyArray_CheckExact(value) ||  // a masked array hides entries
            !PyArray_EquivTypenums(PyArray_TYPE(given), numpy_type<std::remove_const_t<T>>) ||
            !PyArray_ISCARRAY_RO(given) || (!std::is_const_v<T> && !PyArray_ISWRITEABLE(given)))
            return false;
        array = nanobind::borrow(value);
        data = data_of<T>(value);
        size = PyArray_SIZE(given);
        return true;
    }
    int ndim() const { return PyArray_NDIM(reinterpret_cast<PyArrayObject*>(array.ptr())); }
    npy_intp shape(int axis) const {
        return PyArray_DIM(reinterpret_cast<PyArrayObject*>(array.ptr()), axis);
    }
};
using Doubles = Plain<double>;
using ConstDoubles = Plain<const double>;

template <class T>
struct nanobind::detail::type_caster<Plain<T>> {
    NB_TYPE_CASTER(Plain<T>,
                   const_name("numpy.typing.NDArray[numpy.") + dtype_traits<T>::name + const_name("]"))
    bool from_python(handle given, std::uint32_t, cleanup_list*) noexcept { return value.read(given.ptr()); }
    static handle from_cpp(const Plain<T>& made, rv_policy, cleanup_list*) noexcept {
        return made.array.inc_ref();
    }
};
