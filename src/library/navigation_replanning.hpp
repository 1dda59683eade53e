// D* Lite over a grid of its own: what the bindings call.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cspace/navigation/route.hpp"
#include "maps_grid.hpp"

namespace cspace::navigation {

class GridReplanner {
  public:
    // corners is the number of Corners. Throws std::invalid_argument for an unknown rule, and, as all
    // here do, for points and cells outside the grid.
    GridReplanner(const maps::GridWorld& world, int corners, Point start, Point goal);
    GridReplanner(GridReplanner&&) noexcept;
    ~GridReplanner();

    int rows() const;
    int columns() const;
    void unpack(std::uint8_t* into) const;
    // Cells (row, column) become blocked or free.
    void set_cells(std::span<const std::int32_t> cells, bool blocked);
    void move_to(Point start);
    // The route from where the robot is, and the cells (row, column) in the order in which they were settled.
    Route replan(std::vector<std::int32_t>& settled);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace cspace::navigation
