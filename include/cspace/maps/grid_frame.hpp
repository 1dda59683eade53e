// Where the cells of a grid lie in the plane: row i spans y in origin.y + resolution · [i, i + 1], column j
// spans x likewise.
#pragma once

#include <cmath>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/math/plane.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::maps {

enum class CellState : signed char { free, blocked, outside };

struct GridFrame {
    double resolution = 1;  // the side of a cell [m]
    Point origin;           // the corner of cell (0, 0) of least x and y [m]

    Point center(Cell c) const {
        return {origin.x + resolution * (c.column + 0.5), origin.y + resolution * (c.row + 0.5)};
    }
    // The cell in which a point lies, or which is nearest to it.
    Cell nearest_cell(const BitGrid& grid, Point p) const {
        const auto index = [&](double at, int count) {
            return std::clamp(int(std::floor(at / resolution)), 0, count - 1);
        };
        return {index(p.y - origin.y, grid.rows()), index(p.x - origin.x, grid.columns())};
    }
    // The cell of a point. Where it lies on the border of cells it is in each of them,
    // and a free one is preferred.
    CellState locate(const BitGrid& grid, Point p, Cell& cell) const {
        const double across = (p.x - origin.x) / resolution, up = (p.y - origin.y) / resolution;
        if (!(across >= -on_border && across <= grid.columns() + on_border && up >= -on_border &&
              up <= grid.rows() + on_border))
            return CellState::outside;
        cell = {place(up, grid.rows()), place(across, grid.columns())};
        if (!grid.blocked(cell)) return CellState::free;
        for (int down = -1; down <= 1; ++down)
            for (int along = -1; along <= 1; ++along) {
                const Cell beside = {cell.row + down, cell.column + along};
                if (grid.contains(beside) && touches(up, beside.row) && touches(across, beside.column) &&
                    !grid.blocked(beside)) {
                    cell = beside;
                    return CellState::free;
                }
            }
        return CellState::blocked;
    }

  private:
    static constexpr double on_border = tolerance::cell_border;
    static int place(double at, int count) { return at < 1 ? 0 : at >= count ? count - 1 : int(at); }
    static bool touches(double at, int k) { return at >= k - on_border && at <= k + 1 + on_border; }
};

}  // namespace cspace::maps
