// The searches over grids: what the bindings call.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cspace/navigation/route.hpp"
#include "maps_grid.hpp"

namespace cspace::navigation {

// planner, corners and metric are the numbers of GridPlanner, Corners and Metric.
struct GridQuestion {
    std::int64_t planner, corners, metric;
    double g_weight, h_weight;
    double bound;         // of focal search: at most so many times the shortest
    const double* costs;  // of the cells, by rows; null: 1 each
    double least_cost;    // the least of them

    bool is_known() const;    // whether there are such a planner, corner rule and metric
    bool has_bounds() const;  // whether cost and least say more than the length of the path
};

struct GridFinding {
    Route route;
    bool found = false;
    double cost = 0, least = 0;  // of the way, and below any way [cells, or cells · cost]
    std::int64_t parts = 0;      // how many there are, where the ends lie in two of them; or 0
};

// False where an end lies in no free cell. The events are the cells in the order in which the search settles
// them.
bool find_grid_route(const maps::GridWorld& world, const GridQuestion& question, Point start, Point goal,
                     GridFinding& finding, Trace* trace);

// The shortest path between points, at any angle. False where an end lies in no free cell. Throws
// std::invalid_argument for a grid of too many cells.
bool find_any_angle_route(const maps::GridWorld& world, Point start, Point goal, Route& route, Trace* trace);

// D* Lite over a grid of its own.
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
