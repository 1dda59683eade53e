#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cspace/planning/rrt_connect.hpp"
#include "planning_arm_query.hpp"
#include "planning_arm_roadmap_state.hpp"

namespace cspace::planning {

namespace {

using search::EdgeState;
using search::NearRow;
using search::WayArc;

// Nodes: the samples, then starts, goals and what trees from them add. Edges: those of the roadmap, then
// those of the ends.
class RoadmapQuery {
  public:
    RoadmapQuery(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
                 const RoadmapWorld& world, bool is_lazy)
        : query_(space, problem, options),
          options_(options),
          world_(world.state()),
          map_(world_.roadmap->state()),
          bounds_(space),
          map_space_{*world_.map_checker, space.lower, space.upper, space.wraps},
          map_edges_(map_space_, options, bounds_),
          is_lazy_(is_lazy) {}

    ArmPlan run() {
        if (query_.check_ends()) {
            query_.each_start([&](const float* q) { add_end(q), ++starts_; });
            query_.each_goal([&](const float* q) { add_end(q), ++goals_; });
            query_.plan().status = search();
        }
        stats().nodes = std::int64_t(nodes());
        ArmPlan plan = query_.take_plan();
        plan.stats.blocks += map_edges_.blocks();
        map_edges_.tally().write_most(plan);
        return plan;
    }

    // The interface of a graph for ShortestWay. What is known from plans before is not used to choose edges:
    // a plan is the same whatever came before it.
    static constexpr bool is_known(std::uint32_t) { return false; }
    bool is_goal(std::uint32_t node) const { return node >= first_goal() && node < first_goal() + goals_; }
    double bound(std::uint32_t node) {
        float& least = bounds_to_goal_[node];
        if (least < 0) {
            least = std::numeric_limits<float>::max();
            for (std::size_t g = first_goal(); g < first_goal() + goals_; ++g)
                least = std::min(least, box().distance(row(node), row(g)));
        }
        return least;
    }
    template <class Visit>
    void each_arc(std::uint32_t node, const Visit& visit) const {
        if (node < samples())
            for (const search::RoadmapArc& arc : map_.arcs.of(node))
                visit(std::uint32_t(arc.to), std::uint32_t(arc.edge), map_.lengths[std::size_t(arc.edge)]);
        for (std::int32_t k = heads_[node]; k >= 0; k = end_edges_[std::size_t(k)].next) {
            const EndEdge& edge = end_edges_[std::size_t(k)];
            visit(edge.to, std::uint32_t(map_.pairs.size()) + std::uint32_t(k), edge.length);
        }
    }
    EdgeState check(const WayArc& arc) {
        if (std::find(removed_.begin(), removed_.end(), arc.edge) != removed_.end())
            return EdgeState::blocked;
        return check_edge(arc.edge, arc.to, is_lazy_ || is_of_end(arc.edge));
    }

  private:
    // An edge from a start, to a goal or of a tree; next: of those that leave the same node.
    struct EndEdge {
        std::uint32_t from, to;
        float length;
        std::int32_t next;
        EdgeState state = EdgeState::unknown;
    };
    using Search = search::ShortestWay<RoadmapQuery>;
    // An end is joined to free nodes. Where so many times as many are near and not free, to fewer.
    static constexpr std::size_t widest_search = 16;

    ArmQuery query_;
    const ArmOptions& options_;
    RoadmapWorld::State& world_;
    const ArmRoadmap::State& map_;
    const FloatBounds bounds_;
    const ArmSpace map_space_;
    ArmEdges map_edges_;  // checks those of the roadmap
    const bool is_lazy_;
    std::size_t starts_ = 0, goals_ = 0;
    std::vector<float> ends_, bounds_to_goal_;
    std::vector<std::int32_t> heads_;     // per node its first edge to or from an end, −1 if none
    std::vector<EndEdge> end_edges_;      // first those that lead from starts to goals
    std::vector<std::size_t> near_;       // the free nodes near to the ends of a side
    std::vector<std::uint32_t> removed_;  // edges whose proof as a part of the answer failed
    PlanStatus stopped_ = PlanStatus::time_limit;

