// Coverage of a grid by a bar: what the bindings call.
#pragma once

#include <cstdint>
#include <tuple>

#include "maps_grid.hpp"
#include "table.hpp"

namespace cspace::navigation {

// The path (row, column) cell by cell; the region of each cell, −1 not reached; the order in which regions
// are entered; how often the bar came over each cell; how many cells are reached and free; how many lines are
// driven, and places that took a way of their own.
using CoverageTables =
    std::tuple<Table<std::int32_t>, Table<std::int32_t>, Table<std::int32_t>, Table<std::uint32_t>,
               std::int64_t, std::int64_t, std::int64_t, std::int64_t>;

// half: how many cells the bar reaches to either side. Throws std::invalid_argument for a cell that is not
// free and for a negative half.
CoverageTables cover_grid(const maps::GridWorld& world, int row, int column, int half, bool along_rows);

}  // namespace cspace::navigation
