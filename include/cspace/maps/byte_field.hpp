// A score from 0 to 255 for every cell of a grid, for instance how likely a laser beam ends there. Bytes keep
// the map of a building in the cache of a core.
#pragma once

#include <cstdint>
#include <vector>

#include "cspace/maps/grid_frame.hpp"

namespace cspace::maps {

struct ByteField {
    GridFrame frame;
    int rows = 0, columns = 0;
    std::uint8_t outside = 0;          // the score of all cells outside
    std::vector<std::uint8_t> scores;  // by row · columns + column, row 0 the lowest

    std::uint8_t at(Cell c) const {
        const bool inside = c.row >= 0 && c.row < rows && c.column >= 0 && c.column < columns;
        return inside ? scores[std::size_t(c.row) * std::size_t(columns) + std::size_t(c.column)] : outside;
    }
};

}  // namespace cspace::maps