    const Box& box() const { return bounds_.box(); }
    ArmStats& stats() { return query_.plan().stats; }
    std::size_t samples() const { return map_.size(); }
    std::size_t first_goal() const { return samples() + starts_; }
    std::size_t nodes() const { return samples() + ends_.size() / map_.width; }
    bool is_of_end(std::uint32_t edge) const { return edge >= map_.pairs.size(); }
    EndEdge& end_edge(std::uint32_t edge) { return end_edges_[edge - map_.pairs.size()]; }
    const float* row(std::size_t node) const {
        return node < samples() ? map_.row(node) : ends_.data() + (node - samples()) * map_.width;
    }
    void add_end(const float* q) { ends_.insert(ends_.end(), q, q + map_.width); }
    bool has_time() { return query_.edges().has_time() && map_edges_.has_time(); }

    PlanStatus search() {
        using Finish = ArmQuery::Finish;
        if (!prepare()) return give_up(stopped_, nullptr);
        while (true) {
            Search way(*this, nodes());
            const Search::End end = find_way(way);
            if (end == Search::End::stopped) return give_up(stopped_, &way);
            if (end == Search::End::none) return give_up(PlanStatus::disconnected, &way);
            const std::vector<WayArc> arcs = way.arcs();
            write_path(arcs);
            const Finish finish =
                query_.finish_path([&](std::size_t i) { removed_.push_back(arcs[i].edge); });
            if (finish == Finish::late) return give_up(PlanStatus::time_limit, &way);
            if (finish == Finish::accepted) return PlanStatus::found;
        }
    }
    Search::End find_way(Search& way) {
        const StageTimer timer(stats().search_seconds);
        for (std::size_t s = 0; s < starts_; ++s) way.add_start(std::uint32_t(samples() + s));
        return way.run();
    }
    void write_path(const std::vector<WayArc>& arcs) {
        query_.write_path(int(arcs.front().from - samples()), int(arcs.back().to - first_goal()),
                          arcs.size() - 1,
                          [&](std::size_t i, float* q) { std::copy_n(row(arcs[i].to), map_.width, q); });
    }

