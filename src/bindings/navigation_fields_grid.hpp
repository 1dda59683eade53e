// What the bindings of fields over grids share.
#pragma once

#include "cspace/navigation/grid/grid_route.hpp"
#include "maps_grid.hpp"
#include "navigation_fields.hpp"

namespace fields {

// One number per cell, by rows.
template <class T, class Of>
nanobind::object map_of(const cspace::maps::BitGrid& grid, const Of& of) {
    std::vector<T> values;
    values.reserve(std::size_t(grid.rows()) * std::size_t(grid.columns()));
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column)
            values.push_back(of(cspace::maps::Cell{row, column}));
    return table(std::move(values), std::size_t(grid.rows()), std::size_t(grid.columns()));
}

inline cspace::maps::Cell free_cell(const cspace::maps::BitGrid& grid, const cspace::maps::GridFrame& frame,
                                    const PointRow& point) {
    cspace::maps::Cell cell{};
    if (frame.locate(grid, {point.data()[0], point.data()[1]}, cell) != cspace::maps::CellState::free)
        throw nanobind::value_error("points in free cells");
    return cell;
}

}  // namespace fields
