// The searches over grids: what the bindings call.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "navigation_query.hpp"
#include "table.hpp"

namespace cspace::navigation {

// A search over cells. The memory of its route is kept from one query of a thread to the next. Making the
// answer may collect garbage and so run any code, another query too, which then finds none.
struct CellsQuery : Query<GridWorld> {
    std::array<std::int64_t, 3> choices;  // the numbers of GridPlanner, Corners and Metric
    std::array<double, 3> weights;        // of g and h; the bound of focal search, so many times the shortest
    std::span<const double> costs;        // of the cells, by rows; empty: 1 each
    double least_cost;                    // the least of them
    // Of the way, and below any way [m, or cost · m]; how many parts there are, if the ends lie in two, or 0.
    double cost, least;
    std::int64_t parts;

    CellsQuery();
    ~CellsQuery();
    auto settings() { return std::tie(choices, weights, costs, least_cost); }
    // A search of few cells takes no longer than to free the interpreter.
    bool is_concurrent(const GridWorld& world) const { return world.cells() > 1 << 14; }
    // The events are the cells in the order in which the search settles them. Throws std::invalid_argument
    // for unknown choices, and for costs of another number than there are cells.
    bool find(const GridWorld& world, Point start, Point goal, Trace* trace);
    // Where path and length do not say it: parts, cost and the bound below it.
    std::optional<std::tuple<std::int64_t, double, double>> evidence() const;
};

// The shortest path between points, at any angle. Throws std::invalid_argument for a grid of too many cells.
struct RunsQuery : Query<GridWorld> {
    bool find(const GridWorld& world, Point start, Point goal, Trace* trace);
};

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
