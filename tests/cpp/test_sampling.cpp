// Sight through triangles against the shortest path, and planners that draw samples in worlds of whole
// numbers.
#include <random>

#include "check.hpp"
#include "cspace/navigation/any_angle/polyanya.hpp"
#include "cspace/navigation/sampling/prm.hpp"
#include "cspace/navigation/sampling/rrt.hpp"
#include "whole_worlds.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

double shortest(const PolygonWorld& world, Settled from, Settled to) {
    Polyanya polyanya(world.mesh());
    for (Settled* end : {&from, &to})
        for (Index& t : end->triangles) t = world.mesh().of_triangle[std::size_t(t)];
    return polyanya.solve(from.at, from.triangles, to.at, to.triangles).length;
}

bool sees(const PolygonWorld& world, const Settled& from, Point to) {
    for (const Index t : from.triangles)
        if (sampling::end_of_sight(world.space, {from.at, t}, to) != none) return true;
    return false;
}

}  // namespace

TEST(sight_is_a_shortest_path_that_is_straight) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 1500; ++trial) {
        const PolygonWorld world(whole_polygons(random, false));
        const bool is_whole = trial % 2 == 0;
        const auto draw = [&] {
            const double side = world.outlines.high.x, drawn = double(random()) / 4294967296.0;
            return is_whole ? std::round(2 * side * drawn) / 2 : side * drawn;
        };
        for (int q = 0; q < 20; ++q) {
            const Point a{draw(), draw()}, b{draw(), draw()};
            const Settled from = world.settle(a, 0), to = world.settle(b, 0);
            if (world.shared_component(from, to) == none) {
                CHECK(!sees(world, from, b) || !to.is_free());
                continue;
            }
            const bool is_straight = shortest(world, from, to) <= distance(a, b) * (1 + 1e-13);
            if (sees(world, from, b)) CHECK(is_straight);
            if (!is_whole) CHECK(sees(world, from, b) == is_straight);
        }
    }
}

TEST(ways_are_never_shorter_than_the_shortest) {
    std::mt19937 random(4);
    int found = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const PolygonWorld world(whole_polygons(random, false));
        const unsigned halves = unsigned(2 * world.outlines.high.x) + 1;
        const Point a{0.5 * double(random() % halves), 0.5 * double(random() % halves)};
        const Point b{0.5 * double(random() % halves), 0.5 * double(random() % halves)};
        const Settled from = world.settle(a, 0), to = world.settle(b, 0);
        const Index component = world.shared_component(from, to);
        if (component == none) continue;
        const sampling::Problem problem = sampling::problem_of(world, component, from, to);
        const double least = shortest(world, from, to);
        sampling::Growth growth{500, 1, 0.05, false, std::uint64_t(trial)};
        const Route tree = sampling::Tree(problem, growth, nullptr).solve().route;
        growth.is_optimal = true;
        const Route star = sampling::Tree(problem, growth, nullptr).solve().route;
        const auto on_roadmap = [&](std::int64_t neighbours) {
            const sampling::Roadmap made(world, {problem.component, 500, neighbours, 1});
            return sampling::RoadmapSearch(problem, made).solve(nullptr).route;
        };
        const Route roadmap = on_roadmap(0), nearest = on_roadmap(8);
        for (const Route& route : {tree, star, roadmap, nearest}) {
            if (route.status != Status::found) continue;
            ++found;
            CHECK(route.length >= least * (1 - 1e-14));
            CHECK(route.path.front() == a && route.path.back() == b);
        }
    }
    CHECK(found > 200);
}

TEST(the_nearest_are_found_among_buckets) {
    std::mt19937 random(5);
    cspace::search::Buckets buckets({0, 0}, {3, 1});
    std::vector<Point> all;
    std::vector<std::int32_t> found;
    const auto draw = [&] { return double(random()) / 4294967296.0; };
    for (int i = 0; i < 600; ++i) {
        const Point p{3 * draw(), draw()}, q{3 * draw(), draw()};
        buckets.add(p), all.push_back(p);
        double least = 1e300;
        std::size_t within = 0;
        for (const Point& x : all) least = std::min(least, distance(x, q)), within += distance(x, q) <= 0.2;
        CHECK(distance(buckets.point(buckets.nearest(q)), q) == least);
        buckets.within(q, 0.2, found);
        CHECK(found.size() == within);
        buckets.nearest(q, 5, found);
        CHECK(found.size() == std::min<std::size_t>(5, all.size()));
        CHECK(distance(buckets.point(found.front()), q) == least);
    }
}
