// Trapezoids: no more than three per corner, they fill free space, and what they connect is what is
// connected.
#include <random>

#include "check.hpp"
#include "cspace/navigation/cells/exact_cells.hpp"
#include "cspace/navigation/visibility/search.hpp"
#include "whole_worlds.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

double area_of(const Trapezoids& all) {
    double sum = 0;
    for (const Trapezoid& c : all.cells) {
        const double l = all.wall(c.top).y_at(c.left.x) - all.wall(c.bottom).y_at(c.left.x);
        const double r = all.wall(c.top).y_at(c.right.x) - all.wall(c.bottom).y_at(c.right.x);
        sum += 0.5 * (l + r) * (c.right.x - c.left.x);
    }
    return sum;
}

void check_world(const Outlines& outlines, std::mt19937& random, int queries) {
    const PolygonWorld world(outlines);
    const ExactCells exact(world);
    const VisibilityGraph graph(world.space);
    VisibilitySearch shortest(graph, world.space);
    std::set<std::pair<double, double>> corners;
    double area = 0;
    for (Index e = 0; e < Index(world.walls.size()); ++e) {
        corners.insert({world.walls.begin(e).x, world.walls.begin(e).y});
        area += 0.5 * cross(world.walls.begin(e) - outlines.low, world.walls.end(e) - outlines.low);
    }
    CHECK(exact.cells().cells.size() <= 3 * corners.size() + 1);
    CHECK_NEAR(area_of(exact.cells()), area, 1e-9 * (1 + area));
    for (int q = 0; q < queries; ++q) {
        const auto draw = [&](double low, double high) {
            return low + 0.5 * double(random() % unsigned(1 + 2 * (high - low)));
        };
        const Point a{draw(outlines.low.x, outlines.high.x), draw(outlines.low.y, outlines.high.y)};
        const Point b{draw(outlines.low.x, outlines.high.x), draw(outlines.low.y, outlines.high.y)};
        const Settled start = world.settle(a, 0), goal = world.settle(b, 0);
        if (!start.is_free() || !goal.is_free()) continue;
        const Route route = exact.solve(a, b);
        const bool connected = world.shared_component(start, goal) != none;
        CHECK((route.status == Status::found) == connected);
        if (!connected || route.status != Status::found) continue;
        const Route best = shortest.solve(start, goal);
        CHECK(route.length >= best.length * (1 - 1e-12));
        CHECK(route.path.front() == a && route.path.back() == b);
        for (std::size_t i = 1; i + 1 < route.path.size(); ++i)
            CHECK(corners.count({route.path[i].x, route.path[i].y}) == 1);
        for (std::size_t i = 1; i < route.path.size();
             ++i) {  // each leg is free: nothing shorter than itself leads along
            const Settled from = world.settle(route.path[i - 1], 0), to = world.settle(route.path[i], 0);
            CHECK(from.is_free() && to.is_free());
            if (from.is_free() && to.is_free() && world.shared_component(from, to) != none)
                CHECK_NEAR(shortest.solve(from, to).length, distance(from.at, to.at),
                           1e-12 * (1 + route.length));
        }
    }
}

}  // namespace

TEST(a_box_makes_four_cells) {
    Outlines outlines;
    outlines.high = {10, 10};
    const Point box[4] = {{4, 4}, {6, 4}, {6, 6}, {4, 6}};
    outlines.add_ring(box, 0);
    const PolygonWorld world(outlines);
    std::size_t wide = 0;
    const ExactCells exact(world);
    for (const Trapezoid& c : exact.cells().cells) wide += c.left.x < c.right.x;
    CHECK(wide == 4);
    CHECK_NEAR(exact.solve({5, 1}, {5, 9}).length, 2 * std::sqrt(10.0) + 2, 1e-12);
}

TEST(worlds_of_whole_numbers) {
    std::mt19937 random(11);
    for (int trial = 0; trial < 3000; ++trial) {
        check_world(whole_polygons(random, trial % 5 == 0), random, 10);
    }
}

TEST(worlds_of_boxes) {
    std::mt19937 random(12);
    for (int trial = 0; trial < 1000; ++trial) {
        check_world(whole_boxes(random), random, 10);
    }
}