    // Joins the ends; without laziness checks all edges. False if time or budget is over.
    bool prepare() {
        const StageTimer timer(stats().search_seconds);
        heads_.assign(nodes(), -1);
        bounds_to_goal_.assign(nodes(), -1.0f);
        add_straight_edges();
        const EdgeState shortest = find_free(0, 1);
        if (shortest != EdgeState::blocked) return shortest == EdgeState::free;
        const std::size_t end_of_starts = first_goal(), end_of_goals = nodes();
        if (!join_side(0, samples(), end_of_starts) || !join_side(1, end_of_starts, end_of_goals))
            return false;
        bounds_to_goal_.assign(nodes(), -1.0f);
        return is_lazy_ || check_map();
    }
    // From each start to each goal, the shortest first.
    void add_straight_edges() {
        std::vector<std::pair<float, std::pair<std::size_t, std::size_t>>> pairs;
        for (std::size_t s = samples(); s < first_goal(); ++s)
            for (std::size_t g = first_goal(); g < nodes(); ++g)
                pairs.push_back({box().distance(row(s), row(g)), {s, g}});
        sort_polled(pairs);
        for (const auto& [length, ends] : pairs) add_end_edge(ends.first, ends.second);
    }
    // Joins all starts, or all goals; if none of them sees a node, trees lead to those that are near.
    bool join_side(int side, std::size_t first, std::size_t end) {
        const std::size_t before = end_edges_.size();
        near_.clear();
        for (std::size_t k = first; k < end; ++k)
            if (!join_end(k)) return false;
        const EdgeState straight = find_free(0, starts_ * goals_);
        if (straight != EdgeState::blocked) return straight == EdgeState::free;
        const EdgeState joined = find_free(before, end_edges_.size());
        if (joined != EdgeState::blocked || near_.empty()) return joined != EdgeState::unknown;
        return grow_trees(side, first, end);
    }
    // Whether one of these edges of ends is free.
    EdgeState find_free(std::size_t first, std::size_t end) {
        for (std::size_t k = first; k < end; ++k) {
            const EdgeState state = check_edge(std::uint32_t(map_.pairs.size() + k), end_edges_[k].to, true);
            if (state != EdgeState::blocked) return state;
        }
        return EdgeState::blocked;
    }
    // To the nearest nodes that are free, the nearest first.
    bool join_end(std::size_t end) {
        const std::size_t wanted = std::size_t(map_.neighbours);
        const std::size_t most = std::min(samples(), widest_search * wanted);
        std::vector<NearRow> near;
        std::size_t joined = 0, seen = 0;
        for (std::size_t room = wanted; joined < wanted && seen < most; room *= 2) {
            near.resize(std::min(room, most));
            find_nearest(map_.blocks, row(end), box(), near);
            for (; seen < near.size() && joined < wanted; ++seen) {
                if (!has_time()) return stopped_ = PlanStatus::time_limit, false;
                const auto node = std::size_t(near[seen].row);
                if (!is_node_free(node)) continue;
                ++joined;
                near_.push_back(node);
                end < first_goal() ? add_end_edge(end, node) : add_end_edge(node, end);
            }
        }
        return true;
    }
    // RRT-Connect between ends and the free nodes near to them; its path is added to the graph. False if time
    // or budget is over.
    bool grow_trees(int side, std::size_t first, std::size_t end) {
        RrtConnect<ArmEdges> trees(query_.edges(), halton_table(int(map_.width)), options_.seed,
                                   options_.range);
        std::vector<std::size_t> roots[2];
        for (std::size_t k = first; k < end; ++k) roots[side].push_back(k);
        std::sort(near_.begin(), near_.end());
        near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
        roots[1 - side] = near_;
        for (const std::size_t k : roots[0]) trees.add_start(row(k));
        for (const std::size_t k : roots[1]) trees.add_goal(row(k));
        const SearchEnd found = trees.run(options_.edges - stats().edges);
        const auto& counts = trees.counts();
        stats().samples += counts.samples, stats().rejected += counts.rejected;
        stats().edges += counts.edges, stats().blocked += counts.blocked;
        if (found == SearchEnd::edge_budget) stopped_ = PlanStatus::edge_budget;
        if (found == SearchEnd::no_time) stopped_ = PlanStatus::time_limit;
        if (found == SearchEnd::met) add_tree_path(trees, roots);
        return found == SearchEnd::met;
    }
    void add_tree_path(const RrtConnect<ArmEdges>& trees, const std::vector<std::size_t> (&roots)[2]) {
        std::size_t before = 0;
        for (std::size_t i = 0; i < trees.path().size(); ++i) {
            const auto [tree, number] = trees.path()[i];
            const auto& own = roots[tree];
            std::size_t node = nodes();
            if (std::size_t(number) < own.size()) {
                node = own[std::size_t(number)];
            } else {
                ArmQuery::Row q;
                trees.tree(tree).copy_row(number, q.data());
                add_end(q.data());
                heads_.push_back(-1);
            }
            if (i > 0) {
                add_end_edge(before, node);
                end_edges_.back().state = EdgeState::free;
            }
            before = node;
        }
    }
    void add_end_edge(std::size_t from, std::size_t to) {
        const float length = box().distance(row(from), row(to));
        end_edges_.push_back({std::uint32_t(from), std::uint32_t(to), length, heads_[from]});
        heads_[from] = std::int32_t(end_edges_.size()) - 1;
    }
    bool check_map() {
        for (std::uint32_t k = 0; k < map_.pairs.size(); ++k)
            if (check_edge(k, std::uint32_t(map_.pairs[k].second), true) == EdgeState::unknown) return false;
        return true;
    }

