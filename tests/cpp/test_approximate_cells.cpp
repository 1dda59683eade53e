// A quadtree: its leaves tile the square around the world, free ones lie in free space, and what its search
// says agrees with what is connected.
#include <random>

#include "check.hpp"
#include "cspace/navigation/cells/approximate_cells.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

void check_tree(const PolygonWorld& world, const Quadtree& tree) {
    double area = 0;
    for (Index c = 0; c < Index(tree.cells().size()); ++c) {
        if (!tree.is_leaf(c)) continue;
        const double side = tree.side(tree[c].level);
        area += side * side;
        if (tree[c].kind != QuadCell::free) continue;
        const Point a = tree.low(tree[c]), b = tree.high(tree[c]);
        for (int k = 0; k < 9; ++k) {
            const Point p{a.x + 0.5 * (k % 3) * (b.x - a.x), a.y + 0.5 * int(k / 3) * (b.y - a.y)};
            CHECK(world.settle(p, 0).is_free());
        }
    }
    CHECK_NEAR(area, tree.side(0) * tree.side(0), 1e-9 * area);
}

int verdicts[4];

void check_world(const Outlines& outlines, std::mt19937& random, bool uniform) {
    const PolygonWorld world(outlines);
    CellOptions options;
    options.depth = 2 + int(random() % 3), options.most_depth = uniform ? 5 : 8;
    options.uniform = uniform, options.manhattan = uniform;
    check_tree(world, ApproximateCells(world, options).tree());
    CellStages kept;
    for (int query = 0; query < 6; ++query) {
        const auto draw = [&](double high) { return 0.25 * double(random() % unsigned(1 + 4 * high)); };
        const Point a{draw(outlines.high.x), draw(outlines.high.y)};
        const Point b{draw(outlines.high.x), draw(outlines.high.y)};
        const Settled from = world.settle(a, 0), to = world.settle(b, 0);
        if (!from.is_free() || !to.is_free()) continue;
        const bool connected = world.shared_component(from, to) != none;
        const Route route = ApproximateCells(world, options).solve(a, b).route;
        const Route again = ApproximateCells(world, options, nullptr, &kept).solve(a, b).route;
        CHECK(again.status == route.status && again.path == route.path);
        ++verdicts[int(route.status)];
        CHECK(route.status != Status::found || connected);
        CHECK(route.status != Status::unreachable || !connected);
        if (route.status != Status::found) continue;
        CHECK(route.path.front() == a && route.path.back() == b);
        CHECK(route.length >= distance(a, b) * (1 - 1e-12));
    }
}

}  // namespace

TEST(an_empty_world_is_one_leaf) {
    Outlines outlines;
    outlines.high = {3, 3};
    const PolygonWorld world(outlines);
    const CellRoute answer = ApproximateCells(world, {}).solve({0, 0}, {3, 3});
    CHECK(answer.leaves[0] == 1 && answer.leaves[1] == 0 && answer.leaves[2] == 0);
    CHECK_NEAR(answer.route.length, std::sqrt(18.0), 1e-12);
}

TEST(corners_that_touch_are_no_doors) {
    Outlines outlines;
    outlines.high = {4, 4};
    const Point one[4] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}}, other[4] = {{2, 2}, {4, 2}, {4, 4}, {2, 4}};
    outlines.add_ring(one, 0);
    outlines.add_ring(other, 1);
    const PolygonWorld world(outlines);
    CHECK(ApproximateCells(world, {}).solve({1, 3}, {3, 1}).route.status == Status::unreachable);
}

TEST(a_wall_along_a_line_of_the_tree_is_a_wall) {
    for (const double end : {4.0, 3.0}) {
        Outlines outlines;
        outlines.high = {4, 4};
        const Point wall[2] = {{2, 0}, {2, end}};
        outlines.add_ring(wall, 0);
        const PolygonWorld world(outlines);
        const Route route = ApproximateCells(world, {}).solve({1, 1}, {3, 1}).route;
        CHECK(route.status == (end == 4 ? Status::unreachable : Status::found));
        for (const Point p : route.path) CHECK(p.x != 2 || p.y > 3);
    }
}

TEST(worlds_of_whole_numbers) {
    std::mt19937 random(21);
    for (int trial = 0; trial < 400; ++trial) {
        Outlines world;
        const int side = 3 + int(random() % 8);
        world.high = {double(side), double(trial % 3 ? side : 2 * side)};
        const int obstacles = 1 + int(random() % 6);
        for (int o = 0; o < obstacles; ++o) {
            std::vector<Point> ring;
            const int corners = trial % 5 == 0 ? 2 : 3 + int(random() % 3);
            for (int i = 0; i < corners; ++i)
                ring.push_back(
                    {double(random() % unsigned(side + 1)), double(random() % unsigned(side + 1))});
            world.add_ring(ring, o);
        }
        check_world(world, random, trial % 4 == 0);
    }
    CHECK(verdicts[0] > 500 && verdicts[1] > 20 && verdicts[2] > 10);
}
