// How near paths come to walls and to blocked cells, beside every pair of places on them.
#include "check.hpp"
#include "cspace/maps/path_clearance.hpp"

using namespace cspace;
using namespace cspace::maps;

namespace {

BitGrid grid_with(int rows, int columns, std::vector<Cell> cells) {
    BitGrid grid(rows, columns);
    for (const Cell c : cells) grid.set(c.row, c.column, true);
    return grid;
}

}  // namespace

TEST(cells_are_squares) {
    const BitGrid grid = grid_with(200, 300, {{100, 150}});
    const GridFrame frame{0.5, {-10, 20}};
    const auto at = [&](double x, double y) { return Point{-10 + 0.5 * x, 20 + 0.5 * y}; };
    const Point beside[] = {at(140, 90), at(140, 110)};
    CHECK_NEAR(path_clearance(beside, grid, frame), 5, 1e-12);
    const Point corner[] = {at(141, 99), at(149, 91)};  // x + y = 240, the corner (150, 100)
    CHECK_NEAR(path_clearance(corner, grid, frame), 0.5 * 10 / std::sqrt(2.0), 1e-12);
    const Point border[] = {at(20, 100), at(20, 100)};
    CHECK_NEAR(path_clearance(border, grid, frame), 10, 1e-12);
    const Point touching[] = {at(140, 101), at(160, 101)};
    CHECK(path_clearance(touching, grid, frame) == 0);
    const Point through[] = {at(149, 99), at(152, 102)};
    CHECK(path_clearance(through, grid, frame) == 0);
    const Point inside[] = {at(150.4, 100.4), at(150.6, 100.6)};
    CHECK(path_clearance(inside, grid, frame) == 0);
}

TEST(a_far_cell_is_found_by_a_long_path) {
    const BitGrid grid = grid_with(1000, 4000, {{500, 3000}, {100, 20}});
    const Point path[] = {{100, 480}, {3900, 480}};
    CHECK_NEAR(path_clearance(path, grid, {1, {0, 0}}), 20, 1e-12);
}

TEST(walls_are_segments) {
    Boundary box{{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {4, 4}, {4, 6}, {6, 6}, {6, 4}},
                 {1, 2, 3, 0, 5, 6, 7, 4},
                 {0, 0, 0, 0, 1, 1, 1, 1},
                 {0, 0}};
    const Point past[] = {{1, 5}, {5, 1}};
    CHECK_NEAR(path_clearance(past, box), 1, 1e-15);  // of the border; the corner (4, 4) is √2 away
    const Point near[] = {{2, 5}, {5, 2}};
    CHECK_NEAR(path_clearance(near, box), std::sqrt(0.5), 1e-15);
    const Point touching[] = {{3, 5}, {5, 3}};
    CHECK(path_clearance(touching, box) == 0);
    const Point through[] = {{3, 5.5}, {7, 4.5}};
    CHECK(path_clearance(through, box) == 0);
    const Point one[] = {{2, 5}};
    CHECK(path_clearance(one, box) == 2);
    CHECK(path_clearance(std::span<const Point>{}, box) == std::numeric_limits<double>::infinity());
}
