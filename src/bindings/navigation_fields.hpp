// What the bindings of fields share: arrays from vectors, routes and traces from what planners return.
#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "navigation_route.hpp"

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
