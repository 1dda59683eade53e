// Laws of planning: samples and trees against slow restatements, paths against distances in double.
#include <array>
#include <chrono>
#include <cstring>
#include <set>
#include <stdexcept>

#include "ball_in_plane.hpp"
#include "check.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/planning/rrt_connect.hpp"
#include "cspace/planning/simplify.hpp"
#include "kernels/search.hpp"
#include "library/planning_arm.hpp"
#include "random_scenes.hpp"

namespace {

using namespace cspace;
using namespace cspace::planning;
using check::BallInPlane;
using check::ring;
using Row = std::vector<double>;
using Clock = std::chrono::steady_clock;

double length_of(const std::vector<double>& path, std::size_t width) {
    double sum = 0;
    for (std::size_t i = width; i < path.size(); i += width) {
        double square = 0;
        for (std::size_t k = 0; k < width; ++k)
            square += (path[i + k] - path[i + k - width]) * (path[i + k] - path[i + k - width]);
        sum += std::sqrt(square);
    }
    return sum;
}
bool is_same(const double* a, const double* b, std::size_t width) {
    return std::memcmp(a, b, width * sizeof(double)) == 0;
}
bool is_same(const ArmPlan& a, const ArmPlan& b) {
    return a.status == b.status && a.path.size() == b.path.size() && a.start == b.start && a.goal == b.goal &&
           (a.path.empty() || is_same(a.path.data(), b.path.data(), a.path.size())) &&
           a.stats.edges == b.stats.edges && a.stats.blocks == b.stats.blocks &&
           a.blocker.link == b.blocker.link && a.blocker.other == b.blocker.other &&
           a.blocker_edges == b.blocker_edges;
}

// The least clearance along an edge, in double: from each place on to the next that something could touch,
// at most a hundred times as dense as the samples of the search.
double least_clearance(const check::RandomCell& cell, const double* a, const double* b) {
    const std::size_t width = cell.lower.size();
    double reach = 0.3, speed = 0;
    for (const auto& joint : cell.joints) reach += norm(joint.T_parent_joint.t) + (joint.prismatic ? 3 : 0);
    for (const auto& joint : cell.joints)
        speed += std::fabs(joint.ratio * (b[joint.coordinate] - a[joint.coordinate])) * std::max(reach, 1.0);
    const double finest = 1.0 / (3200 * (row_distance(a, b, width) + 1e-3));
    double least = 1e9;
    for (double t = 0;;) {
        Row q(width);
        for (std::size_t k = 0; k < width; ++k) q[k] = a[k] + t * (b[k] - a[k]);
        const double distance = cell.checker->clearance(q.data()).distance;
        least = std::min(least, distance);
        if (t == 1) return least;
        t = std::min(1.0, t + std::max(distance / (2 * speed + 1e-9), finest));
    }
}

Row free_configuration(const check::RandomCell& cell, check::Random& random) {
    const auto memory = cell.checker->borrow_workspace();
    for (int i = 0; i < 200; ++i) {
        const Row q = cell.configuration(random);
        if (cell.checker->is_free(q.data(), *memory)) return q;
    }
    return {};
}

// An arm of one joint about z that carries a ball, and a rod at the angle `blocked`.
struct Turntable {
    std::unique_ptr<collision::Checker> checker;
    explicit Turntable(double blocked, double distance) {
        const std::vector<model::Joint> joints = {{identity_pose(), -1, 0, 1, 0, false, 0}};
        const Row limits = {4.0};
        const std::vector<double> rods = {distance * std::cos(blocked),
                                          distance * std::sin(blocked),
                                          -0.2,
                                          distance * std::cos(blocked),
                                          distance * std::sin(blocked),
                                          0.2,
                                          0.03};
        const std::vector<int> owners = {0};
        collision::Primitives given = {};
        given.capsules = rods, given.owners = owners;
        checker = std::make_unique<collision::Checker>(
            std::make_shared<collision::RobotData>(joints, 1, limits, limits, std::vector<int>{1},
                                                   std::vector<collision::Sphere>{{{0.5, 0, 0}, 0.05, 0}},
                                                   std::vector<std::pair<int, int>>{}),
            std::make_shared<collision::SceneData>(given), 0.0, std::vector<std::pair<int, int>>{});
    }
    ArmPlan plan(double from, double to, bool wraps) const {
        const Row low = {-4}, high = {4}, start = {from}, goal = {to};
        const std::vector<unsigned char> flags = {(unsigned char)wraps};
        ArmOptions options;
        options.edges = 2000;
        return plan_arm({*checker, low, high, flags}, {start, goal}, options);
    }
};

}  // namespace