    // Whether the node that an edge leads to and the edge are free; unknown if budget or time is over.
    EdgeState check_edge(std::uint32_t edge, std::uint32_t to, bool counts) {
        if (is_of_end(edge) && end_edge(edge).state != EdgeState::unknown) counts = false;
        if (counts && stats().edges >= options_.edges) return stop(PlanStatus::edge_budget);
        if (!has_time()) return stop(PlanStatus::time_limit);
        const bool is_free = (to >= samples() || is_node_free(to)) &&
                             (is_of_end(edge) ? is_end_edge_free(end_edge(edge)) : is_map_edge_free(edge));
        if (counts) ++stats().edges, stats().blocked += !is_free;
        return is_free ? EdgeState::free : EdgeState::blocked;
    }
    EdgeState stop(PlanStatus status) {
        stopped_ = status;
        return EdgeState::unknown;
    }
    // What is known of a node or an edge, or what check() says now.
    template <class Check>
    static bool recall(std::atomic<EdgeState>& known, const Check& check) {
        const EdgeState state = known.load(std::memory_order_relaxed);
        if (state != EdgeState::unknown) return state == EdgeState::free;
        const bool is_free = check();
        known.store(is_free ? EdgeState::free : EdgeState::blocked, std::memory_order_relaxed);
        return is_free;
    }
    bool is_node_free(std::size_t node) {
        return recall(world_.nodes[node], [&] {
            const std::vector<double> q(row(node), row(node) + map_.width);
            Contact contact;
            return map_edges_.is_free(q.data(), contact);
        });
    }
    bool is_map_edge_free(std::uint32_t edge) {
        return recall(world_.edges[edge], [&] {
            const auto [i, j] = map_.pairs[edge];
            return is_node_free(std::size_t(i)) && is_node_free(std::size_t(j)) &&
                   map_edges_.is_free(row(std::size_t(i)), row(std::size_t(j)));
        });
    }
    bool is_end_edge_free(EndEdge& edge) {
        if (edge.state == EdgeState::unknown)
            edge.state =
                query_.edges().is_free(row(edge.from), row(edge.to)) ? EdgeState::free : EdgeState::blocked;
        return edge.state == EdgeState::free;
    }

