// Voronoi Bug by scans with noise, in worlds whose answer is known: what it finds, that it walks where it
// can, and that it never says more than it knows.
#include <algorithm>
#include <cstdlib>

#include "check.hpp"
#include "cspace/navigation/bugs/scan_robot.hpp"
#include "cspace/navigation/bugs/voronoi_bug.hpp"
#include "plane_worlds.hpp"

using namespace cspace;
using namespace cspace::navigation;
using check::Family;
using check::PlaneWorld;
using check::Random;

static_assert(ClearanceSensor<ScanRobot>);

namespace {

constexpr double far = std::numeric_limits<double>::infinity();
const double ranges[] = {0.5, 2, far};  // in cells
const double noises[] = {0.01, 0.05};   // of the range, of two cells where there is none

struct Question {
    Walls walls;
    Point start, goal;
    double cell;
    bool reachable;
};

std::optional<Question> question(Family family, int number, int largest) {
    Random random{std::uint64_t(number) * 1000003 + std::uint64_t(family)};
    PlaneWorld world = check::random_world(random, family, largest);
    const Point start = check::random_point(world, random), goal = check::random_point(world, random);
    const std::vector<int> from = world.parts_at(start), to = world.parts_at(goal);
    if (from.empty() || to.empty()) return {};
    Walls walls(world.boundary(random.below(2)));
    const double cell = walls.extent() / std::max(world.columns, world.rows);
    return Question{std::move(walls), start, goal, cell, world.connected(start, goal)};
}

Exploration walk(const Question& q, double range, double noise, std::uint64_t seed) {
    return voronoi_bug(q.walls, q.start, q.goal, range * q.cell,
                       Noise{noise * std::min(range, 2.0) * q.cell, seed});
}

}  // namespace

TEST(most_goals_are_found_and_none_is_called_unreachable) {
    int reachable = 0, found = 0;
    for (int family = 0; family < int(Family::count); ++family)
        for (int number = 0; number < 6; ++number) {
            const auto q = question(Family(family), number, 5);
            if (!q) continue;
            for (const double range : ranges)
                for (const double noise : noises) {
                    const Exploration trip = walk(*q, range, noise, std::uint64_t(number));
                    const bool arrived = trip.route.status == Status::found;
                    CHECK(trip.route.status != Status::unreachable);
                    CHECK(trip.scans > 0 || q->start == q->goal);
                    CHECK(trip.route.path.front() == q->start);
                    if (arrived) CHECK(trip.route.path.back() == q->goal);
                    if (arrived && can_walk(q->walls, trip.route.path)) CHECK(q->reachable);
                    reachable += q->reachable;
                    found += q->reachable && arrived;
                }
        }
    std::printf("     %d of %d reachable goals found\n", found, reachable);
    CHECK(reachable > 100);
    CHECK(found >= 0.95 * reachable);
}

TEST(the_same_seed_gives_the_same_walk) {
    int walked = 0, others = 0;
    for (int number = 0; number < 10; ++number) {
        const auto q = question(Family::maze, number, 5);
        if (!q) continue;
        const auto one = walk(*q, 2, 0.02, 7), two = walk(*q, 2, 0.02, 7), other = walk(*q, 2, 0.02, 8);
        CHECK(one.route.path == two.route.path);
        CHECK(one.scans == two.scans);
        ++walked;
        others += one.route.path != other.route.path;
    }
    CHECK(others > 0 && walked > 5);
}

TEST(readings_deviate_as_said_and_are_clipped) {
    maps::Boundary room;
    room.points = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    room.next = {1, 2, 3, 0};
    room.ring = {0, 0, 0, 0};
    const Walls walls(room);
    Scanner scanner(walls, 6, {0.1, 3});
    double sum = 0, squares = 0;
    constexpr int looks = 2000;
    for (int i = 0; i < looks; ++i) {
        Scan scan;
        scanner.look({4, 5}, scan);
        const double off = scan.reading[Scan::beams / 2] - 4;
        sum += off;
        squares += off * off;
        for (const double reading : scan.reading) CHECK(reading >= 0 && reading <= 6);
    }
    Scan scan;
    scanner.look({4, 5}, scan);
    CHECK_NEAR(sum / looks, 0, 4 * scan.deviation / std::sqrt(double(looks)));
    CHECK_NEAR(std::sqrt(squares / looks), scan.deviation, 0.1 * scan.deviation);
    // At the end of its range half of the readings are clipped: their mean is short by σ / √2π.
    scanner.look({6, 5}, scan);
    CHECK_NEAR(scan.reading[Scan::beams / 2], 6 - 0.1 / std::sqrt(2 * std::numbers::pi), 0.1);
}

TEST(the_end_of_a_wall_without_thickness_is_seen) {
    maps::Boundary room;
    room.points = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {2, 5}, {3, 5}};
    room.next = {1, 2, 3, 0, 5, 4};
    room.ring = {0, 0, 0, 0, 1, 1};
    const Walls walls(room);
    Scanner scanner(walls, 6, {0, 0});
    Scan scan;
    scanner.look({5, 5}, scan);
    CHECK_NEAR(scan.reading[Scan::beams / 2], 2, 1e-12);
    CHECK_NEAR(scan.reading[Scan::beams / 4], 5, 1e-3);
}