TEST(halton_points_fill_every_cell_of_a_base_once_and_do_not_depend_on_chunks) {
    constexpr int width = 64;
    const search::HaltonTable table(width);
    search::HaltonPoints points(table, 0), again(table, 0), shifted(table, 7);
    std::array<unsigned, width> bases{};
    for (unsigned n = 3, k = 0; k < width; n += 2) {
        bool is_prime = true;
        for (unsigned d = 3; d * d <= n; d += 2) is_prime = is_prime && n % d;
        if (is_prime) bases[k++] = n;
    }
    std::vector<std::vector<float>> rows;
    const std::size_t count = search::HaltonTable::chunk_rows * (search::HaltonTable::most_chunks + 2);
    std::array<float, width> shift{};
    for (std::size_t i = 0; i < count; ++i) {
        const float* p = points.next();
        if (i < 1000 || i + 300 > count) rows.emplace_back(p, p + width);
        const float *q = again.next(), *s = shifted.next();
        for (int k = 0; k < width; ++k) {
            CHECK(p[k] >= 0 && p[k] < 1 && q[k] == p[k] && s[k] >= 0 && s[k] < 1);
            const float moved = s[k] - p[k] + (s[k] < p[k] ? 1.0f : 0.0f);
            if (i == 0) shift[std::size_t(k)] = moved;
            const float off = std::fabs(moved - shift[std::size_t(k)]);
            CHECK(std::min(off, 1 - off) < 1e-6f);
        }
    }
    for (int k = 0; k < width; ++k) {
        const unsigned base = bases[std::size_t(k)], square = base * base;
        if (2 * square > 1000) continue;
        std::set<unsigned> cells;  // of the points number base² … 2 base² − 1
        for (unsigned i = square; i < 2 * square; ++i)
            cells.insert(unsigned(rows[i - 1][std::size_t(k)] * float(square)));
        CHECK(cells.size() == square);
    }
    const auto digits = [](std::uint64_t i, unsigned base) {
        double x = 0, scale = 1;
        for (; i; i /= base) scale /= base, x += double(i % base) * scale;
        return x;
    };
    for (int k = 0; k < 8; ++k) {
        CHECK_NEAR(rows[122][std::size_t(k)], digits(123, bases[std::size_t(k)]), 1e-6);
        CHECK_NEAR(rows.back()[std::size_t(k)], digits(count, bases[std::size_t(k)]), 1e-6);
    }
}

