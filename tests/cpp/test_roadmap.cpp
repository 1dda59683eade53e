// Laws of roadmaps: neighbours, components and shortest ways against slow restatements; what a roadmap of an
// arm refuses, and that it stops when told to.
#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "check.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/search/configuration_tree.hpp"
#include "cspace/search/roadmap.hpp"
#include "cspace/search/shortest_way.hpp"
#include "cspace/search/star_neighbours.hpp"
#include "kernels/search.hpp"
#include "library/planning_arm_roadmap.hpp"
#include "random_scenes.hpp"

namespace {

using namespace cspace;
using namespace cspace::search;

constexpr double inf = std::numeric_limits<double>::infinity();

// A random graph with edges that are free or not, and a bound that holds.
struct RandomGraph {
    struct Edge {
        std::uint32_t a, b;
        double length;
        bool is_free, is_known;
    };
    std::vector<Edge> edges;
    std::vector<double> bounds;
    std::vector<std::uint8_t> goals;
    Adjacency<RoadmapArc> arcs;
    std::int64_t checked = 0, budget = 1 << 20;

    RandomGraph(check::Random& random, std::size_t nodes, double known) : bounds(nodes, 0), goals(nodes, 0) {
        const auto draw = [&](std::size_t n) { return std::uint32_t(random.uniform(0, double(n) - 1e-9)); };
        std::vector<NodePair> pairs;
        for (std::size_t k = 0; k < 3 * nodes; ++k) {
            edges.push_back({draw(nodes), draw(nodes), std::floor(random.uniform(0, 6)),
                             random.uniform(0, 1) < 0.6, random.uniform(0, 1) < known});
            edges.back().is_known &= edges.back().is_free;
            pairs.push_back({std::int32_t(edges.back().a), std::int32_t(edges.back().b)});
        }
        for (int k = 0; k < 2; ++k) goals[draw(nodes)] = 1;
        arcs = join_pairs<RoadmapArc>(
            nodes, pairs, [](std::int32_t to, std::int32_t edge) { return RoadmapArc{to, edge}; });
        const std::vector<double> to_goal = distances(goals, true);
        const double share = random.uniform(0, 1);
        for (std::size_t k = 0; k < nodes; ++k) bounds[k] = to_goal[k] == inf ? 1e9 : share * to_goal[k];
    }

    // From a set of nodes over the free edges, or over all of them: Bellman and Ford.
    std::vector<double> distances(const std::vector<std::uint8_t>& from, bool over_all) const {
        std::vector<double> found(from.size(), inf);
        for (std::size_t k = 0; k < from.size(); ++k)
            if (from[k]) found[k] = 0;
        for (bool changes = true; std::exchange(changes, false);)
            for (const Edge& e : edges)
                for (const auto& [x, y] : {std::pair(e.a, e.b), std::pair(e.b, e.a)})
                    if ((over_all || e.is_free) && found[x] + e.length < found[y])
                        found[y] = found[x] + e.length, changes = true;
        return found;
    }

    template <class Visit>
    void each_arc(std::uint32_t node, const Visit& visit) const {
        for (const RoadmapArc& arc : arcs.of(node))
            visit(std::uint32_t(arc.to), std::uint32_t(arc.edge), edges[std::size_t(arc.edge)].length);
    }
    double bound(std::uint32_t node) const { return bounds[node]; }
    bool is_goal(std::uint32_t node) const { return goals[node]; }
    bool is_known(std::uint32_t edge) const { return edges[edge].is_known; }
    EdgeState check(const WayArc& arc) {
        if (checked == budget) return EdgeState::unknown;
        ++checked;
        return edges[arc.edge].is_free ? EdgeState::free : EdgeState::blocked;
    }
};

// The checker of a robot alone.
struct LoneRobot {
    check::RandomCell cell;
    std::shared_ptr<const collision::Checker> alone;

    explicit LoneRobot(check::Random& random) : cell(check::random_cell(random, 5)) {
        alone = std::make_shared<collision::Checker>(
            std::make_shared<collision::RobotData>(cell.joints, int(cell.lower.size()), cell.lower,
                                                   cell.upper, cell.link_bodies, cell.spheres, cell.pairs),
            std::make_shared<collision::SceneData>(collision::Primitives{}), 0.0,
            std::vector<std::pair<int, int>>{});
    }
    planning::ArmSpace space() const { return {*alone, cell.lower, cell.upper, {}}; }
};

}  // namespace

