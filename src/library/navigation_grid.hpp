// The searches over grids: what the bindings call.
#pragma once

#include <cstdint>
#include <vector>

#include "cspace/navigation/route.hpp"
#include "maps_grid.hpp"

namespace cspace::navigation {

// planner, corners and metric are the numbers of GridPlanner, Corners and Metric.
struct GridQuestion {
    Point start, goal;
    int planner, corners, metric;
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

// A function that a search calls now and then; it may throw, and may run another search.
using Look = void (*)();

// False where an end lies in no free cell.
bool find_grid_route(const maps::GridWorld& world, const GridQuestion& question, Look look,
                     GridFinding& finding);
// The cells in the order in which the search settles them: row and column of each and of its parent, and its
// distance g [m or m · cost].
bool list_settled_cells(const maps::GridWorld& world, const GridQuestion& question, Look look,
                        std::vector<std::int32_t>& cells, std::vector<double>& g);

// The shortest path between points, at any angle. False where an end lies in no free cell. Throws
// std::invalid_argument for a grid of too many cells.
bool find_any_angle_route(const maps::GridWorld& world, Point start, Point goal, Look look, Route& route,
                          Trace* trace);

}  // namespace cspace::navigation
