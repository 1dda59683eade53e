// Laws of random trees: RRT and RRT* around a disc whose shortest path is known, the nearest among many rows
// against brute force, and plans by trees.
#include <array>
#include <chrono>
#include <cstring>
#include <stdexcept>

#include "ball_in_plane.hpp"
#include "check.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/search/random_tree.hpp"
#include "cspace/search/row_leaves.hpp"
#include "kernels/search.hpp"
#include "random_scenes.hpp"

namespace {

using namespace cspace;
using namespace cspace::planning;
using check::BallInPlane;
using check::ring;
using Row = std::vector<double>;
using Clock = std::chrono::steady_clock;

constexpr TreeOptions rrt = {}, star = {true, false, 0.05}, informed = {true, true, 0.05};

// The unit square without a disc: everything by brute force in double.
struct SquareWithDisc {
    using Place = std::array<double, 2>;
    static constexpr double radius = 0.25, step = 0.1;
    check::Random random;
    std::vector<Place> places = {}, ends = {{0.9, 0.5}};
    int edges = 0, rewired = 0;

    static double length(const Place& a, const Place& b) { return std::hypot(b[0] - a[0], b[1] - a[1]); }
    static bool misses(const Place& a, const Place& b) {
        const double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
        const double along = square > 0 ? ((0.5 - a[0]) * dx + (0.5 - a[1]) * dy) / square : 0;
        const double t = std::min(1.0, std::max(0.0, along));
        return length({a[0] + t * dx, a[1] + t * dy}, {0.5, 0.5}) >= radius;
    }

    double uniform() { return random.uniform(0, 1); }
    bool draw(Place& drawn) { return drawn = {uniform(), uniform()}, true; }
    void draw_goal(Place& drawn) { drawn = ends[std::size_t(random.below(goals()))]; }
    bool draw_within(double bound, Place& drawn) {
        return draw(drawn) && length(places[0], drawn) + length(drawn, ends[0]) < bound;
    }
    void add(const Place& place) { places.push_back(place); }
    Place place(int node) const { return places[std::size_t(node)]; }
    int find_nearest(const Place& q) const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < places.size(); ++i)
            if (length(places[i], q) < length(places[best], q)) best = i;
        return int(best);
    }
    void find_near(const Place& q, double, std::vector<int>& out) const {
        const double n = double(places.size() + 1);
        out.clear();
        for (std::size_t i = 0; i < places.size(); ++i)
            if (length(places[i], q) <= 1.5 * std::sqrt(std::log(n) / n)) out.push_back(int(i));
    }
    double distance(int node, const Place& q) const { return length(place(node), q); }
    int goals() const { return int(ends.size()); }
    const Place& goal(int g) const { return ends[std::size_t(g)]; }
    bool steer(int node, const Place& target, Place& made) {
        const Place from = place(node);
        const double far = length(from, target), share = far > step ? step / far : 1.0;
        made = {from[0] + share * (target[0] - from[0]), from[1] + share * (target[1] - from[1])};
        return far > 0 && is_free(node, made);
    }
    bool is_free(int node, const Place& q) { return ++edges, misses(place(node), q); }
    bool is_free(const Place& q, int node) { return is_free(node, q); }
    void note_edge(int, const Place&, double) {}
    void note_rewired(int, int, double) { ++rewired; }
    void keep(const std::vector<int>& nodes) {
        std::vector<Place> kept;
        for (const int i : nodes) kept.push_back(place(i));
        places = std::move(kept);
    }
};
using DiscTree = search::RandomTree<SquareWithDisc>;

// Whether every node has the cost of its way, and every edge is free.
bool is_consistent(const DiscTree& tree, const SquareWithDisc& space) {
    for (int i = 0; i < tree.size(); ++i) {
        const int parent = tree.parent(i);
        if (parent < 0) {
            if (tree.cost(i) != 0) return false;
            continue;
        }
        const double length = space.distance(parent, space.place(i));
        if (std::fabs(tree.cost(i) - tree.cost(parent) - length) > 1e-12) return false;
        if (!SquareWithDisc::misses(space.place(parent), space.place(i))) return false;
        int steps = 0;
        for (int n = i; n >= 0 && steps <= tree.size(); n = tree.parent(n)) ++steps;
        if (steps > tree.size()) return false;
    }
    return tree.size() == int(space.places.size());
}