TEST(the_nearest_rows_are_those_of_a_sort) {
    check::Random random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const int width = 1 + int(random.uniform(0, 9)), n = int(random.uniform(0, 60));
        std::vector<unsigned char> wraps(static_cast<std::size_t>(width));
        for (auto& w : wraps) w = random.uniform(0, 1) < 0.3;
        const auto draw = [&](std::vector<float>& q) {
            q.resize(std::size_t(width));
            for (float& x : q) x = float(std::floor(random.uniform(-3, 4)));  // many are equally near
        };
        ConfigurationTree tree(width);
        std::vector<std::vector<float>> rows(static_cast<std::size_t>(n));
        std::vector<float> q;
        for (auto& row : rows) draw(row), tree.add(row.data(), -1, 0);
        draw(q);
        std::vector<std::pair<float, int>> all;
        for (int i = 0; i < n; ++i) {
            float sum = 0;
            for (std::size_t k = 0; k < q.size(); ++k) {
                float d = std::fabs(rows[std::size_t(i)][k] - q[k]);
                if (wraps[k]) d = std::min(d, float(2 * pi) - d);
                sum += d * d;
            }
            all.push_back({sum, i});
        }
        std::sort(all.begin(), all.end());
        for (const int most : {0, 1, 3, 8, 100}) {
            std::vector<NearRow> found(std::size_t(most) + 1);
            const int count = kernels::find_nearest_rows(tree.blocks(), n, width, q.data(), wraps.data(),
                                                         most, found.data());
            CHECK(count == std::min(most, n));
            for (int i = 0; i < count; ++i) {
                CHECK(found[std::size_t(i)].row == all[std::size_t(i)].second);
                CHECK_NEAR(found[std::size_t(i)].square, all[std::size_t(i)].first, 1e-4);
            }
        }
    }
}

TEST(pairs_are_those_of_the_lists) {
    check::Random random(2);
    for (int trial = 0; trial < 100; ++trial) {
        const std::int32_t n = 1 + std::int32_t(random.uniform(0, 20));
        std::vector<std::vector<std::int32_t>> lists(static_cast<std::size_t>(n));
        std::vector<NodePair> expected;
        for (std::int32_t i = 0; i < n; ++i)
            for (std::int32_t j = 0; j < n; ++j)
                if (random.uniform(0, 1) < 0.3) {
                    lists[std::size_t(i)].push_back(j);
                    if (i != j) expected.push_back({std::max(i, j), std::min(i, j)});
                }
        std::sort(expected.begin(), expected.end());
        expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
        const auto pairs =
            choose_pairs(n, false, [&](std::int32_t i, auto& near) { near = lists[std::size_t(i)]; });
        CHECK(pairs == expected);
        Components parts(static_cast<std::size_t>(n));
        std::vector<std::int32_t> label(static_cast<std::size_t>(n));
        for (std::int32_t i = 0; i < n; ++i) label[std::size_t(i)] = i;
        for (std::size_t k = 0; k < pairs.size(); k += 3) {
            const auto [i, j] = pairs[k];
            parts.join(i, j);
            const std::int32_t from = label[std::size_t(i)], to = label[std::size_t(j)];
            for (std::int32_t& l : label)
                if (l == from) l = to;
        }
        for (std::int32_t i = 0; i < n; ++i)
            for (std::int32_t j = 0; j < n; ++j)
                CHECK((parts.find(i) == parts.find(j)) == (label[std::size_t(i)] == label[std::size_t(j)]));
        std::sort(label.begin(), label.end());
        CHECK(parts.count() == std::size_t(std::unique(label.begin(), label.end()) - label.begin()));
    }
    CHECK(star_neighbours(1000, 2) == 29 && star_neighbours(10000, 7) == 29 && star_neighbours(0, 0) > 0);
}

