// Occupancy grids: what the bindings call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "cspace/math/plane.hpp"

namespace cspace::maps {

// Where a point lies: 0 in a free cell, 1 in a blocked one, 2 outside the grid.
struct GridPlace {
    int state, row, column;
};

// A grid, where it lies in the plane, and the parts of its free cells if a search has asked for them.
class GridWorld {
  public:
    struct State;  // maps_grid_state.hpp, for the library

    // A byte per cell, by rows; the side of a cell and the corner of least x and y [m].
    GridWorld(const std::uint8_t* blocked, int rows, int columns, double resolution, Point origin);
    // The same grid with obstacles grown by a radius [m].
    GridWorld(const GridWorld& other, double radius, bool from_centers);
    GridWorld(GridWorld&&) noexcept;
    ~GridWorld();

    int rows() const;
    int columns() const;
    double resolution() const;
    Point origin() const;
    std::size_t cells() const;  // with the border that the core adds
    std::size_t count_blocked() const;
    std::size_t count_corners() const;
    std::size_t bytes() const;
    void unpack(std::uint8_t* into) const;
    GridPlace locate(Point p) const;
    // The least distance from a path to a blocked cell or the border [m].
    double path_clearance(std::span<const Point> path) const;

    State& state() const { return *state_; }

  private:
    std::unique_ptr<State> state_;
};

}  // namespace cspace::maps
