// What fields over grids share: for files of the library, not for bindings.
#pragma once

#include "cspace/navigation/fields/clearance.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "maps_grid_state.hpp"
#include "navigation_fields_grid.hpp"

namespace cspace::navigation {

struct ClearanceField::State {
    Clearance clearance;
};

// One number per cell, by rows.
template <class T, class Of>
std::vector<T> map_cells(const maps::BitGrid& grid, const Of& of) {
    std::vector<T> values;
    values.reserve(std::size_t(grid.rows()) * std::size_t(grid.columns()));
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column) values.push_back(of(maps::Cell{row, column}));
    return values;
}

}  // namespace cspace::navigation