TEST(ways_over_free_edges_are_shortest_however_many_are_known) {
    check::Random random(3);
    int found = 0;
    for (int trial = 0; trial < 600; ++trial) {
        const std::size_t nodes = 2 + std::size_t(random.uniform(0, 40));
        RandomGraph graph(random, nodes, trial % 3 == 0 ? 0.0 : trial % 3 == 1 ? 0.5 : 1.0);
        std::vector<std::uint8_t> starts(nodes, 0);
        for (int k = 0; k < 2; ++k) starts[std::size_t(random.uniform(0, double(nodes) - 1e-9))] = 1;
        double best = inf;
        const std::vector<double> from_start = graph.distances(starts, false);
        for (std::size_t k = 0; k < nodes; ++k)
            if (graph.goals[k]) best = std::min(best, from_start[k]);
        ShortestWay<RandomGraph> way(graph, nodes);
        for (std::uint32_t k = 0; k < nodes; ++k)
            if (starts[k]) way.add_start(k);
        const auto end = way.run();
        CHECK((end == ShortestWay<RandomGraph>::End::found) == (best < inf));
        if (best == inf) continue;
        ++found;
        const std::vector<WayArc> arcs = way.arcs();
        double cost = 0;
        for (std::size_t i = 0; i < arcs.size(); ++i) {
            const RandomGraph::Edge& e = graph.edges[arcs[i].edge];
            CHECK(e.is_free &&
                  ((e.a == arcs[i].from && e.b == arcs[i].to) || (e.b == arcs[i].from && e.a == arcs[i].to)));
            CHECK(i == 0 ? starts[arcs[i].from] != 0 : arcs[i].from == arcs[i - 1].to);
            cost += e.length;
            CHECK(cost == arcs[i].cost);
        }
        CHECK(cost == best && (arcs.empty() || graph.goals[arcs.back().to]));
        const std::int64_t needed = graph.checked;
        graph.checked = 0, graph.budget = needed - 1;
        if (needed == 0) continue;
        ShortestWay<RandomGraph> late(graph, nodes);
        for (std::uint32_t k = 0; k < nodes; ++k)
            if (starts[k]) late.add_start(k);
        CHECK(late.run() == ShortestWay<RandomGraph>::End::stopped);
    }
    CHECK(found > 200);
}

TEST(roadmaps_are_the_same_on_any_number_of_threads_and_as_restored) {
    check::Random random(4);
    for (int trial = 0; trial < 5; ++trial) {
        const LoneRobot robot(random);
        const planning::RoadmapRule rule = {400, trial % 2 ? 0 : 7, std::uint64_t(trial)};
        const planning::ArmRoadmap one(robot.space(), rule, nullptr, 1),
            many(robot.space(), rule, nullptr, 3);
        CHECK(one.nodes() == many.nodes() && one.edges() == many.edges());
        const planning::ArmRoadmap read(robot.space(), rule, one.nodes(), one.edges());
        CHECK(one.nodes() == read.nodes() && one.edges() == read.edges());
        CHECK(one.components() == read.components() && one.neighbours() == read.neighbours());
        planning::RoadmapRule less = rule;
        less.samples = 150;
        const planning::ArmRoadmap part(robot.space(), less, nullptr, 1),
            whole(robot.space(), rule, &part, 2);
        CHECK(one.nodes() == whole.nodes() && one.edges() == whole.edges());
    }
}

TEST(roadmaps_that_do_not_fit_are_refused) {
    check::Random random(5);
    const LoneRobot robot(random);
    const planning::RoadmapRule rule = {60, 5, 0};
    const planning::ArmRoadmap made(robot.space(), rule, nullptr, 1);
    const auto is_refused = [&](const planning::RoadmapRule& given, std::vector<double> nodes,
                                std::vector<std::int32_t> edges) {
        try {
            const planning::ArmRoadmap read(robot.space(), given, nodes, edges);
        } catch (const std::invalid_argument&) {
            return true;
        }
        return false;
    };
    const std::vector<double> nodes = made.nodes();
    const auto last = std::int32_t(made.size()) - 1;
    CHECK(last > 3);
    CHECK(!is_refused(rule, nodes, made.edges()) && !is_refused(rule, nodes, {1, 0, last, 0}));
    for (const std::vector<std::int32_t>& edges : std::vector<std::vector<std::int32_t>>{
             {0, 1}, {1, 1}, {last + 1, 0}, {1, -1}, {2, 0, 1, 0}, {1, 0, 1, 0}, {1, 0, 2}})
        CHECK(is_refused(rule, nodes, edges));
    std::vector<double> far = nodes, odd = nodes;
    far[0] = 1e9, odd.pop_back();
    CHECK(is_refused(rule, far, {}) && is_refused(rule, odd, {}));
    far[0] = std::nan("");
    CHECK(is_refused(rule, far, {}) && is_refused({2, 5, 0}, nodes, {}) && is_refused({-1, 5, 0}, {}, {}));
    CHECK(is_refused({60, -1, 0}, nodes, {}));
}