TEST(the_nearest_node_is_that_of_brute_force_on_every_instruction_set) {
    check::Random random{11};
    for (int trial = 0; trial < 400; ++trial) {
        const int width = 1 + random.below(12), count = 1 + random.below(60);
        const bool any_wraps = trial % 2;
        std::vector<unsigned char> wraps(std::size_t(width), 0);
        if (any_wraps)
            for (auto& w : wraps) w = (unsigned char)random.below(2);
        search::ConfigurationTree tree(width);
        const auto draw = [&] {
            std::vector<float> q;
            for (int k = 0; k < width; ++k) q.push_back(float(random.uniform(-3.1, 3.1)));
            return q;
        };
        std::vector<std::vector<float>> nodes;
        for (int i = 0; i < count; ++i) {
            nodes.push_back(i > 0 && random.below(5) == 0 ? nodes[std::size_t(random.below(i))] : draw());
            tree.add(nodes.back().data(), i - 1, 1);
        }
        const std::vector<float> q = draw();
        const unsigned char* flags = any_wraps ? wraps.data() : nullptr;
        const auto found = kernels::find_nearest(tree.blocks(), tree.size(), width, q.data(), flags);
        double least = 1e30;
        std::vector<double> squares;
        for (const auto& node : nodes) {
            double square = 0;
            for (std::size_t k = 0; k < node.size(); ++k) {
                double d = std::fabs(double(node[k]) - q[k]);
                if (wraps[k]) d = std::min(d, 2 * pi - d);
                square += d * d;
            }
            squares.push_back(square);
            least = std::min(least, square);
        }
        CHECK_NEAR(found.square, least, 1e-5 * (1 + least));
        CHECK_NEAR(squares[std::size_t(found.row)], least, 1e-5 * (1 + least));
        for (int i = 0; i < found.row; ++i) CHECK(nodes[std::size_t(i)] != nodes[std::size_t(found.row)]);
#if defined(CSPACE_HAS_AVX2)
        const auto slow = search::baseline::find_nearest(tree.blocks(), tree.size(), width, q.data(), flags);
        CHECK(slow.row == found.row && slow.square == found.square);
#endif
    }
}

TEST(a_tree_without_a_branch_holds_the_others_with_their_parents) {
    check::Random random{12};
    for (int trial = 0; trial < 100; ++trial) {
        const int count = 2 + random.below(40);
        search::ConfigurationTree tree(2);
        std::vector<int> parents;
        for (int i = 0; i < count; ++i) {
            const float q[] = {float(i), -float(i)};
            parents.push_back(i == 0 ? -1 : random.below(i));
            tree.add(q, parents.back(), float(i));
        }
        const int cut = 1 + random.below(count - 1);
        std::vector<int> expected;
        for (int i = 0; i < count; ++i) {
            bool is_below = false;
            for (int n = i; n >= 0; n = parents[std::size_t(n)]) is_below = is_below || n == cut;
            if (!is_below) expected.push_back(i);
        }
        CHECK(tree.remove_branch(cut) == expected);
        CHECK(tree.size() == int(expected.size()));
        for (int i = 0; i < tree.size(); ++i) {
            float q[2];
            tree.copy_row(i, q);
            const int before = expected[std::size_t(i)];
            CHECK(q[0] == float(before) && q[1] == -float(before) && tree.cost(i) == float(before));
            const int parent = tree.parent(i);
            CHECK((parent < 0 ? -1 : expected[std::size_t(parent)]) == parents[std::size_t(before)]);
        }
    }
}

TEST(every_path_keeps_clear_over_its_whole_length) {
    check::Random random{21};
    int found = 0, bent = 0, removed = 0;
    for (int arm = 0; arm < 150; ++arm) {
        const auto cell = check::random_cell(random, 2 + random.below(7));
        const std::size_t width = cell.lower.size();
        const Row start = free_configuration(cell, random), goal = free_configuration(cell, random);
        if (start.empty() || goal.empty() || cell.checker->base_contact().other >= 0) continue;
        ArmOptions options;
        options.edges = 4000;
        options.seed = std::uint64_t(arm % 3);
        if (arm % 4 == 1) options.search = EdgeTest::sampled;
        if (arm % 4 == 2)
            options.search = EdgeTest::sampled, options.resolution = 1, options.range = 9;  // misses much
        const ArmSpace space{*cell.checker, cell.lower, cell.upper, {}};
        const ArmPlan plan = plan_arm(space, {start, goal}, options);
        CHECK(is_same(plan, plan_arm(space, {start, goal}, options)));
        removed += plan.stats.removed > 0;
        if (plan.status != PlanStatus::found) {
            CHECK(plan.status == PlanStatus::edge_budget && plan.path.empty() && !plan.certified);
            CHECK(plan.stats.edges >= options.edges && plan.blocker.link >= 0);
            CHECK(plan.approach.distance <= row_distance(start.data(), goal.data(), width) + 1e-5);
            continue;
        }
        ++found;
        const std::size_t rows = plan.path.size() / width;
        bent += rows > 2;
        CHECK(plan.certified && plan.start == 0 && plan.goal == 0);
        CHECK(is_same(plan.path.data(), start.data(), width));
        CHECK(is_same(plan.path.data() + plan.path.size() - width, goal.data(), width));
        CHECK_NEAR(plan.cost, length_of(plan.path, width), 1e-9);
        CHECK(plan.cost <= plan.raw_cost * (1 + 1e-12));
        CHECK(plan.cost >= row_distance(start.data(), goal.data(), width) * (1 - 1e-12));
        for (std::size_t i = 0; i < plan.path.size(); ++i)
            CHECK(plan.path[i] >= cell.lower[i % width] && plan.path[i] <= cell.upper[i % width]);
        for (std::size_t i = 0; i + 1 < rows; ++i)
            CHECK(least_clearance(cell, &plan.path[i * width], &plan.path[(i + 1) * width]) > 0);
    }
    std::printf("%d found, %d bent, %d lost an edge of a tree\n", found, bent, removed);
    CHECK(found > 60 && bent > 20 && removed > 0);
}

