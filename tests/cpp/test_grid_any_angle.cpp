// Shortest paths over grids, through runs of free cells that are read from the bits: as long as those through
// the polygons of the same cells.
#include <random>

#include "check.hpp"
#include "cspace/maps/grid_outlines.hpp"
#include "cspace/maps/polygon_world.hpp"
#include "cspace/navigation/any_angle/grid_any_angle.hpp"

using namespace cspace;
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

struct Both {
    const BitGrid& grid;
    PolygonWorld world;
    Polyanya polygons;
    GridAnyAngle runs;

    explicit Both(const BitGrid& grid)
        : grid(grid), world(outlines_of(grid)), polygons(world.mesh()), runs(grid, {}) {}

    Route by_polygons(Point a, Point b) {
        Settled start = world.settle(a, 0), goal = world.settle(b, 0);
        Route route;
        route.status = Status::unreachable;
        if (world.shared_component(start, goal) == none) return route;
        for (Settled* end : {&start, &goal})
            for (Index& t : end->triangles) t = world.mesh().of_triangle[std::size_t(t)];
        return polygons.solve(a, start.triangles, b, goal.triangles);
    }
    void compare(Point a, Point b) {
        const SettledInRuns from = runs.settle(a), to = runs.settle(b);
        CHECK(from.runs.empty() == !world.settle(a, 0).is_free());
        if (from.runs.empty() || to.runs.empty() || !world.settle(b, 0).is_free()) return;
        const Route one = runs.solve(a, from, b, to), other = by_polygons(a, b);
        CHECK(one.status == other.status);
        if (one.status != Status::found) return;
        CHECK_NEAR(one.length, other.length, 1e-12 * (1 + other.length));
        CHECK(one.path.front() == a && one.path.back() == b);
    }
};

void compare(const BitGrid& grid, std::mt19937& random, int queries) {
    Both both(grid);
    for (int q = 0; q < queries; ++q) {
        const unsigned parts = q % 3 == 0 ? 1 : q % 3 == 1 ? 2 : 1000003;
        const auto draw = [&](int size) {
            return double(random() % unsigned(std::int64_t(size) * parts + 1)) / double(parts);
        };
        const Point a{draw(grid.columns()), draw(grid.rows())};
        both.compare(a, {draw(grid.columns()), draw(grid.rows())});
    }
}

}  // namespace

TEST(small_grids_of_any_density) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 4000; ++trial)
        compare(random_grid(random, 1 + int(random() % 9), 1 + int(random() % 9), unsigned(random() % 60)),
                random, 20);
}

TEST(grids_wider_than_words) {
    std::mt19937 random(2);
    for (const int columns : {62, 63, 64, 65, 126, 127, 128, 200})
        for (int trial = 0; trial < 6; ++trial)
            compare(random_grid(random, 1 + int(random() % 20), columns, unsigned(random() % 45)), random,
                    30);
}

TEST(large_grids_and_few_obstacles) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 12; ++trial) {
        BitGrid grid(150, 170);
        for (int boxes = 0; boxes < 25; ++boxes) {
            const int row = int(random() % 140), column = int(random() % 160);
            const int high = 1 + int(random() % 20), wide = 1 + int(random() % 20);
            for (int r = row; r < std::min(150, row + high); ++r)
                for (int c = column; c < std::min(170, column + wide); ++c) grid.set(r, c, true);
        }
        compare(grid, random, 60);
    }
}

TEST(obstacles_that_meet_in_a_point_let_nothing_through) {
    BitGrid grid(2, 2);
    grid.set(0, 1, true);
    grid.set(1, 0, true);
    Both both(grid);
    const auto from = both.runs.settle({0.5, 0.5}), to = both.runs.settle({1.5, 1.5});
    CHECK(both.runs.solve({0.5, 0.5}, from, {1.5, 1.5}, to).status == Status::unreachable);
    CHECK(both.runs.settle({1, 1}).runs.size() == 2);
}

TEST(metres_and_ends_that_rounding_has_moved) {
    BitGrid grid(40, 40);
    for (int row = 0; row < 39; ++row) grid.set(row, 20, true);
    GridAnyAngle runs(grid, {0.05, {-3.0, 0.1}});
    const auto at = [](double column, double row) { return Point{-3.0 + 0.05 * column, 0.1 + 0.05 * row}; };
    const Point a = at(20, 7), b = at(21, 7);  // on either side of the wall
    const auto from = runs.settle(a), to = runs.settle(b);
    CHECK(from.runs.size() == 2 && to.runs.size() == 2);
    const Route route = runs.solve(a, from, b, to);
    CHECK_NEAR(route.length, 0.05 * 65, 1e-13);
    CHECK(route.path.front() == a && route.path.back() == b && route.path.size() == 4);
    CHECK(runs.settle(at(20 + 1e-10, 7.5)).runs.size() == 1);
    CHECK(runs.settle(at(20.01, 7.5)).runs.empty());
    CHECK(runs.settle(at(41, 7.5)).runs.empty());
}

// Obstacles in a pattern have many ways of one length. Each is looked at once, so that what is looked through
// grows with the map and not with the number of ways.
TEST(many_ways_of_one_length) {
    for (const int size : {20, 40, 80}) {
        BitGrid grid(size, size);
        for (int row = 0; row < size; ++row)
            for (int column = 0; column < size; ++column)
                grid.set(row, column, row && row < size - 1 && (row + 2 * column) % 5 == 0);
        Both both(grid);
        both.compare({0.5, 0.5}, {size - 0.5, size - 0.5});
        const Point start{0.5, 0.5}, goal{size - 0.5, size - 0.5};
        const Route route = both.runs.solve(start, both.runs.settle(start), goal, both.runs.settle(goal));
        CHECK(route.status == Status::found);
        CHECK(route.stats.nodes < 2 * size * size);
    }
}
