// Coverage of a grid by a bar: what the bindings call.
#pragma once

#include <cstdint>
#include <vector>

#include "maps_grid.hpp"

namespace cspace::navigation {

struct CoverageFinding {
    std::vector<std::int32_t> path;     // (row, column), cell by cell
    std::vector<std::int32_t> region;   // of each cell of the grid, by rows; −1 not reached
    std::vector<std::int32_t> order;    // in which the regions are entered
    std::vector<std::uint32_t> passes;  // how often the bar came over each cell, by rows
    std::int64_t reached, free;         // cells
    std::int64_t lanes, leftover;       // lines driven, and places that took a way of their own
};
// half: how many cells the bar reaches to either side. Throws std::invalid_argument for a cell that is not
// free and for a negative half.
CoverageFinding cover_grid(const maps::GridWorld& world, int row, int column, int half, bool along_rows);

}  // namespace cspace::navigation
