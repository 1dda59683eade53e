// How many neighbours make paths approach the shortest.
#pragma once

#include <algorithm>
#include <cstddef>

#include "cspace/search/portable_log.hpp"

namespace cspace::search {

// Above e (1 + 1/d) log n nearest neighbours, shortest ways among n nodes in d dimensions approach the
// shortest (Karaman & Frazzoli 2011, "Sampling-based algorithms for optimal motion planning", theorem 35).
inline int star_neighbours(std::size_t nodes, int dimensions) {
    constexpr double e = 2.718281828459045;
    const double factor = e * (1 + 1.0 / std::max(dimensions, 1));
    return 1 + int(factor * portable_log(std::max<std::size_t>(nodes, 2)));
}

}  // namespace cspace::search