TEST(plans_on_a_roadmap_are_the_same_lazy_or_not_and_whatever_was_planned_before) {
    check::Random random(7);
    int found = 0;
    for (int trial = 0; trial < 12; ++trial) {
        LoneRobot robot(random);
        const std::shared_ptr<const collision::Checker> checker = std::move(robot.cell.checker);
        const std::size_t width = robot.cell.lower.size();
        const planning::ArmSpace space = {*checker, robot.cell.lower, robot.cell.upper, {}};
        const auto map = std::make_shared<const planning::ArmRoadmap>(
            robot.space(), planning::RoadmapRule{150, 6, 0}, nullptr, 1);
        // What the roadmap proves of self-collision is used where the scene allows no pair.
        const auto world = [&] {
            return planning::RoadmapWorld(map, checker, trial % 2 == 0, planning::EdgeTest::proved, 0);
        };
        const planning::RoadmapWorld used = world();
        std::vector<std::vector<double>> ends;
        const auto memory = checker->borrow_workspace();
        for (int i = 0; i < 200 && ends.size() < 6; ++i) {
            ends.push_back(robot.cell.configuration(random));
            if (!checker->is_free(ends.back().data(), *memory)) ends.pop_back();
        }
        std::vector<planning::ArmProblem> problems;
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) problems.push_back({ends[i], ends[i + 1]});
        planning::ArmOptions options;
        options.edges = 3000, options.simplify = trial % 3 != 0;
        const auto plans = planning::plan_each_on_roadmap(space, problems, options, used, true, 2);
        for (std::size_t i = 0; i < problems.size(); ++i) {
            const auto alone = planning::plan_on_roadmap(space, problems[i], options, world(), true);
            const auto full = planning::plan_on_roadmap(space, problems[i], options, used, false);
            CHECK(plans[i].status == alone.status && plans[i].path == alone.path);
            CHECK(plans[i].stats.edges == alone.stats.edges && alone.stats.edges <= options.edges);
            if (full.status != planning::PlanStatus::edge_budget) CHECK(full.path == alone.path);
            if (alone.status != planning::PlanStatus::found) continue;
            ++found;
            CHECK(alone.certified && alone.cost <= alone.raw_cost * (1 + 1e-12));
            for (std::size_t k = 0; k + width < alone.path.size(); k += width)
                for (int step = 0; step <= 50; ++step) {
                    std::vector<double> q(width);
                    for (std::size_t j = 0; j < width; ++j)
                        q[j] =
                            alone.path[k + j] + step / 50.0 * (alone.path[k + width + j] - alone.path[k + j]);
                    CHECK(checker->clearance(q.data()).distance > -1e-5);
                }
        }
        const auto [nodes, edges] = used.count_known();
        CHECK(std::size_t(nodes) <= map->size() && std::size_t(edges) <= map->edge_count());
    }
    CHECK(found > 10);
}

TEST(making_and_searching_heed_interrupts) {
    check::Random random(6);
    const LoneRobot robot(random);
    static int calls;
    for (const int threads : {1, 2}) {
        calls = 0;
        set_interrupt_check([] {
            if (++calls == 3) throw std::runtime_error("stop");
        });
        bool is_stopped = false;
        try {
            const planning::ArmRoadmap made(robot.space(), {100000, 0, 0}, nullptr, threads);
        } catch (const std::runtime_error&) {
            is_stopped = true;
        }
        set_interrupt_check(nullptr);
        CHECK(is_stopped);
    }
}
