// Bug 1, Bug 2 and Tangent Bug in worlds whose answer is known: verdicts, bounds and paths.
#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "check.hpp"
#include "cspace/navigation/bugs/bug_1.hpp"
#include "cspace/navigation/bugs/bug_2.hpp"
#include "cspace/navigation/bugs/contact_robot.hpp"
#include "cspace/navigation/bugs/range_robot.hpp"
#include "cspace/navigation/bugs/tangent_bug.hpp"
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
        bool enters = crossing_sign(m, w) == 1 && orientation(w.begin, w.end, m.from) >= 0 &&
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
            if (crossing_sign(step, w) != 0 &&
                orientation(w.begin, w.end, step.from) * orientation(w.begin, w.end, step.to) < 0)
                return false;
        }
        if (c.world.is_deep_in_wall(0.5 * (step.from + step.to), 1e-12 * size)) return false;
    }
    return true;
}

const char* fault_of(const Case& c, const WalkLog& log, bool is_bug_1) {
    const bool expected = c.world.connected(c.start, c.goal);
    if (log.route.status == Status::undetermined) return "undetermined";
    if ((log.route.status == Status::found) != expected) return expected ? "missed" : "wrongly found";
    if (log.route.path.front() != c.start) return "start";
    if (expected && log.route.path.back() != c.goal) return "goal";
    if (!is_clear(c, log.route.path)) return "path through a wall";
    double bound = distance(c.start, c.goal);
    std::vector<int> met(c.perimeter.size(), 0);
    for (const Follow& f : log.follows) {
        const std::size_t ring = std::size_t(c.walls.ring(f.hit.in.name));
        ++met[ring];
        bound += (is_bug_1 ? 1.5 : 1.0) * c.perimeter[ring];
    }
    if (length_of(log.route.path) > bound * (1 + 1e-12)) return "longer than the bound";
    const std::vector<int> n = entries(c);
    for (std::size_t ring = 0; ring < met.size(); ++ring) {
        if (is_bug_1 && met[ring] > 1) return "a ring met twice";
        if (!is_bug_1 && met[ring] > n[ring]) return "more hits than entries";
    }
    return nullptr;
}

int total = 0, reachable = 0;
std::vector<double> times[5];
double lengths[5];  // of the ways found, each as a part of the shorter of Bug 1 and Bug 2

double shortest = 0;  // of Bug 1 and Bug 2 on the case being judged

void judge(const Case& c, const char* name, int number) {
    const bool expected = c.world.connected(c.start, c.goal);
    ++total;
    reachable += expected;
    double length[2] = {};
    for (int bug = 0; bug < 2; ++bug)
        for (Hand hand : {Hand::right, Hand::left}) {
            const auto begin = std::chrono::steady_clock::now();
            ContactRobot robot(c.walls, c.start);
            const WalkLog log = bug == 0 ? bug_1(robot, c.goal, hand) : bug_2(robot, c.goal, hand);
            const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
            times[bug].push_back(time.count());
            length[bug] = log.route.length;
            const char* fault = fault_of(c, log, bug == 0);
            if (!fault) continue;
            std::printf("bug %d, %s hand, %s %d: %s\n", bug + 1, hand == Hand::left ? "left" : "right", name,
                        number, fault);
            ++check::failures;
        }
    shortest = std::min(length[0], length[1]);
    for (int bug = 0; expected && shortest > 0 && bug < 2; ++bug) lengths[bug] += length[bug] / shortest;
}

const char* names[] = {"scattered", "thin walls", "mixed", "maze",    "spiral",
                       "comb",      "trap",       "rings", "chequers"};

int stress(int most) {
    const char* more = std::getenv("CSPACE_STRESS");
    return more ? most * std::atoi(more) : most;
}