TEST(plans_are_the_same_on_any_number_of_threads) {
    check::Random random{22};
    const auto cell = check::random_cell(random, 6);
    std::vector<Row> ends;
    std::vector<ArmProblem> problems;
    for (int i = 0; i < 80; ++i) ends.push_back(free_configuration(cell, random));
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2) problems.push_back({ends[i], ends[i + 1]});
    ArmOptions options;
    options.edges = 3000;
    const ArmSpace space{*cell.checker, cell.lower, cell.upper, {}};
    const auto one = plan_arms(space, problems, options, 1), many = plan_arms(space, problems, options, 4);
    for (std::size_t i = 0; i < problems.size(); ++i) {
        CHECK(is_same(one[i], many[i]));
        CHECK(is_same(one[i], plan_arm(space, problems[i], options)));
    }
}

TEST(without_a_proof_nothing_is_certified_and_raw_paths_cost_what_they_say) {
    check::Random random{23};
    for (int arm = 0; arm < 40; ++arm) {
        const auto cell = check::random_cell(random, 2 + random.below(5));
        const std::size_t width = cell.lower.size();
        const Row start = free_configuration(cell, random), goal = free_configuration(cell, random);
        if (start.empty() || goal.empty()) continue;
        ArmOptions options;
        options.edges = 2000;
        options.answer = EdgeTest::sampled;
        const ArmSpace space{*cell.checker, cell.lower, cell.upper, {}};
        const ArmPlan shorter = plan_arm(space, {start, goal}, options);
        options.simplify = false;
        const ArmPlan raw = plan_arm(space, {start, goal}, options);
        CHECK(!shorter.certified && !raw.certified && shorter.status == raw.status);
        if (raw.status != PlanStatus::found) continue;
        CHECK(raw.cost == raw.raw_cost && raw.raw_cost == shorter.raw_cost && shorter.cost <= raw.cost);
        CHECK_NEAR(raw.cost, length_of(raw.path, width), 1e-9);
    }
}

TEST(ends_that_are_blocked_or_out_of_bounds_are_reported_one_by_one) {
    const BallInPlane plane({{0, 0, 0.2, 0.2}});
    const Row outside = {-0.8, 0.0}, inside = {0.1, 0.1}, beyond = {1.5, 0.0}, other = {0.8, 0.0};
    const ArmPlan bad_start = plane.plan(inside, other);
    CHECK(bad_start.status == PlanStatus::invalid_start && bad_start.path.empty());
    CHECK(bad_start.starts[0].state == RowState::in_collision && bad_start.starts[0].contact.link == 0);
    CHECK(bad_start.starts[0].contact.other == 0 && !bad_start.starts[0].contact.is_pair);
    CHECK(plane.plan(beyond, other).starts[0].state == RowState::out_of_bounds);
    Row goals = inside;
    goals.insert(goals.end(), beyond.begin(), beyond.end());
    const ArmPlan bad_goals = plane.plan(outside, goals);
    CHECK(bad_goals.status == PlanStatus::invalid_goals && bad_goals.starts[0].state == RowState::free);
    CHECK(bad_goals.goals[0].state == RowState::in_collision);
    CHECK(bad_goals.goals[1].state == RowState::out_of_bounds);
    goals.insert(goals.end(), other.begin(), other.end());
    const ArmPlan good = plane.plan(outside, goals);
    CHECK(good.status == PlanStatus::found && good.goal == 2 && good.goals[2].state == RowState::free);
    CHECK(good.cost > 1.6 && good.cost < 2.2);
    Row nowhere = {std::nan(""), 0.0};
    CHECK(plane.plan(nowhere, other).starts[0].state == RowState::out_of_bounds);
}

