// What a GridWorld holds: for files of the library, not for bindings.
#pragma once

#include <stdexcept>

#include "cspace/maps/grid_frame.hpp"
#include "cspace/maps/grid_parts.hpp"
#include "maps_grid.hpp"

namespace cspace::maps {

// Throws std::invalid_argument unless the point lies in a free cell.
inline Cell free_cell(const GridFrame& frame, const BitGrid& grid, Point p) {
    Cell cell{};
    if (frame.locate(grid, p, cell) != CellState::free)
        throw std::invalid_argument("start and goal must lie in free cells");
    return cell;
}

struct GridWorld::State {
    BitGrid bits;
    GridFrame frame;
    LazyParts parts{};

    bool find_cell(Point p, Cell& cell) const { return frame.locate(bits, p, cell) == CellState::free; }
    Cell free_cell(Point p) const { return maps::free_cell(frame, bits, p); }
};

}  // namespace cspace::maps