// Tangent Bug with no range, short sight and long sight.
void judge_tangent_bug(const Case& c, const char* name, int number) {
    const bool expected = c.world.connected(c.start, c.goal);
    const double reach[] = {0, 0.1 * c.walls.extent(), std::numeric_limits<double>::infinity()};
    for (int k = 0; k < 3; ++k) {
        const auto begin = std::chrono::steady_clock::now();
        RangeRobot robot(c.walls, c.start, reach[k]);
        const WalkLog log = tangent_bug(robot, c.goal);
        const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
        times[2 + k].push_back(time.count());
        const char* fault = nullptr;
        if (log.route.status == Status::undetermined)
            fault = "undetermined";
        else if ((log.route.status == Status::found) != expected)
            fault = expected ? "missed" : "wrongly found";
        else if (log.route.path.front() != c.start || (expected && log.route.path.back() != c.goal))
            fault = "ends";
        else if (!is_clear(c, log.route.path))
            fault = "path through a wall";
        if (expected && shortest > 0) lengths[2 + k] += log.route.length / shortest;
        if (!fault) continue;
        std::printf("tangent bug, range %g, %s %d: %s\n", reach[k], name, number, fault);
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
        const Case c(std::move(world), random.below(2), start, goal);
        judge(c, names[int(family)], number);
        judge_tangent_bug(c, names[int(family)], number);
    }
}

}  // namespace

TEST(verdicts_and_bounds_in_small_degenerate_worlds) {
    for (int family = 0; family < int(Family::count); ++family) run_family(Family(family), stress(1000), 5);
}

TEST(verdicts_and_bounds_in_larger_worlds) {
    for (int family = 0; family < int(Family::count); ++family) run_family(Family(family), stress(60), 16);
    const char* who[] = {"bug 1", "bug 2", "tangent bug, touch", "tangent bug, near", "tangent bug, far"};
    for (int bug = 0; bug < 5; ++bug) {
        std::vector<double>& t = times[bug];
        std::sort(t.begin(), t.end());
        std::printf("     %s: median %.1f µs, p95 %.1f µs, largest %.0f µs\n", who[bug], t[t.size() / 2],
                    t[t.size() * 95 / 100], t.back());
    }
    std::printf("     mean length per shorter of bug 1 and 2:");
    for (double sum : lengths) std::printf(" %.3f", sum / reachable);
    std::printf("\n");
    CHECK(lengths[4] < lengths[3] && lengths[3] < lengths[2]);  // the further it sees, the shorter its ways
    CHECK(lengths[4] < lengths[0] && lengths[4] < lengths[1]);
    std::printf("     %d problems, %d of them with a way\n", total, reachable);
}

namespace {

// Convex polygons apart from each other in a square of side 100.
Walls convex_field(Random& random, int count) {
    maps::Boundary all;
    const auto add = [&](const std::vector<Point>& ring) {
        const int first = int(all.points.size()), n = int(ring.size());
        for (int i = 0; i < n; ++i) {
            all.points.push_back(ring[std::size_t(i)]);
            all.next.push_back(first + (i + 1) % n);
            all.ring.push_back(int(all.component.size()));
        }
        all.component.push_back(0);
    };
    add({{0, 0}, {100, 0}, {100, 100}, {0, 100}});
    const int side = int(std::ceil(std::sqrt(count)));
    const double cell = 100.0 / side;
    for (int k = 0; k < count; ++k) {
        const Point middle{cell * (k % side + 0.5), cell * (k / side + 0.5)};
        const int n = 3 + random.below(6);
        const double turn = random.uniform(0, 6), radius = random.uniform(0.2, 0.48) * cell;
        std::vector<Point> ring;  // clockwise: the free space lies outside
        for (int i = 0; i < n; ++i) {
            const double angle = turn - 6.283185307179586 * i / n;
            ring.push_back(middle + radius * Point{std::cos(angle), std::sin(angle)});
        }
        add(ring);
    }
    return Walls(std::move(all));
}

// A wall that winds around its inner end: a passage of width 1, so many turns deep.
Walls spiral(int turns) {
    std::vector<Point> way{{0, 0}};
    const Point direction[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int leg = 0; leg < 4 * turns; ++leg)
        way.push_back(way.back() + (2.0 + 2 * (leg / 2)) * direction[leg % 4]);
    maps::Boundary all;
    const int n = int(way.size());
    for (int i = 0; i < 2 * (n - 1); ++i) {  // there on one side, back on the other
        all.points.push_back(way[std::size_t(i < n ? i : 2 * (n - 1) - i)]);
        all.next.push_back((i + 1) % (2 * (n - 1)));
        all.ring.push_back(0);
    }
    all.component.push_back(0);
    return Walls(std::move(all));
}

double length_of(const Walls& walls, int bug, Point start, Point goal, Hand hand) {
    ContactRobot robot(walls, start);
    const WalkLog log = bug == 1 ? bug_1(robot, goal, hand) : bug_2(robot, goal, hand);
    CHECK(log.route.status == Status::found);
    return log.route.length;
}

}  // namespace