TEST(a_goal_behind_walls_uses_up_the_budget_and_another_goal_is_found) {
    const BallInPlane plane(ring);
    const Row start = {-0.5, -0.5}, walled = {0.5, 0.5};
    ArmOptions options;
    options.edges = 5000;
    const ArmPlan none = plane.plan(start, walled, options);
    CHECK(none.status == PlanStatus::edge_budget && none.start == -1 && none.goal == -1);
    CHECK(none.stats.edges >= options.edges && none.stats.edges < options.edges + 10);
    CHECK(none.blocker.other >= 0 && none.blocker.other < 4 && none.blocker_edges > 0);
    CHECK(none.blocker_edges <= none.stats.blocked);
    CHECK(none.approach.distance > 0 && none.approach.distance < 1.5);
    CHECK_NEAR(row_distance(none.approach.from.data(), none.approach.to.data(), 2), none.approach.distance,
               1e-5);
    CHECK_NEAR(none.approach.to[0], 0.5, 0.15);
    CHECK_NEAR(none.approach.to[1], 0.5, 0.15);
    const Row two = {0.5, 0.5, 0.8, 0.8};
    const ArmPlan one = plane.plan(start, two, options);
    CHECK(one.status == PlanStatus::found && one.goal == 1);
    const Row starts = {0.5, 0.5, -0.5, -0.5}, goal = {0.8, 0.8};
    const ArmPlan other = plane.plan(starts, goal, options);
    CHECK(other.status == PlanStatus::found && other.start == 1);
    CHECK(is_same(other.path.data(), &starts[2], 2));
}

TEST(a_path_around_a_wall_is_hardly_longer_than_the_shortest) {
    // Around the end of a wall of half length 0.6: the ball's centre passes at its radius from the corner.
    const BallInPlane plane({{0, -0.4, 0.005, 0.6}});
    const Row start = {-0.5, 0}, goal = {0.5, 0};
    const double shortest = 2 * std::hypot(0.5, 0.2);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        ArmOptions options;
        options.seed = seed;
        const ArmPlan plan = plane.plan(start, goal, options);
        CHECK(plan.status == PlanStatus::found && plan.certified);
        CHECK(plan.cost > shortest && plan.cost < 1.3 * shortest);
    }
}

TEST(joints_that_wrap_take_the_short_way_unless_it_is_blocked) {
    const Turntable open(0, 1.0), blocked(pi, 0.5);
    const ArmPlan across = open.plan(3.0, -3.0, true);
    CHECK(across.status == PlanStatus::found && across.turns[0] == 1);
    CHECK_NEAR(across.cost, 2 * pi - 6, 1e-6);
    CHECK(across.path.front() == 3.0);
    CHECK_NEAR(across.path.back(), -3.0 + 2 * pi, 1e-12);
    const ArmPlan plain = open.plan(3.0, -3.0, false);
    CHECK(plain.status == PlanStatus::found && plain.turns[0] == 0 && plain.path.back() == -3.0);
    CHECK_NEAR(plain.cost, 6, 1e-9);
    const ArmPlan around = blocked.plan(2.5, -2.5, true);
    CHECK(around.status == PlanStatus::found && around.turns[0] == 0 && around.path.back() == -2.5);
    CHECK_NEAR(around.cost, 5, 1e-6);
    const ArmPlan far = open.plan(3.0 + 20 * pi, -3.0, true);  // ten times round already
    CHECK(far.status == PlanStatus::found && far.turns[0] == 11);
    CHECK_NEAR(far.cost, 2 * pi - 6, 1e-5);
    CHECK(far.path.front() == 3.0 + 20 * pi);
}

