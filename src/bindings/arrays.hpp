// Arrays of NumPy as the bindings take them: contiguous, in memory, of a stated type and shape.
#pragma once

#include <nanobind/ndarray.h>

template <class T, class... Traits>
using Array = nanobind::ndarray<T, nanobind::c_contig, nanobind::device::cpu, Traits...>;

using Row = Array<const double, nanobind::ndim<1>>;
using Matrix = Array<const double, nanobind::ndim<2>>;
using Vectors = Array<const double, nanobind::shape<-1, 3>>;
using Goal = Array<const double, nanobind::shape<4, 4>>;
using Goals = Array<const double, nanobind::shape<-1, 4, 4>>;

using RowOut = Array<double, nanobind::ndim<1>>;

template <class Array, class... Sizes>
bool has_shape(const Array& array, Sizes... sizes) {
    std::size_t axis = 0;
    return ((array.shape(axis++) == sizes) && ...);
}
inline void require_sizes(bool fit) {
    if (!fit) throw nanobind::value_error("arrays of matching sizes are needed");
}
