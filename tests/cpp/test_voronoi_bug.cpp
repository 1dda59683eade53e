// Voronoi Bug in worlds whose answer is known: verdicts, paths and clearance, however far it sees.
#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "check.hpp"
#include "cspace/navigation/bugs/clearance_robot.hpp"
#include "cspace/navigation/bugs/voronoi_bug.hpp"
#include "plane_worlds.hpp"

using namespace cspace;
using namespace cspace::navigation;
using check::Family;
using check::PlaneWorld;
using check::Random;

static_assert(ClearanceSensor<ClearanceRobot>);

namespace {

bool is_clear(const PlaneWorld& world, const Walls& walls, const std::vector<Point>& path) {
    for (std::size_t i = 1; i < path.size(); ++i) {
        const Line step{path[i - 1], path[i]};
        for (int e = 0; e < walls.size(); ++e) {
            const Wall w = walls.wall(e);
            if (crossing_sign(step, w) != 0 &&
                orientation(w.begin, w.end, step.from) * orientation(w.begin, w.end, step.to) < 0)
                return false;
        }
        if (world.is_deep_in_wall(0.5 * (step.from + step.to), 1e-12 * walls.largest())) return false;
    }
    return true;
}

double distance_to_walls(const Walls& walls, Point p) {
    double least = std::numeric_limits<double>::infinity();
    for (int e = 0; e < walls.size(); ++e)
        least = std::min(least, distance(p, nearest_on(walls.begin(e), walls.end(e), p)));
    return least;
}

// Along the curves the robot is never nearer to a wall than the leg says.
bool keeps_clearance(const Walls& walls, const Exploration& trip) {
    for (const Leg& leg : trip.legs) {
        if (leg.move != Move::trace && leg.move != Move::roll) continue;
        for (std::size_t i = leg.first; i <= leg.last; ++i)
            if (distance_to_walls(walls, trip.route.path[i]) <
                leg.clearance * (1 - 1e-6) - 1e-9 * walls.extent())
                return false;
    }
    return true;
}

struct Tally {
    int total = 0, found = 0, unreachable = 0, undetermined = 0;
    double length = 0;
    std::vector<double> times;
};
constexpr int reaches = 6;
Tally tally[reaches];
const char* names[] = {"scattered", "thin walls", "mixed", "maze",    "spiral",
                       "comb",      "trap",       "rings", "chequers"};

int stress(int most) {
    const char* more = std::getenv("CSPACE_STRESS");
    return more ? most * std::atoi(more) : most;
}

void judge(const PlaneWorld& world, const Walls& walls, Point start, Point goal, const char* name,
           int number) {
    const bool expected = world.connected(start, goal);
    const double reach[reaches] = {1e-3 * walls.extent(),
                                   0.03 * walls.extent(),
                                   0.1 * walls.extent(),
                                   0.4 * walls.extent(),
                                   2.5,
                                   std::numeric_limits<double>::infinity()};
    const voronoi::Sites sites(walls.boundary());
    for (int k = 0; k < reaches; ++k) {
        const auto begin = std::chrono::steady_clock::now();
        const Exploration trip = voronoi_bug(walls, sites, start, goal, reach[k]);
        const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
        Tally& t = tally[k];
        t.times.push_back(time.count());
        ++t.total;
        const Status status = trip.route.status;
        t.found += status == Status::found;
        t.unreachable += status == Status::unreachable;
        t.undetermined += status == Status::undetermined;
        if (status == Status::found && start != goal) t.length += trip.route.length / distance(start, goal);
        const char* fault = nullptr;
        if (status == Status::undetermined)
            fault = nullptr;
        else if ((status == Status::found) != expected)
            fault = expected ? "missed" : "wrongly found";
        if (trip.route.path.front() != start || (status == Status::found && trip.route.path.back() != goal))
            fault = "ends";
        else if (!is_clear(world, walls, trip.route.path))
            fault = "path through a wall";
        else if (!keeps_clearance(walls, trip))
            fault = "clearance";
        if (!fault) continue;
        std::printf("range %g (%d), %s %d: %s\n", reach[k], k, name, number, fault);
        ++check::failures;
    }
}

void run_family(Family family, int count, int largest) {
    for (int number = 0; number < count && check::failures < 20; ++number) {
        Random random{std::uint64_t(number) * 1000003 + std::uint64_t(family)};
        PlaneWorld world = check::random_world(random, family, largest);
        Point start = check::random_point(world, random), goal = check::random_point(world, random);
        for (int tries = 0; tries < 20 && world.parts_at(start).empty(); ++tries)
            start = check::random_point(world, random);
        if (world.parts_at(start).empty()) continue;
        if (world.parts_at(goal).empty() && random.below(3)) goal = check::random_point(world, random);
        const Walls walls(world.boundary(random.below(2)));
        judge(world, walls, start, goal, names[int(family)], number);
    }
}

void show(const char* what) {
    for (int k = 0; k < reaches; ++k) {
        Tally& t = tally[k];
        std::sort(t.times.begin(), t.times.end());
        std::printf(
            "     %s, range %d: %d found, %d unreachable, %d undetermined; median %.1f µs, p95 %.1f µs, max "
            "%.0f; length %.3g\n",
            what, k, t.found, t.unreachable, t.undetermined, t.times[t.times.size() / 2],
            t.times[t.times.size() * 95 / 100], t.times.back(), t.length / std::max(t.found, 1));
        CHECK(t.undetermined * 50 <= t.total);
        t = {};
    }
}

}  // namespace

TEST(verdicts_in_small_degenerate_worlds) {
    for (int family = 0; family < int(Family::count); ++family) run_family(Family(family), stress(300), 5);
    show("small");
}

TEST(verdicts_in_larger_worlds) {
    for (int family = 0; family < int(Family::count); ++family) run_family(Family(family), stress(20), 16);
    show("large");
}
