// The connected parts of free cells, against a flood.
#include <random>

#include "check.hpp"
#include "cspace/maps/grid_parts.hpp"
#include "cspace/navigation/grid/search.hpp"

using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

BitGrid random_grid(std::mt19937& random, int rows, int columns, unsigned percent) {
    BitGrid grid(rows, columns);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            if (random() % 100 < percent) grid.set(row, column, true);
    return grid;
}

// The part of each cell by flooding from cell to cell, and the size of each part.
struct Flooded {
    std::vector<int> part;
    std::vector<int> cells;

    Flooded(const BitGrid& grid, bool diagonal) : part(std::size_t(grid.rows() * grid.columns()), -1) {
        for (int seed = 0; seed < int(part.size()); ++seed) {
            std::vector<int> open;
            const auto take = [&](int row, int column) {
                if (!grid.contains({row, column}) || grid.blocked(row, column)) return;
                int& at = part[std::size_t(row * grid.columns() + column)];
                if (at >= 0) return;
                at = int(cells.size()) - 1;
                ++cells.back();
                open.push_back(row * grid.columns() + column);
            };
            const int row = seed / grid.columns(), column = seed % grid.columns();
            if (grid.blocked(row, column) || part[std::size_t(seed)] >= 0) continue;
            cells.push_back(0);
            take(row, column);
            while (!open.empty()) {
                const int r = open.back() / grid.columns(), c = open.back() % grid.columns();
                open.pop_back();
                for (int down = -1; down <= 1; ++down)
                    for (int along = -1; along <= 1; ++along)
                        if (diagonal || down == 0 || along == 0) take(r + down, c + along);
            }
        }
    }
};

}  // namespace

TEST(parts_are_those_of_a_flood) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 600; ++trial) {
        const int columns = trial % 3 ? 1 + int(random() % 30) : 60 + int(random() % 80);
        const BitGrid grid = random_grid(random, 1 + int(random() % 30), columns, unsigned(random() % 90));
        for (const bool diagonal : {false, true}) {
            const GridParts parts(grid, diagonal);
            const Flooded flooded(grid, diagonal);
            CHECK(parts.count() == std::int64_t(flooded.cells.size()));
            std::vector<int> sizes = flooded.cells;
            std::sort(sizes.rbegin(), sizes.rend());
            const int third = sizes.size() > 3 ? sizes[3] : 0;
            for (int k = 0; k < 200; ++k) {
                const Cell a{int(random() % unsigned(grid.rows())), int(random() % unsigned(columns))};
                const Cell b{int(random() % unsigned(grid.rows())), int(random() % unsigned(columns))};
                if (grid.blocked(a) || grid.blocked(b)) continue;
                const int x = flooded.part[std::size_t(a.row * columns + a.column)],
                          y = flooded.part[std::size_t(b.row * columns + b.column)];
                if (x == y)
                    CHECK(!parts.divide(a, b));
                else if (flooded.cells[std::size_t(x)] > third || flooded.cells[std::size_t(y)] > third)
                    CHECK(parts.divide(a, b));
            }
        }
    }
}

TEST(a_goal_that_is_shut_in_is_told_without_a_flood) {
    BitGrid grid(700, 900);
    for (int k = 300; k < 400; ++k) grid.set(k, 300, true), grid.set(k, 399, true);
    for (int k = 300; k < 400; ++k) grid.set(300, k, true), grid.set(399, k, true);
    LazyParts parts;
    GridScratch scratch;
    for (const GridPlanner planner : {GridPlanner::best_first, GridPlanner::jump_points,
                                      GridPlanner::theta_star, GridPlanner::waves, GridPlanner::focal})
        for (const Corners rule : {Corners::never, Corners::one, Corners::always, Corners::four}) {
            GridQuery query;
            query.planner = planner;
            query.corners = rule;
            if (rule == Corners::four) query.metric = Metric::manhattan;
            GridAnswer answer;
            find_way(grid, {5, 5}, {350, 350}, query, scratch, answer, &parts);
            CHECK(!answer.found);
            CHECK(answer.effort.settled <= grid.numbers() / 64);
            const bool both_large = planner == GridPlanner::jump_points && answer.parts == 0;
            CHECK(answer.parts == 2 || both_large);
            find_way(grid, {5, 5}, {690, 890}, query, scratch, answer, &parts);
            CHECK(answer.found && answer.parts == 0);
        }
    CHECK(parts.is_made(false) && parts.is_made(true));
    CHECK(parts.bytes() <= std::size_t(700) * 900 * 5 / 8);
}

TEST(a_search_that_pauses_finds_what_one_without_finds) {
    std::mt19937 random(2);
    const BitGrid grid = random_grid(random, 300, 300, 38);
    GridScratch scratch;
    int found = 0;
    for (int k = 0; k < 60; ++k) {
        const auto draw = [&] { return Cell{int(random() % 300), int(random() % 300)}; };
        const Cell a = draw(), b = draw();
        if (grid.blocked(a) || grid.blocked(b)) continue;
        GridQuery query;
        query.corners = k % 2 ? Corners::always : Corners::never;
        query.planner = k % 4 < 2 ? GridPlanner::best_first : GridPlanner::jump_points;
        LazyParts parts;
        GridAnswer with, without;
        find_way(grid, a, b, query, scratch, with, &parts);
        find_way(grid, a, b, query, scratch, without);
        CHECK(with.found == without.found && with.cost == without.cost);
        found += with.found;
    }
    CHECK(found > 5);
}