    // No path: what the start and the goal are joined with, and where they come closest.
    PlanStatus give_up(PlanStatus status, const Search* way) {
        std::vector<std::uint32_t> from_start, from_goal;
        for (std::size_t s = samples(); s < first_goal(); ++s) from_start.push_back(std::uint32_t(s));
        if (way)
            for (std::uint32_t node = 0; node < samples(); ++node)
                if (way->ways().is_settled(node)) from_start.push_back(node);
        for (std::size_t g = 0; g < goals_; ++g) from_goal.push_back(std::uint32_t(first_goal() + g));
        if (status == PlanStatus::disconnected) flood(from_goal);
        const auto count = [&](const std::vector<std::uint32_t>& reached) {
            return std::count_if(reached.begin(), reached.end(), [&](auto node) { return node < samples(); });
        };
        stats().start_nodes = count(from_start), stats().goal_nodes = count(from_goal);
        return give_up_between(status, from_start, from_goal);
    }
    // Adds the nodes that are joined with those given, as far as budget and time allow.
    void flood(std::vector<std::uint32_t>& reached) {
        std::vector<std::uint8_t> is_reached(nodes(), 0);
        const auto reach = [&](std::uint32_t edge, std::uint32_t node) {
            if (is_reached[node] || check_edge(edge, node, true) != EdgeState::free) return;
            is_reached[node] = 1;
            reached.push_back(node);
        };
        const std::size_t map_edges = map_.pairs.size();
        for (std::size_t next = 0; next < reached.size(); ++next) {
            const std::uint32_t node = reached[next];
            if (node < samples()) {
                for (const search::RoadmapArc& arc : map_.arcs.of(node))
                    reach(std::uint32_t(arc.edge), std::uint32_t(arc.to));
                continue;
            }
            for (std::size_t k = 0; k < end_edges_.size(); ++k)
                if (end_edges_[k].to == node) reach(std::uint32_t(map_edges + k), end_edges_[k].from);
        }
    }
    PlanStatus give_up_between(PlanStatus status, const std::vector<std::uint32_t>& from_start,
                               const std::vector<std::uint32_t>& from_goal) {
        const bool is_start_larger = from_start.size() >= from_goal.size();
        const auto& many = is_start_larger ? from_start : from_goal;
        const auto& few = is_start_larger ? from_goal : from_start;
        search::ConfigurationTree rows(int(map_.width));
        for (const std::uint32_t node : many) rows.add(row(node), search::ConfigurationTree::no_parent, 0);
        NearRow least = {0, std::numeric_limits<float>::max()};
        std::uint32_t other = few.front();
        for (const std::uint32_t node : few) {
            poll_interrupts();
            const NearRow near = query_.edges().find_nearest(rows, row(node));
            if (near.square < least.square) least = near, other = node;
        }
        const std::uint32_t found = many[std::size_t(least.row)];
        return query_.give_up(status, std::sqrt(least.square), row(is_start_larger ? found : other),
                              row(is_start_larger ? other : found));
    }
};

void check_world(const ArmSpace& space, const ArmOptions& options, const RoadmapWorld& world) {
    require(&space.checker == &world.checker(), "the space must be that of the roadmap's scene");
    const RoadmapWorld::State& known = world.state();
    require(options.search == known.search &&
                (known.search == EdgeTest::proved || options.resolution == known.resolution),
            "edges must be checked as those of the roadmap before");
}

}  // namespace

RoadmapWorld::RoadmapWorld(std::shared_ptr<const ArmRoadmap> roadmap,
                           std::shared_ptr<const collision::Checker> checker, bool is_self_free,
                           EdgeTest search, float resolution) {
    const ArmRoadmap::State& map = roadmap->state();
    require(map.width == std::size_t(checker->dof()), "the roadmap is that of another robot");
    std::shared_ptr<const collision::Checker> map_checker = checker;
    if (is_self_free) map_checker = checker->ignore_pairs();
    state_.reset(new State{std::move(roadmap), std::move(checker), std::move(map_checker), search, resolution,
                           State::Verdicts(map.size()), State::Verdicts(map.pairs.size())});
}
RoadmapWorld::~RoadmapWorld() = default;

const collision::Checker& RoadmapWorld::checker() const { return *state_->checker; }

std::pair<std::int64_t, std::int64_t> RoadmapWorld::count_known() const {
    const auto count = [](const State::Verdicts& verdicts) {
        return std::count_if(verdicts.begin(), verdicts.end(), [](const std::atomic<EdgeState>& verdict) {
            return verdict.load(std::memory_order_relaxed) != EdgeState::unknown;
        });
    };
    return {count(state_->nodes), count(state_->edges)};
}

ArmPlan plan_on_roadmap(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
                        const RoadmapWorld& world, bool is_lazy) {
    check_world(space, options, world);
    return run_search<RoadmapQuery>(space, problem, options, world, is_lazy);
}

std::vector<ArmPlan> plan_each_on_roadmap(const ArmSpace& space, std::span<const ArmProblem> problems,
                                          const ArmOptions& options, const RoadmapWorld& world, bool is_lazy,
                                          int threads) {
    check_world(space, options, world);
    return run_searches<RoadmapQuery>(space, problems, options, threads, world, is_lazy);
}

}  // namespace cspace::planning
