// Nothing that a robot sees lies behind its skyline, and much that it does not see does.
#include "check.hpp"
#include "cspace/navigation/bugs/range_robot.hpp"
#include "plane_worlds.hpp"

using namespace cspace;
using namespace cspace::navigation;
using check::Family;
using check::Random;

TEST(what_a_skyline_hides_is_not_seen) {
    constexpr double far = std::numeric_limits<double>::infinity();
    long hidden = 0, unseen = 0;
    for (int family = 0; family < int(Family::count); ++family)
        for (int number = 0; number < 12; ++number) {
            Random random{std::uint64_t(number) * 1000003 + std::uint64_t(family)};
            const auto world = check::random_world(random, Family(family), 4 + 2 * number);
            const Walls walls(world.boundary(random.below(2)));
            Skyline skyline;
            for (int k = 0; k < 10; ++k) {
                const Point from = check::random_point(world, random);
                if (world.parts_at(from).empty()) continue;
                RangeRobot robot(walls, from, far);
                for (std::size_t side = 0; side < robot.sides(); ++side) {
                    robot.stand(side);
                    skyline.look(walls, from);
                    for (int wall = 0; wall < walls.size(); ++wall) {
                        const double away = distance(from, walls.begin(wall));
                        const bool sees = robot.sees(walls.begin(wall)) >= away;
                        if (skyline.hides_corner(wall)) CHECK(!sees);
                        hidden += skyline.hides_corner(wall);
                        unseen += !sees;
                    }
                }
            }
        }
    std::printf("     %ld of %ld unseen corners hidden\n", hidden, unseen);
    CHECK(hidden > unseen / 4);
}
