// What the bindings of fields share: arrays from vectors, and routes from ways over cells.
#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "grid.hpp"
#include "route.hpp"

namespace fields {

using PointRow = Array<const double, nanobind::shape<2>>;

template <class T>
nanobind::object table(std::vector<T>&& values, std::size_t rows, std::size_t columns) {
    auto kept = std::make_unique<std::vector<T>>(std::move(values));
    T* data = kept->data();
    nanobind::capsule owner(kept.release(), [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    using Made = nanobind::ndarray<nanobind::numpy, T, nanobind::c_contig>;
    if (columns == 0) return nanobind::cast(Made(data, {rows}, owner));
    return nanobind::cast(Made(data, {rows, columns}, owner));
}

// One number per cell, by rows.
template <class T, class Of>
nanobind::object map_of(const cspace::maps::BitGrid& grid, const Of& of) {
    std::vector<T> values;
    values.reserve(std::size_t(grid.rows()) * std::size_t(grid.columns()));
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column)
            values.push_back(of(cspace::maps::Cell{row, column}));
    return table(std::move(values), std::size_t(grid.rows()), std::size_t(grid.columns()));
}

inline cspace::maps::Cell free_cell(const cspace::maps::BitGrid& grid, const cspace::maps::GridFrame& frame,
                                    const PointRow& point) {
    cspace::maps::Cell cell{};
    if (frame.locate(grid, {point.data()[0], point.data()[1]}, cell) != cspace::maps::Place::free)
        throw nanobind::value_error("points in free cells");
    return cell;
}

inline nanobind::object made_route(nanobind::handle world, nanobind::handle planner, nanobind::handle options,
                                   const PointRow& start, const PointRow& goal,
                                   const cspace::navigation::Route& route, double seconds) {
    PyObject* made =
        make_route(world.ptr(), planner.ptr(), options.ptr(), start.data(), goal.data(), route, seconds);
    if (!made) throw nanobind::python_error();
    return nanobind::steal(made);
}
inline void set_evidence(nanobind::handle route, nanobind::object evidence) {
    reinterpret_cast<RouteObject*>(route.ptr())->evidence = evidence.release().ptr();
}

inline nanobind::object arrays_of(const cspace::navigation::Trace& trace) {
    PyObject* made = trace_arrays(trace);
    if (!made) throw nanobind::python_error();
    return nanobind::steal(made);
}

class Watch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    }

  private:
    std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

}  // namespace fields
