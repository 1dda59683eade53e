// Kernels over rows of arrays: what they are given is checked, and they run without the interpreter lock.
#pragma once

#include <nanobind/stl/optional.h>

#include <atomic>
#include <new>

#include "arrays_in_place.hpp"
#include "cspace/math/threads.hpp"
#include "kinematics.hpp"
#include "library/scratch.hpp"

using In = std::optional<ConstDoubles>;
using Out = std::optional<Doubles>;

// An array by what it must hold per row; null for None.
template <class T>
T* values_of(const std::optional<Plain<T>>& array, npy_intp rows, npy_intp per_row) {
    if (array && array->size != rows * per_row) throw nanobind::value_error("an array has the wrong size");
    return array ? array->data : nullptr;
}
// The same where one row may serve all: the stride is then 0.
inline const double* shared_values(const In& array, npy_intp rows, npy_intp per_row, std::size_t& stride) {
    stride = !array || array->size == per_row ? 0 : std::size_t(per_row);
    return values_of(array, stride ? rows : 1, per_row);
}
inline npy_intp row_count(const ConstDoubles& q, int n) {
    if (q.ndim() != 2 || q.shape(1) != n)
        throw nanobind::value_error("q must have two axes, (rows, coordinates)");
    return q.shape(0);
}
inline int velocities_of(const KinematicsObject& robot) {
    return robot.model->n_coordinates() + (robot.floating ? 6 : 0);
}

inline constexpr std::size_t lanes = 8, rows_worth_a_thread = 2048;

// Runs a kernel over all rows without the interpreter lock. False if a value of q is not finite.
template <class Rows, class Kernel>
bool run_kernel(const Rows& rows, npy_intp n, int threads, Kernel kernel) {
    const nanobind::gil_scoped_release release;
    std::atomic<bool> memory = true;
    const std::size_t bytes = scratch_bytes(rows);
    const bool finite = cspace::over_rows(std::size_t(n), threads, lanes, rows_worth_a_thread,
                                          [&](std::size_t begin, std::size_t end) {
                                              const cspace::Scratch scratch = cspace::try_scratch(bytes);
                                              if (!scratch) memory = false;
                                              return scratch && kernel(rows, begin, end, scratch.get());
                                          });
    if (!memory) throw std::bad_alloc();
    return finite;
}