bool is_same(const ArmPlan& a, const ArmPlan& b) {
    return a.status == b.status && a.path.size() == b.path.size() && a.stats.edges == b.stats.edges &&
           a.stats.samples == b.stats.samples && a.start == b.start && a.goal == b.goal &&
           (a.path.empty() || !std::memcmp(a.path.data(), b.path.data(), a.path.size() * sizeof(double)));
}

}  // namespace

TEST(trees_around_a_disc_hold_the_costs_of_their_ways_and_rrt_star_comes_close_to_the_shortest) {
    const double r = SquareWithDisc::radius, reach = 0.4;
    const double shortest = 2 * (std::sqrt(reach * reach - r * r) + r * (0.5 * pi - std::acos(r / reach)));
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        for (const bool is_optimal : {false, true}) {
            SquareWithDisc space{{seed}};
            DiscTree tree(space, {0.05, is_optimal ? search::TreeGrowth::any_reach : 0.1, is_optimal});
            tree.add_root({0.1, 0.5});
            tree.try_roots();
            double cost = tree.goal_cost();
            CHECK(std::isinf(cost) && !tree.has_path());
            for (int i = 0; i < 3000 && (is_optimal || !tree.has_path()); ++i) {
                tree.grow();
                CHECK(tree.goal_cost() <= cost);
                cost = tree.goal_cost();
            }
            CHECK(is_consistent(tree, space) && (space.rewired > 0) == is_optimal);
            CHECK(tree.has_path() && cost >= shortest * (1 - 1e-12));
            if (is_optimal) CHECK(cost < 1.02 * shortest);
        }
    }
}

TEST(a_tree_without_a_branch_holds_the_other_nodes_with_their_ways) {
    check::Random random{5};
    for (int trial = 0; trial < 60; ++trial) {
        SquareWithDisc space{{std::uint64_t(100 + trial)}};
        DiscTree tree(space, {0, search::TreeGrowth::any_reach, trial % 2 == 1});
        tree.add_root({0.1, 0.5}), tree.add_root({0.2, 0.9});
        tree.try_roots();
        for (int i = 0; i < 150; ++i) tree.grow();
        const int cut = 2 + random.below(tree.size() - 2);
        std::vector<SquareWithDisc::Place> expected;
        std::vector<double> costs;
        for (int i = 0; i < tree.size(); ++i) {
            bool is_below = false;
            for (int n = i; n >= 0; n = tree.parent(n)) is_below = is_below || n == cut;
            if (!is_below) expected.push_back(space.place(i)), costs.push_back(tree.cost(i));
        }
        tree.remove_branch(cut);
        CHECK(space.places == expected && is_consistent(tree, space) && !tree.has_path());
        for (int i = 0; i < tree.size(); ++i) CHECK(tree.cost(i) == costs[std::size_t(i)]);
        for (int i = 0; i < 150; ++i) tree.grow();
        CHECK(is_consistent(tree, space) && tree.has_path());
    }
}

