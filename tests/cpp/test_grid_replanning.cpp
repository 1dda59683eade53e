#include <vector>

#include "check.hpp"
#include "cspace/navigation/grid/d_star_lite.hpp"
#include "cspace/navigation/grid/search.hpp"
#include "random.hpp"

using namespace cspace::maps;
using namespace cspace::navigation;

TEST(mended_ways_are_as_long_as_fresh_ones) {
    check::Random random{1};
    GridScratch scratch;
    GridAnswer answer;
    for (const Corners rule : {Corners::never, Corners::one, Corners::always, Corners::four}) {
        const int rows = 20, columns = 70;
        BitGrid grid(rows, columns);
        for (int k = 0; k < 350; ++k) grid.set(random.below(rows), random.below(columns), true);
        const Cell goal = {rows - 1, columns - 1};
        Cell start = {0, 0};
        DStarLite planner(grid, rule, start, goal);
        for (int k = 0; k < 2500; ++k) {
            const Cell cell = {random.below(rows), random.below(columns)};
            grid.set(cell.row, cell.column, !grid.blocked(cell));
            planner.set(cell, grid.blocked(cell));
            if (k % 5 == 0) {
                start = {random.below(rows), random.below(columns)};
                planner.move(start);
            }
            cspace::search::Effort effort;
            const bool found = planner.replan(effort);
            if (grid.blocked(start) || grid.blocked(goal)) {
                CHECK(!found);
                continue;
            }
            GridQuery query;
            query.corners = rule;
            query.metric = rule == Corners::four ? Metric::manhattan : Metric::octile;
            find_way(grid, start, goal, query, scratch, answer);
            CHECK(found == answer.found);
            if (!found) continue;
            std::vector<Cell> cells;
            planner.way(cells);
            CHECK_NEAR(grid_search::sum_costs(cells, StepLength{}), answer.cost, 1e-9);
        }
    }
}
