// The shortest path, found in two ways that share the triangulation alone: through intervals of convex
// polygons, and over the visibility graph. They agree in worlds of whole numbers, where obstacles touch,
// overlap and stand in line.
#include <random>

#include "check.hpp"
#include "cspace/navigation/any_angle/polyanya.hpp"
#include "cspace/navigation/visibility/search.hpp"
#include "whole_worlds.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

struct Shortest {
    PolygonWorld world;
    VisibilityGraph graph;
    VisibilitySearch search;
    Polyanya polyanya;

    explicit Shortest(Outlines outlines)
        : world(std::move(outlines)),
          graph(world.space),
          search(graph, world.space),
          polyanya(world.mesh()) {}

    // Both answers, or the one verdict that no path exists.
    std::pair<Route, Route> solve(Point a, Point b) {
        Settled start = world.settle(a, 0), goal = world.settle(b, 0);
        if (world.shared_component(start, goal) == none) return {};
        const Route by_graph = search.solve(start, goal);
        for (Settled* end : {&start, &goal})
            for (Index& t : end->triangles) t = world.mesh().of_triangle[std::size_t(t)];
        return {polyanya.solve(a, start.triangles, b, goal.triangles), by_graph};
    }
};

void compare(Outlines outlines, std::mt19937& random, int queries, double step) {
    const Point low = outlines.low, high = outlines.high;
    Shortest both(std::move(outlines));
    const auto draw = [&](double from, double to) {
        return from + step * double(random() % unsigned(1 + (to - from) / step));
    };
    for (int q = 0; q < queries; ++q) {
        const Point a{draw(low.x, high.x), draw(low.y, high.y)}, b{draw(low.x, high.x), draw(low.y, high.y)};
        const auto [one, other] = both.solve(a, b);
        CHECK(one.status == other.status);
        if (one.status != Status::found) continue;
        CHECK_NEAR(one.length, other.length, 1e-12 * (1 + one.length));
        CHECK(one.length >= distance(a, b) * (1 - 1e-15));
        CHECK_NEAR(one.length, length_of(one.path), 1e-12 * (1 + one.length));
        CHECK(one.path.front() == a && one.path.back() == b);
    }
}

}  // namespace

TEST(straight_where_nothing_is_in_the_way) {
    Shortest both({{}, {}, 0, {0, 0}, {10, 10}});
    const auto [one, other] = both.solve({1, 1}, {4, 5});
    CHECK(one.length == 5 && other.length == 5);
    CHECK(both.solve({3, 3}, {3, 3}).first.path.size() == 1);
}

TEST(around_a_box_along_its_walls) {
    Outlines world;
    world.high = {10, 10};
    const Point box[4] = {{4, 4}, {6, 4}, {6, 6}, {4, 6}};
    world.add_ring(box, 0);
    Shortest both(world);
    CHECK_NEAR(both.solve({3, 5}, {7, 5}).first.length, 2 + 2 * std::sqrt(2.0), 1e-15);
    CHECK_NEAR(both.solve({4, 5}, {6, 5}).second.length, 4, 1e-15);   // from wall to wall
    CHECK_NEAR(both.solve({4, 4}, {6, 6}).first.length, 4, 1e-15);    // from corner to corner
    CHECK_NEAR(both.solve({0, 4}, {10, 4}).first.length, 10, 1e-15);  // along a wall
}

TEST(worlds_of_whole_numbers) {
    std::mt19937 random(5);
    for (int trial = 0; trial < 3000; ++trial) {
        compare(whole_polygons(random, trial % 5 == 0), random, 20, trial % 2 ? 1 : 0.5);
    }
}

TEST(worlds_of_boxes_on_a_grid) {
    std::mt19937 random(6);
    for (int trial = 0; trial < 1000; ++trial) {
        compare(whole_boxes(random), random, 20, 0.5);
    }
}

TEST(large_and_far_away) {
    std::mt19937 random(9);
    for (const double far : {1e6, 1e9}) {
        for (int trial = 0; trial < 200; ++trial) {
            Outlines world;
            world.low = {far, -far}, world.high = {far + 64, -far + 64};
            for (int o = 0; o < 10; ++o) {
                const Point at{far + double(random() % 56), -far + double(random() % 56)};
                const Point ring[3] = {at, at + Point{double(1 + random() % 8), double(random() % 8)},
                                       at + Point{double(random() % 8), double(1 + random() % 8)}};
                world.add_ring(ring, o);
            }
            compare(world, random, 10, 0.25);
        }
    }
}
