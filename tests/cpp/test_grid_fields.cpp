#include <algorithm>
#include <cmath>
#include <vector>

#include "check.hpp"
#include "cspace/navigation/fields/fast_marching.hpp"
#include "cspace/navigation/fields/potential_search.hpp"
#include "cspace/navigation/grid/search.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

BitGrid random_grid(check::Random& random) {
    BitGrid grid(1 + random.below(20), 1 + random.below(20));
    const double share = random.uniform(0, 0.5);
    for (int r = 0; r < grid.rows(); ++r)
        for (int c = 0; c < grid.columns(); ++c)
            if (random.uniform(0, 1) < share) grid.set(r, c, true);
    grid.set(random.below(grid.rows()), random.below(grid.columns()), false);
    return grid;
}
Cell random_free(check::Random& random, const BitGrid& grid) {
    for (;;) {
        const Cell cell = {random.below(grid.rows()), random.below(grid.columns())};
        if (!grid.blocked(cell)) return cell;
    }
}

}  // namespace

TEST(exact_and_bounded_searches_keep_to_the_shortest_way) {
    check::Random random{1};
    for (int k = 0; k < 400; ++k) {
        const BitGrid grid = random_grid(random);
        const Clearance clearance = make_clearance(grid);
        const Cell start = random_free(random, grid), goal = random_free(random, grid);
        const Corners corners = static_cast<Corners>(random.below(4));
        GridScratch scratch;
        GridAnswer shortest;
        GridQuery query;
        query.corners = corners;
        query.h_weight = 0;
        find_way(grid, start, goal, query, scratch, shortest);
        const double gain = random.uniform(0, 5), weight = random.uniform(1, 4);
        for (const bool is_greedy : {false, true})
            for (const double most : {1.0, weight}) {
                GridAnswer answer;
                const PotentialGains order{gain,     random.uniform(0.1, 4), 100, random.uniform(0, 3), most,
                                           is_greedy};
                find_by_potential(grid, clearance, order, corners, start, goal, answer);
                CHECK(answer.found == shortest.found);
                if (!answer.found || is_greedy) continue;
                const double length = grid_search::sum_costs(answer.cells, StepLength{});
                CHECK(length <= most * shortest.cost + 1e-9 && length >= shortest.cost - 1e-9);
            }
    }
}

TEST(a_front_comes_where_cells_join_and_its_way_leads_down) {
    check::Random random{2};
    for (int k = 0; k < 400; ++k) {
        const BitGrid grid = random_grid(random);
        const Clearance clearance = make_clearance(grid);
        const Cell start = random_free(random, grid), goal = random_free(random, grid);
        GridScratch scratch;
        GridAnswer shortest;
        GridQuery query;
        query.corners = Corners::four;
        query.metric = Metric::manhattan;
        find_way(grid, start, goal, query, scratch, shortest);
        const GridFrame frame;
        const MarchAnswer answer = march_front(grid, frame, &clearance, k % 2 ? 2.0 : 0.0,
                                               frame.center(start), start, frame.center(goal), goal, nullptr);
        CHECK((answer.route.status == Status::found) == shortest.found);
        if (!shortest.found) continue;
        CHECK(answer.route.path.front() == frame.center(start) &&
              answer.route.path.back() == frame.center(goal));
        if (k % 2 == 0) CHECK(answer.time <= shortest.cost + 1e-9);
        for (const Point p : answer.route.path) {
            Cell cell{};
            CHECK(frame.locate(grid, p, cell) == CellState::free);
        }
    }
}