TEST(the_nearest_in_leaves_are_those_of_brute_force_on_every_instruction_set) {
    check::Random random{6};
    for (int trial = 0; trial < 40; ++trial) {
        const int width = 1 + random.below(9), count = 400 + random.below(5000), most = 1 + random.below(40);
        std::vector<unsigned char> flags(std::size_t(width), 0);
        if (trial % 2)
            for (auto& w : flags) w = (unsigned char)random.below(2);
        const unsigned char* wraps = trial % 2 ? flags.data() : nullptr;
        const bool is_coarse = trial % 3 == 0;  // many equal distances
        const auto draw = [&] {
            std::vector<float> q;
            for (int k = 0; k < width; ++k) {
                const float x = float(random.uniform(-3.1, 3.1));
                q.push_back(is_coarse ? std::round(x) : x);
            }
            return q;
        };
        search::ConfigurationTree tree(width);
        search::RowLeaves leaves;
        for (int i = 0; i < count; ++i) tree.add(draw().data(), -1, 0), leaves.update(tree);
        CHECK(tree.size() - leaves.size() < search::RowLeaves::batch);
        for (int query = 0; query < 30; ++query) {
            const std::vector<float> q = draw();
            std::vector<search::NearRow> expected(static_cast<std::size_t>(most)), found = expected;
            const int n = kernels::find_nearest_rows(tree.blocks(), tree.size(), width, q.data(), wraps, most,
                                                     expected.data());
            const auto search_all = [&](auto* find_rows, auto* find_in_leaves) {
                const int sorted = leaves.size();
                int m = find_rows(tree.blocks() + std::ptrdiff_t(sorted) * width, tree.size() - sorted, width,
                                  q.data(), wraps, most, found.data());
                for (int i = 0; i < m; ++i) found[std::size_t(i)].row += sorted;
                m = find_in_leaves(leaves.view(), width, q.data(), wraps, most, leaves.scratch(),
                                   found.data(), m);
                CHECK(m == n && n == std::min(most, count));
                for (std::size_t i = 0; i < std::size_t(m); ++i)
                    CHECK(found[i].row == expected[i].row && found[i].square == expected[i].square);
            };
            search_all(kernels::find_nearest_rows, kernels::find_nearest_in_leaves);
#if defined(CSPACE_HAS_AVX2)
            search_all(&search::baseline::find_nearest_rows, &search::baseline::find_nearest_in_leaves);
#endif
            const auto one = kernels::find_nearest(tree.blocks(), tree.size(), width, q.data(), wraps);
            CHECK(one.row == expected[0].row && one.square == expected[0].square);
        }
    }
}

TEST(plans_of_trees_do_not_depend_on_threads_and_are_certified) {
    check::Random random{31};
    int found = 0;
    for (int arm = 0; arm < 12; ++arm) {
        const auto cell = check::random_cell(random, 2 + random.below(6));
        const auto memory = cell.checker->borrow_workspace();
        std::vector<Row> ends;
        for (int i = 0; i < 400 && ends.size() < 8; ++i) {
            const Row q = cell.configuration(random);
            if (cell.checker->is_free(q.data(), *memory)) ends.push_back(q);
        }
        std::vector<ArmProblem> problems;
        for (std::size_t i = 0; i + 1 < ends.size(); i += 2) problems.push_back({ends[i], ends[i + 1]});
        ArmOptions options;
        options.edges = 1500, options.improve = 500, options.seed = std::uint64_t(arm);
        if (arm % 3 == 1) options.search = EdgeTest::sampled, options.resolution = 1, options.range = 9;
        const ArmSpace space{*cell.checker, cell.lower, cell.upper, {}};
        for (const TreeOptions& tree : {rrt, star, informed}) {
            const auto one = plan_arms(space, problems, options, 1, tree);
            const auto many = plan_arms(space, problems, options, 4, tree);
            for (std::size_t i = 0; i < problems.size(); ++i) {
                CHECK(is_same(one[i], many[i]));
                CHECK(is_same(one[i], plan_arm(space, problems[i], options, tree)));
                if (one[i].status != PlanStatus::found) {
                    CHECK(one[i].status == PlanStatus::edge_budget && one[i].path.empty());
                    continue;
                }
                ++found;
                const std::size_t width = cell.lower.size();
                CHECK(one[i].certified);
                for (std::size_t at = 0; at + width < one[i].path.size(); at += width)
                    CHECK(cell.checker->prove_edge(&one[i].path[at], &one[i].path[at + width], *memory) ==
                          collision::Verdict::free);
            }
        }
    }
    CHECK(found > 40);
}