namespace {

// A sensor with no world behind it: it answers as a robot would that meets one crate, the square (1, −1) to
// (3, 1), on its way along the x axis, and counts what it is asked.
class ScriptedRobot {
  public:
    int advances = 0, walks = 0, stops = 0;

    std::size_t sides() const { return 1; }
    void stand(std::size_t) { at_ = {0, 0}; }
    Point position() const { return at_; }
    Touch touch() const { return {at_, piece(in_), piece(out_)}; }
    bool advance(const Line& line, std::vector<Point>&) {
        ++advances;
        if (at_.x < 1) {
            at_ = {1, 0};
            in_ = out_ = 0;
            return false;
        }
        CHECK(at_.x == 3 && at_.y == 0 && in_ == 2 &&
              out_ == 2);  // the only place from which the way is free
        at_ = line.to;
        return true;
    }
    void walk(Hand hand) {
        ++walks;
        if (hand == Hand::right) {
            in_ = out_;
            out_ = (out_ + 1) % 4;
        } else {
            out_ = in_;
            in_ = (in_ + 3) % 4;
        }
        at_ = piece(out_).begin;
    }
    void stop(Hand hand, Point at) {
        ++stops;
        in_ = out_ = hand == Hand::right ? out_ : in_;
        at_ = at;
    }

  private:
    Point at_;
    int in_ = -1, out_ = -1;

    static Wall piece(int k) {  // clockwise from the side that faces the start
        const Point corner[] = {{1, -1}, {1, 1}, {3, 1}, {3, -1}};
        return {corner[k], corner[(k + 1) % 4], k};
    }
};
static_assert(ContactSensor<ScriptedRobot> && !RangeSensor<ScriptedRobot>);
static_assert(ContactSensor<ContactRobot> && RangeSensor<RangeRobot>);

}  // namespace

TEST(planners_work_on_the_sensor_alone) {
    for (Hand hand : {Hand::left, Hand::right}) {
        ScriptedRobot one, two;
        const WalkLog first = bug_1(one, {5, 0}, hand), second = bug_2(two, {5, 0}, hand);
        CHECK(first.route.status == Status::found && second.route.status == Status::found);
        CHECK_NEAR(first.route.length, 5 - 2 + 8 + 4, 1e-12);  // around, then half way around
        CHECK_NEAR(second.route.length, 5 - 2 + 4, 1e-12);
        CHECK(one.advances == 2 && one.walks == 6 && one.stops == 2);
        CHECK(two.advances == 2 && two.walks == 2 && two.stops == 1);
    }
}

TEST(bug_2_wins_among_convex_obstacles) {
    Random random{11};
    int wins = 0, trials = 200;
    std::vector<double> time;
    for (int k = 0; k < trials; ++k) {
        const Walls walls = convex_field(random, 100);
        const Point start{0.5, random.uniform(0.5, 99.5)}, goal{99.5, random.uniform(0.5, 99.5)};
        const auto begin = std::chrono::steady_clock::now();
        const double two = length_of(walls, 2, start, goal, Hand::left);
        const std::chrono::duration<double, std::micro> passed = std::chrono::steady_clock::now() - begin;
        time.push_back(passed.count());
        wins += two <= length_of(walls, 1, start, goal, Hand::left);
    }
    std::sort(time.begin(), time.end());
    std::printf("     bug 2 among 100 convex obstacles: median %.1f µs\n", time[time.size() / 2]);
    CHECK(wins == trials);
}

TEST(bug_1_wins_in_a_spiral) {
    double before = 1;
    for (int turns : {4, 8, 16}) {
        const Walls walls = spiral(turns);
        const Point inside{1, 1}, outside{1, 5.0 * turns};
        const double one = length_of(walls, 1, inside, outside, Hand::left);
        const double two = length_of(walls, 2, inside, outside, Hand::left);
        std::printf("     out of a spiral of %d turns: bug 1 %.0f, bug 2 %.0f\n", turns, one, two);
        CHECK(two / one > before);  // deeper spirals are worse
        before = two / one;
    }
}
