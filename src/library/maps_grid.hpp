// Occupancy grids: what the bindings call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>

#include "cspace/math/plane.hpp"
#include "table.hpp"

namespace cspace::maps {

// A byte per cell, by rows.
struct CellBytes {
    const std::uint8_t* data;
    int rows, columns;
};

// A grid, where it lies in the plane, and the parts of its free cells if a search has asked for them.
class GridWorld {
  public:
    struct State;  // maps_grid_state.hpp, for the library

    // The side of a cell and the corner of least x and y [m].
    GridWorld(CellBytes blocked, double resolution, Point origin);
    // The same grid with obstacles grown by a radius [m].
    GridWorld(const GridWorld& other, double radius, bool from_centers);

    const int rows, columns;
    const double resolution, x, y;

    std::size_t cells() const;  // with the border that the core adds
    std::size_t count_blocked() const;
    std::size_t count_corners() const;
    std::size_t bytes() const;
    Table<std::uint8_t> unpack() const;  // a byte per cell
    // Where a point lies (0 in a free cell, 1 in a blocked one, 2 outside), and its row and column.
    std::tuple<int, int, int> locate(Point p) const;
    // Which points lie in free cells or on their borders.
    Table<std::uint8_t> find_free(std::span<const Point> points) const;
    // The least distance from a path to a blocked cell or the border [m].
    double path_clearance(std::span<const Point> path) const;

    State& state() const { return *state_; }

  private:
    explicit GridWorld(std::shared_ptr<State> state);
    std::shared_ptr<State> state_;
};

}  // namespace cspace::maps