TEST(more_edges_never_make_a_path_of_rrt_star_longer_and_it_approaches_the_shortest) {
    // Around the end of a wall: the centre of the ball passes at its radius from the corner.
    const BallInPlane plane({{0, -0.4, 0.005, 0.6}});
    const Row start = {-0.5, 0}, goal = {0.5, 0};
    const double shortest = 2 * std::hypot(0.5, 0.2);
    for (const TreeOptions& tree : {star, informed}) {
        for (std::uint64_t seed = 0; seed < 8; ++seed) {
            ArmOptions options;
            options.seed = seed;
            options.simplify = seed % 2 == 0;
            double before = std::numeric_limits<double>::infinity();
            for (const std::int64_t improve : {0, 200, 2000, 20000}) {
                options.improve = improve;
                const ArmPlan plan = plane.plan(start, goal, options, tree);
                CHECK(plan.status == PlanStatus::found && plan.certified);
                CHECK(plan.cost > shortest && plan.cost <= before);
                before = plan.cost;
            }
            CHECK(before < 1.06 * shortest);
        }
    }
}

TEST(a_walled_goal_uses_up_the_budget_of_a_tree_and_another_goal_is_found) {
    const BallInPlane plane(ring);
    const Row start = {-0.5, -0.5}, walled = {0.5, 0.5}, two = {0.5, 0.5, 0.8, 0.8};
    ArmOptions options;
    options.edges = 3000;
    for (const TreeOptions& tree : {rrt, star, informed}) {
        const ArmPlan none = plane.plan(start, walled, options, tree);
        CHECK(none.status == PlanStatus::edge_budget && none.start == -1 && none.goal == -1);
        CHECK(none.stats.edges >= options.edges && none.stats.edges < options.edges + 60);
        CHECK(none.blocker.other >= 0 && none.blocker_edges > 0 && none.stats.nodes > 100);
        CHECK(none.approach.distance > 0.1 && none.approach.distance < 0.4);
        CHECK(none.approach.to == walled);
        const ArmPlan one = plane.plan(start, two, options, tree);
        CHECK(one.status == PlanStatus::found && one.goal == 1);
        const ArmPlan other = plane.plan(two, start, options, tree);
        CHECK(other.status == PlanStatus::found && other.start == 1);
        const ArmPlan same = plane.plan(start, start, options, tree);
        CHECK(same.status == PlanStatus::found && same.cost == 0);
    }
}

TEST(budget_time_and_interrupts_end_a_tree_and_wrong_options_are_refused) {
    const BallInPlane plane(ring);
    const Row start = {-0.5, -0.5}, walled = {0.5, 0.5}, goal = {-0.4, -0.5};
    for (const TreeOptions& tree : {rrt, star, informed}) {
        ArmOptions options;
        options.edges = 0;
        const ArmPlan nothing = plane.plan(start, goal, options, tree);
        CHECK(nothing.status == PlanStatus::edge_budget && nothing.stats.edges == 0);
        CHECK_NEAR(nothing.approach.distance, 0.1, 1e-6);
        options.edges = std::int64_t(1) << 40;
        options.time_limit = 0;
        CHECK(plane.plan(start, goal, options, tree).status == PlanStatus::time_limit);
        options.time_limit = 0.05;
        const auto begin = Clock::now();
        CHECK(plane.plan(start, walled, options, tree).status == PlanStatus::time_limit);
        CHECK(std::chrono::duration<double>(Clock::now() - begin).count() < 0.5);
        options.time_limit = std::numeric_limits<double>::infinity();
        static int calls;
        calls = 0;
        set_interrupt_check([] {
            if (++calls == 5) throw std::runtime_error("stop");
        });
        bool is_stopped = false;
        try {
            plane.plan(start, walled, options, tree);
        } catch (const std::runtime_error&) {
            is_stopped = true;
        }
        set_interrupt_check(nullptr);
        CHECK(is_stopped);
    }
    for (const double bias : {-0.1, 1.1, double(NAN)}) {
        bool is_refused = false;
        try {
            plane.plan(start, goal, {}, TreeOptions{true, true, bias});
        } catch (const std::invalid_argument&) {
            is_refused = true;
        }
        CHECK(is_refused);
    }
}
