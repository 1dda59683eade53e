// Points of the plane and other rows of numbers as the bindings of maps and navigation take them, and the
// arrays that they return.
#pragma once

#include <array>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "arrays_in_place.hpp"
#include "bindings.hpp"
#include "library/maps_grid.hpp"
#include "library/table.hpp"

// The numbers that rows of type T are made of.
template <class T>
struct NumberIn {
    using type = std::conditional_t<std::is_class_v<T>, double, T>;
};
template <class T, std::size_t n>
struct NumberIn<std::array<T, n>> {
    using type = T;
};
template <class T>
using number_in = typename NumberIn<std::remove_const_t<T>>::type;
template <class T>
inline constexpr npy_intp width_of = sizeof(T) / sizeof(number_in<T>);

template <class T>
constexpr auto array_name =
    nanobind::detail::const_name("numpy.typing.NDArray[numpy.") +
    nanobind::detail::dtype_traits<number_in<T>>::name + nanobind::detail::const_name("]");

// An array (rows, columns) or (rows,) from a table. Few bytes are copied, many stay where they are.
template <class T>
nanobind::object make_array(cspace::Table<T>&& table) {
    constexpr std::size_t few = 1 << 12;
    using Number = number_in<T>;
    const std::size_t bytes = table.values.size() * sizeof(T);
    const npy_intp columns = npy_intp(table.columns ? table.columns : 1) * width_of<T>;
    npy_intp shape[] = {npy_intp(bytes / sizeof(Number)) / columns, columns};
    const int dimensions = table.columns || width_of<T> > 1 ? 2 : 1;
    PyObject* made;
    if (bytes <= few) {
        made = PyArray_SimpleNew(dimensions, shape, numpy_type<Number>);
        if (made && bytes) std::memcpy(data_of<Number>(made), table.values.data(), bytes);
    } else {
        auto kept = std::make_unique<std::vector<T>>(std::move(table.values));
        made = PyArray_SimpleNewFromData(dimensions, shape, numpy_type<Number>, kept->data());
        nanobind::capsule owner(kept.release(),
                                [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
        if (made) PyArray_SetBaseObject(reinterpret_cast<PyArrayObject*>(made), owner.release().ptr());
    }
    if (!made) throw nanobind::python_error();
    return nanobind::steal(made);
}

NAMESPACE_BEGIN(NB_NAMESPACE)
NAMESPACE_BEGIN(detail)

// A row of finite numbers, given as an array, a tuple or a list.
template <class T>
struct RowCaster {
    NB_TYPE_CASTER(T, const_name("numpy.typing.ArrayLike"))
    bool from_python(handle given, std::uint32_t, cleanup_list*) noexcept {
        return read_numbers(given.ptr(), reinterpret_cast<double*>(&value), width_of<T>);
    }
};
template <>
struct type_caster<cspace::Point> : RowCaster<cspace::Point> {};
template <std::size_t n>
struct type_caster<std::array<double, n>> : RowCaster<std::array<double, n>> {};

// Rows of one array, read or written in place.
template <class T>
struct type_caster<std::span<T>> {
    NB_TYPE_CASTER(std::span<T>, array_name<T>)
    bool from_python(handle given, std::uint32_t, cleanup_list*) noexcept {
        using Number = std::conditional_t<std::is_const_v<T>, const number_in<T>, number_in<T>>;
        Plain<Number> rows;
        if (!rows.read(given.ptr()) || rows.ndim() != (width_of<T> > 1 ? 2 : 1) ||
            (width_of<T> > 1 && rows.shape(1) != width_of<T>))
            return false;
        value = {reinterpret_cast<T*>(rows.data), std::size_t(rows.size / width_of<T>)};
        return true;
    }
};

template <>
struct type_caster<cspace::maps::CellBytes> {
    NB_TYPE_CASTER(cspace::maps::CellBytes, array_name<std::uint8_t>)
    bool from_python(handle given, std::uint32_t, cleanup_list*) noexcept {
        Plain<const std::uint8_t> cells;
        if (!cells.read(given.ptr()) || cells.ndim() != 2) return false;
        value = {cells.data, int(cells.shape(0)), int(cells.shape(1))};
        return true;
    }
};

template <class T>
struct type_caster<cspace::Table<T>> {
    NB_TYPE_CASTER(cspace::Table<T>, array_name<T>)
    static handle from_cpp(cspace::Table<T>&& made, rv_policy, cleanup_list*) {
        return make_array(std::move(made)).release();
    }
};

NAMESPACE_END(detail)
NAMESPACE_END(NB_NAMESPACE)
