#include <cmath>
#include <vector>

#include "check.hpp"
#include "cspace/maps/polygon_world.hpp"
#include "cspace/navigation/fields/descent.hpp"
#include "random.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

Outlines random_outlines(check::Random& random) {
    Outlines world;
    world.low = {0, 0}, world.high = {10, 10};
    const int count = random.below(15);
    for (int k = 0; k < count; ++k) {
        const Point at = {random.uniform(0, 10), random.uniform(0, 10)};
        const double size = random.uniform(0.1, 0.8), turn = random.uniform(0, 3);
        const int corners = 3 + random.below(5);
        std::vector<Point> ring;
        for (int i = 0; i < corners; ++i) {
            const double angle = turn + 6.283185307179586 * i / corners;
            ring.push_back(at + size * Point{std::cos(angle), std::sin(angle)});
        }
        world.add_ring(ring, k);
    }
    return world;
}

}  // namespace

TEST(descents_go_down_and_never_through_walls) {
    check::Random random{1};
    int found = 0;
    for (int k = 0; k < 200; ++k) {
        const PolygonWorld world(random_outlines(random));
        const auto pick = [&] {
            for (;;) {
                const Point p = {random.uniform(0, 10), random.uniform(0, 10)};
                if (world.settle(p, 1e-11).is_free()) return p;
            }
        };
        const double reach = random.uniform(0.1, 2);
        const NearWalls walls(world.walls, reach);
        const Gains gains{1, 0.25 * reach * reach * reach * reach, reach, reach};
        const Point start = pick(), goal = pick();
        const Potential potential(walls, gains, goal);
        const DescentRoute descent = DescentRun(walls, potential, 0.25 * reach, 10000).run(start, {});
        const auto& path = descent.route.path;
        CHECK(path.size() == descent.values.size());
        CHECK((descent.route.status == Status::found) == (descent.rest == Rest::goal));
        found += descent.rest == Rest::goal;
        for (std::size_t i = 1; i < path.size(); ++i) {
            CHECK(descent.values[i] <= descent.values[i - 1] + 1e-9 * (1 + std::abs(descent.values[i])) ||
                  descent.rest == Rest::goal);
            for (std::int32_t e = 0; e < std::int32_t(world.walls.size()); ++e) {
                const Point a = world.walls.begin(e), b = world.walls.end(e);
                CHECK(!(orientation(a, b, path[i - 1]) * orientation(a, b, path[i]) < 0 &&
                        orientation(path[i - 1], path[i], a) * orientation(path[i - 1], path[i], b) < 0));
            }
        }
    }
    CHECK(found > 100);
}

TEST(the_nearest_point_to_zero_of_a_hull) {
    CHECK(nearest_to_zero(std::vector<Point>{{1, 1}}) == (Point{1, 1}));
    CHECK_NEAR(norm(nearest_to_zero(std::vector<Point>{{1, 1}, {1, -1}})), 1, 1e-15);
    CHECK(nearest_to_zero(std::vector<Point>{{1, 1}, {-2, 1}, {0, -3}}) == (Point{0, 0}));
    CHECK_NEAR(norm(nearest_to_zero(std::vector<Point>{{2, 1}, {2, -1}, {5, 0}})), 2, 1e-15);
}
