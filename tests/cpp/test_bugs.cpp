// Bug 1 and Bug 2 in worlds whose answer is known: verdicts, bounds and paths.
#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "check.hpp"
#include "cspace/navigation/bugs/bug_1.hpp"
#include "cspace/navigation/bugs/bug_2.hpp"
#include "cspace/navigation/bugs/contact_robot.hpp"
#include "plane_worlds.hpp"

using namespace cspace;
using namespace cspace::navigation;
using check::Family;
using check::PlaneWorld;
using check::Random;

namespace {

struct Case {
    PlaneWorld world;
    Walls walls;
    Point start, goal;
    std::vector<double> perimeter;

    Case(PlaneWorld w, bool merge, Point start, Point goal)
        : world(std::move(w)), walls(world.boundary(merge)), start(start), goal(goal) {
        for (int e = 0; e < walls.size(); ++e) {
            if (walls.ring(e) >= int(perimeter.size())) perimeter.push_back(0);
            perimeter[std::size_t(walls.ring(e))] += distance(walls.begin(e), walls.end(e));
        }
    }
};

// How often the line from start to goal enters each ring.
std::vector<int> entries(const Case& c) {
    const Line m{c.start, c.goal};
    std::vector<int> count(c.perimeter.size(), 0);
    for (int e = 0; e < c.walls.size(); ++e) {
        const Wall w = c.walls.wall(e);
        const Point before = c.walls.begin(c.walls.previous(e));
        bool enters = crossing(m, w) == 1 && orientation(w.begin, w.end, m.from) >= 0 &&
                      orientation(w.begin, w.end, m.to) < 0;
        if (side_of(m, w.begin) == 0 && (w.begin == m.from || comes_after(m, m.from, w.begin)) &&
            comes_after(m, w.begin, m.to))
            enters = way_towards(before, w.begin, w.end, m.to) == Way::blocked &&
                     (w.begin == m.from || way_towards(before, w.begin, w.end, m.from) != Way::blocked);
        count[std::size_t(c.walls.ring(e))] += enters;
    }
    return count;
}

bool is_clear(const Case& c, const std::vector<Point>& path) {
    double size = 0;
    for (const Point& p : c.world.points) size = std::max({size, std::abs(p.x), std::abs(p.y)});
    for (std::size_t i = 1; i < path.size(); ++i) {
        const Line step{path[i - 1], path[i]};
        for (int e = 0; e < c.walls.size(); ++e) {
            const Wall w = c.walls.wall(e);
            if (crossing(step, w) != 0 &&
                orientation(w.begin, w.end, step.from) * orientation(w.begin, w.end, step.to) < 0)
                return false;
        }
        if (c.world.is_deep_in_wall(0.5 * (step.from + step.to), 1e-12 * size)) return false;
    }
    return true;
}

const char* fault_of(const Case& c, const Trip& trip, bool is_bug_1) {
    const bool expected = c.world.connected(c.start, c.goal);
    if (trip.route.status == Status::undetermined) return "undetermined";
    if ((trip.route.status == Status::found) != expected) return expected ? "missed" : "wrongly found";
    if (trip.route.path.front() != c.start) return "start";
    if (expected && trip.route.path.back() != c.goal) return "goal";
    if (!is_clear(c, trip.route.path)) return "path through a wall";
    double bound = distance(c.start, c.goal);
    std::vector<int> met(c.perimeter.size(), 0);
    for (const Follow& f : trip.follows) {
        const std::size_t ring = std::size_t(c.walls.ring(f.hit.in.name));
        ++met[ring];
        bound += (is_bug_1 ? 1.5 : 1.0) * c.perimeter[ring];
    }
    if (length_of(trip.route.path) > bound * (1 + 1e-12)) return "longer than the bound";
    const std::vector<int> n = entries(c);
    for (std::size_t ring = 0; ring < met.size(); ++ring) {
        if (is_bug_1 && met[ring] > 1) return "a ring met twice";
        if (!is_bug_1 && met[ring] > n[ring]) return "more hits than entries";
    }
    return nullptr;
}

int total = 0, reachable = 0;
std::vector<double> times[2];

void judge(const Case& c, const char* name, int number) {
    const bool expected = c.world.connected(c.start, c.goal);
    ++total;
    reachable += expected;
    for (int bug = 1; bug <= 2; ++bug)
        for (Hand hand : {Hand::left, Hand::right}) {
            const auto begin = std::chrono::steady_clock::now();
            ContactRobot robot(c.walls, c.start);
            const Trip trip = bug == 1 ? bug_1(robot, c.goal, hand) : bug_2(robot, c.goal, hand);
            const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
            times[bug - 1].push_back(time.count());
            const char* fault = fault_of(c, trip, bug == 1);
            if (!fault) continue;
            std::printf("bug %d, %s hand, %s %d: %s (%zu walls, %zu follows) S %.17g %.17g T %.17g %.17g\n",
                        bug, hand == Hand::left ? "left" : "right", name, number, fault,
                        std::size_t(c.walls.size()), trip.follows.size(), c.start.x, c.start.y, c.goal.x,
                        c.goal.y);
            ++check::failures;
        }
}

const char* names[] = {"scattered", "thin walls", "mixed", "maze",    "spiral",
                       "comb",      "trap",       "rings", "chequers"};

int stress(int most) {
    const char* more = std::getenv("CSPACE_STRESS");
    return more ? most * std::atoi(more) : most;
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
        judge(Case(std::move(world), random.below(2), start, goal), names[int(family)], number);
    }
}

}  // namespace

TEST(verdicts_and_bounds_in_small_degenerate_worlds) {
    for (int family = 0; family < int(Family::count); ++family) run_family(Family(family), stress(1000), 5);
}

TEST(verdicts_and_bounds_in_larger_worlds) {
    for (int family = 0; family < int(Family::count); ++family) run_family(Family(family), stress(60), 16);
    for (int bug = 0; bug < 2; ++bug) {
        std::vector<double>& t = times[bug];
        std::sort(t.begin(), t.end());
        std::printf("     bug %d: median %.1f µs, p95 %.1f µs, largest %.0f µs\n", bug + 1, t[t.size() / 2],
                    t[t.size() * 95 / 100], t.back());
    }
    std::printf("     %d problems, %d of them with a way\n", total, reachable);
}