TEST(a_start_that_is_the_goal_needs_no_way) {
    const BallInPlane plane(ring);
    const Row here = {-0.5, -0.25};
    const ArmPlan plan = plane.plan(here, here);
    CHECK(plan.status == PlanStatus::found && plan.cost == 0 && plan.certified && plan.path.size() == 4);
    CHECK(is_same(plan.path.data(), here.data(), 2) && is_same(&plan.path[2], here.data(), 2));
}

TEST(budget_time_and_interrupts_end_a_search) {
    const BallInPlane plane(ring);
    const Row start = {-0.5, -0.5}, walled = {0.5, 0.5}, goal = {-0.4, -0.5};
    ArmOptions options;
    options.edges = 0;
    CHECK(plane.plan(start, goal, options).status == PlanStatus::edge_budget);
    options.edges = std::int64_t(1) << 40;
    options.time_limit = 0;
    const ArmPlan late = plane.plan(start, goal, options);
    CHECK(late.status == PlanStatus::time_limit && late.path.empty() && late.stats.edges == 0);
    options.time_limit = 0.05;
    const auto begin = Clock::now();
    CHECK(plane.plan(start, walled, options).status == PlanStatus::time_limit);
    const double spent = std::chrono::duration<double>(Clock::now() - begin).count();
    CHECK(spent >= 0.05 && spent < 0.5);
    options.time_limit = std::numeric_limits<double>::infinity();
    static int calls;
    calls = 0;
    set_interrupt_check([] {
        if (++calls == 5) throw std::runtime_error("stop");
    });
    for (const int threads : {1, 3}) {
        calls = 0;
        bool is_stopped = false;
        try {
            const std::vector<ArmProblem> problems(6, ArmProblem{start, walled});
            plan_arms({*plane.checker, plane.lower, plane.upper, {}}, problems, options, threads);
        } catch (const std::runtime_error&) {
            is_stopped = true;
        }
        CHECK(is_stopped);
    }
    set_interrupt_check(nullptr);
}

TEST(input_that_does_not_fit_is_refused) {
    const BallInPlane plane(ring);
    const Row a = {0, 0}, b = {0.1, 0}, three = {0, 0, 0}, upside = {-1, -2}, endless = {1, INFINITY};
    const auto is_refused = [&](const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options) {
        try {
            (void)plan_arm(space, problem, options);
        } catch (const std::invalid_argument&) {
            return true;
        }
        return false;
    };
    const ArmSpace good{*plane.checker, plane.lower, plane.upper, {}};
    const std::vector<unsigned char> wraps = {1, 0};
    CHECK(!is_refused(good, {a, b}, {}));
    CHECK(is_refused(good, {three, b}, {}) && is_refused(good, {a, {}}, {}));
    CHECK(is_refused({*plane.checker, plane.lower, upside, {}}, {a, b}, {}));
    CHECK(is_refused({*plane.checker, plane.lower, endless, {}}, {a, b}, {}));
    CHECK(is_refused({*plane.checker, three, plane.upper, {}}, {a, b}, {}));
    CHECK(is_refused({*plane.checker, plane.lower, plane.upper, wraps}, {a, b}, {}));  // prismatic
    ArmOptions bad;
    bad.range = 0;
    CHECK(is_refused(good, {a, b}, bad));
    bad = {}, bad.edges = -1;
    CHECK(is_refused(good, {a, b}, bad));
    bad = {}, bad.resolution = std::nanf("");
    CHECK(is_refused(good, {a, b}, bad));
    bad = {}, bad.time_limit = std::nan("");
    CHECK(is_refused(good, {a, b}, bad));
}
