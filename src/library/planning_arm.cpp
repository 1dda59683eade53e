#include "planning_arm.hpp"

#include <algorithm>
#include <optional>

#include "cspace/planning/aorrtc.hpp"
#include "cspace/planning/rrt_connect.hpp"
#include "planning_arm_query.hpp"

namespace cspace::planning {

namespace {

class ConnectSearch {
  public:
    ConnectSearch(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options)
        : query_(space, problem, options), options_(options) {}

    ArmPlan run() {
        if (query_.check_ends()) {
            has_more_goals_ = query_.free_goals() > first_goals;
            if (has_more_goals_) query_.sort_goals();
            plant_roots(has_more_goals_ ? first_goals : query_.free_goals());
            query_.plan().status = search();
            write_stats();
        }
        return query_.take_plan();
    }

  private:
    using Trees = RrtConnect<ArmEdges>;
    // Of more goals the nearest ones are tried alone first: a path to them is shorter.
    static constexpr std::size_t first_goals = 3;
    static constexpr std::int64_t first_edges = 2048;  // with them; about two milliseconds

    ArmQuery query_;
    const ArmOptions& options_;
    std::optional<Trees> trees_;
    bool has_more_goals_ = false;  // than the trees have

    ArmStats& stats() { return query_.plan().stats; }

    void plant_roots(std::size_t goals) {
        trees_.emplace(query_.edges(), halton_table(int(query_.width())), options_.seed, options_.range);
        query_.each_start([&](const float* q) { trees_->add_start(q); });
        query_.each_of_first_goals(goals, [&](const float* q) { trees_->add_goal(q); });
    }
    // Grows new trees from all roots.
    void add_other_goals() {
        count_edges();
        has_more_goals_ = false;
        plant_roots(query_.free_goals());
    }

    PlanStatus search() {
        using Finish = ArmQuery::Finish;
        while (true) {
            const SearchEnd end = grow_trees();
            if (end == SearchEnd::edge_budget && has_more_goals_) {
                add_other_goals();
                continue;
            }
            if (end == SearchEnd::edge_budget) return give_up(PlanStatus::edge_budget);
            if (end == SearchEnd::no_time) return give_up(PlanStatus::time_limit);
            write_path(*trees_);
            const Finish finish = query_.finish_path([&](std::size_t i) { trees_->remove_edge(i); });
            if (finish == Finish::late) return give_up(PlanStatus::time_limit);
            if (finish == Finish::edge_removed) continue;
            if (options_.improve > 0) improve();
            return PlanStatus::found;
        }
    }
    SearchEnd grow_trees() {
        const StageTimer timer(stats().search_seconds);
        const std::int64_t left = options_.edges - stats().edges;
        return trees_->run(has_more_goals_ ? std::min(first_edges, left) : left);
    }
    // Roots are the first nodes.
    template <class AnyTrees>
    void write_path(const AnyTrees& trees) {
        const auto& nodes = trees.path();
        query_.write_path(
            nodes.front().node, nodes.back().node, nodes.size() - 2,
            [&](std::size_t i, float* q) { trees.tree(nodes[i + 1].tree).copy_row(nodes[i + 1].node, q); });
    }

    // Looks for shorter paths, below the cost of the last one, as long as the budget lasts.
    void improve() {
        const StageTimer timer(stats().improve_seconds);
        ArmEdges& edges = query_.edges();
        InformedSamples samples(edges.box(), options_.seed);
        std::int64_t left = options_.improve;
        while (left > 0) {
            CostBoundedTrees<ArmEdges> trees(edges, samples, options_.range);
            query_.each_start([&](const float* q) { trees.add_start(q); });
            query_.each_goal([&](const float* q) { trees.add_goal(q); });
            const std::int64_t before = edges.answer_edges();
            const SearchEnd end = trees.run(float(query_.plan().cost), left);
            if (end == SearchEnd::met && query_.keep_shorter([&] { write_path(trees); }, [](std::size_t) {}))
                ++stats().improvements;
            left -= trees.counts().edges + edges.answer_edges() - before;
            stats().samples += trees.counts().samples, stats().edges += trees.counts().edges;
            stats().blocked += trees.counts().blocked;
            if (end != SearchEnd::met) return;
        }
    }
    PlanStatus give_up(PlanStatus status) {
        return query_.give_up(status, trees_->least_distance(), trees_->nearest_row(0).data(),
                              trees_->nearest_row(1).data());
    }
    // Adds what the trees did to the statistics.
    void count_edges() {
        const Trees::Counts& counts = trees_->counts();
        stats().samples += counts.samples, stats().rejected += counts.rejected;
        stats().edges += counts.edges, stats().blocked += counts.blocked;
    }
    void write_stats() {
        count_edges();
        stats().nodes = trees_->tree(0).size() + trees_->tree(1).size();
    }
};

}  // namespace

ArmPlan plan_arm(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options) {
    return run_search<ConnectSearch>(space, problem, options);
}

std::vector<ArmPlan> plan_arms(const ArmSpace& space, std::span<const ArmProblem> problems,
                               const ArmOptions& options, int threads) {
    return run_searches<ConnectSearch>(space, problems, options, threads);
}

}  // namespace cspace::planning
