// Points of the plane as the bindings of maps and navigation take them, and the tables that they return.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/math/plane.hpp"

using PointRow = Array<const double, nanobind::shape<2>>;
using Points = Array<const double, nanobind::shape<-1, 2>>;

inline cspace::Point point_of(const PointRow& row) { return {row.data()[0], row.data()[1]}; }
inline std::span<const cspace::Point> points_of(const Points& rows) {
    return {reinterpret_cast<const cspace::Point*>(rows.data()), rows.shape(0)};
}

// An array (rows, columns), or (rows,) for no columns, that owns the numbers.
template <class T>
nanobind::object table(std::vector<T>&& values, std::size_t rows, std::size_t columns) {
    auto kept = std::make_unique<std::vector<T>>(std::move(values));
    T* data = kept->data();
    nanobind::capsule owner(kept.release(), [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    using Made = nanobind::ndarray<nanobind::numpy, T, nanobind::c_contig>;
    if (columns == 0) return nanobind::cast(Made(data, {rows}, owner));
    return nanobind::cast(Made(data, {rows, columns}, owner));
}
template <class T>
nanobind::object table(std::vector<T>&& values) {
    const std::size_t rows = values.size();
    return table(std::move(values), rows, 0);
}
inline nanobind::object point_table(const std::vector<cspace::Point>& points) {
    const auto* numbers = reinterpret_cast<const double*>(points.data());
    return table(std::vector<double>(numbers, numbers + 2 * points.size()), points.size(), 2);
}
