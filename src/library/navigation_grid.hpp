// The searches over grids: what the bindings call.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "navigation_query.hpp"
#include "table.hpp"

namespace cspace::navigation {

// A search over cells. choices: the numbers of GridPlanner, Corners and Metric. weights: of g and h; the
// bound of focal search, so many times the shortest. costs: of the cells, by rows; empty: 1 each; least_cost
// of them. Evidence: how many parts there are, if the ends lie in two, or 0; the cost of the way, and below
// any way [m, or cost · m]. The events are the cells in the order in which the search settles them. Throws
// std::invalid_argument for unknown choices, and for costs of another number than there are cells.
bool plan_cells(const Query<GridWorld>& query, Answer<std::int64_t, double, double>& answer,
                const std::array<std::int64_t, 3>& choices, const std::array<double, 3>& weights,
                std::span<const double> costs, double least_cost);

// The shortest path between points, at any angle. Throws std::invalid_argument for a grid of too many cells.
bool plan_runs(const Query<GridWorld>& query, Route& route);

// D* Lite over a grid of its own.
class GridReplanner {
  public:
    // corners is the number of Corners. Throws std::invalid_argument for an unknown rule, and, as all
    // here do, for points and cells outside the grid.
    GridReplanner(const GridWorld& world, int corners, Point start, Point goal);

    Table<std::uint8_t> unpack() const;  // a byte per cell
    // Cells (row, column) become blocked or free.
    void set_cells(std::span<const std::array<std::int32_t, 2>> cells, bool blocked);
    void move_to(Point start);
    // From where the robot is: status, path, length, nodes, edges, and the cells (row, column) in the order
    // in which they were settled.
    std::tuple<int, Table<Point>, double, std::int64_t, std::int64_t, Table<std::int32_t>> replan();

  private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace cspace::navigation
