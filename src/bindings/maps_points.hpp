// Points of the plane as the bindings of maps and navigation take them, and the arrays that they return.
#pragma once

#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/math/plane.hpp"
#include "numpy_api.hpp"

using PointRow = Array<const double, nanobind::shape<2>>;
using Points = Array<const double, nanobind::shape<-1, 2>>;

inline cspace::Point point_of(const PointRow& row) { return {row.data()[0], row.data()[1]}; }
inline std::span<const cspace::Point> points_of(const Points& rows) {
    return {reinterpret_cast<const cspace::Point*>(rows.data()), rows.shape(0)};
}

// A new array of NumPy, whose numbers the stubs state.
template <class T>
struct Numbers : nanobind::object {
    static constexpr auto Name = nanobind::detail::make_caster<nanobind::ndarray<nanobind::numpy, T>>::Name;
    using nanobind::object::object;
    static bool check_(nanobind::handle value) { return PyArray_Check(value.ptr()); }
};

template <class T>
constexpr int number_type = NPY_UINT8;
template <>
inline constexpr int number_type<double> = NPY_DOUBLE;
template <>
inline constexpr int number_type<std::int64_t> = NPY_INT64;
template <>
inline constexpr int number_type<std::int32_t> = NPY_INT32;
template <>
inline constexpr int number_type<std::uint32_t> = NPY_UINT32;
template <>
inline constexpr int number_type<std::int8_t> = NPY_INT8;

// An array (rows, columns) of numbers of type T, or (rows,) for no columns, from what a vector holds. Few
// bytes are copied, many stay where they are.
template <class T, class Held>
Numbers<T> make_array(std::vector<Held>&& values, std::size_t columns) {
    constexpr std::size_t few = 1 << 12;
    const std::size_t bytes = values.size() * sizeof(Held), numbers = bytes / sizeof(T);
    npy_intp shape[] = {npy_intp(columns ? numbers / columns : numbers), npy_intp(columns)};
    const int dimensions = columns ? 2 : 1;
    PyObject* made;
    if (bytes <= few) {
        made = PyArray_SimpleNew(dimensions, shape, number_type<T>);
        if (made && bytes)
            std::memcpy(PyArray_DATA(reinterpret_cast<PyArrayObject*>(made)), values.data(), bytes);
    } else {
        auto kept = std::make_unique<std::vector<Held>>(std::move(values));
        made = PyArray_SimpleNewFromData(dimensions, shape, number_type<T>, kept->data());
        nanobind::capsule owner(kept.release(),
                                [](void* p) noexcept { delete static_cast<std::vector<Held>*>(p); });
        if (made) PyArray_SetBaseObject(reinterpret_cast<PyArrayObject*>(made), owner.release().ptr());
    }
    if (!made) throw nanobind::python_error();
    return nanobind::steal<Numbers<T>>(made);
}
template <class T>
Numbers<T> table(std::vector<T> values, std::size_t columns = 0) {
    return make_array<T>(std::move(values), columns);
}
inline Numbers<double> point_table(std::vector<cspace::Point> points, std::size_t points_per_row = 1) {
    return make_array<double>(std::move(points), 2 * points_per_row);
}
