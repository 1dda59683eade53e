// What a GridWorld holds: for files of the library, not for bindings.
#pragma once

#include <stdexcept>

#include "cspace/maps/grid_frame.hpp"
#include "cspace/maps/grid_parts.hpp"
#include "maps_grid.hpp"

namespace cspace::maps {

// A byte per cell.
inline Table<std::uint8_t> unpack_bits(const BitGrid& bits) {
    const auto columns = std::size_t(bits.columns());
    Table<std::uint8_t> made{std::vector<std::uint8_t>(columns * std::size_t(bits.rows())), columns};
    bits.unpack(made.values.data());
    return made;
}

struct GridWorld::State {
    BitGrid bits;
    GridFrame frame;
    LazyParts parts{};

    bool find_cell(Point p, Cell& cell) const { return frame.locate(bits, p, cell) == CellState::free; }
    // The cells of start and goal; false where one is not free.
    bool find_cells(Point start, Point goal, Cell& from, Cell& to) const {
        return find_cell(start, from) && find_cell(goal, to);
    }
    // Throws std::invalid_argument unless the point lies in a free cell.
    Cell free_cell(Point p) const {
        Cell cell{};
        if (!find_cell(p, cell)) throw std::invalid_argument("start and goal must lie in free cells");
        return cell;
    }
};

}  // namespace cspace::maps
