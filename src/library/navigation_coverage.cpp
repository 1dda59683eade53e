#include "navigation_coverage.hpp"

#include "cspace/navigation/coverage/cover.hpp"
#include "maps_grid_state.hpp"

namespace cspace::navigation {

CoverageTables cover_grid(const maps::GridWorld& world, int row, int column, int half, bool along_rows) {
    const maps::BitGrid& grid = world.state().bits;
    if (grid.blocked(row, column) || !grid.contains({row, column}) || half < 0)
        throw std::invalid_argument("the start must be a free cell, and half must not be negative");
    Coverage made = cover_cells(grid, {row, column}, half, along_rows);
    Table<std::int32_t> path{{}, 2};
    path.values.reserve(2 * made.path.size());
    for (const maps::Cell cell : made.path) path.values.insert(path.values.end(), {cell.row, cell.column});
    const auto columns = std::size_t(grid.columns());
    return {std::move(path),
            {std::move(made.region), columns},
            {std::move(made.order)},
            {std::move(made.passes), columns},
            made.reached,
            made.free,
            made.lanes,
            made.leftover};
}

}  // namespace cspace::navigation
