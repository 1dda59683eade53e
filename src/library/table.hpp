// Rows of numbers on their way to an array.
#pragma once

#include <cstddef>
#include <vector>

namespace cspace {

template <class T>
struct Table {
    std::vector<T> values;
    std::size_t columns = 0;  // values in a row; 0: one, and no axis for it
};

}  // namespace cspace
