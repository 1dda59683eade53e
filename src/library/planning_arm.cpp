#include "planning_arm.hpp"

#include "cspace/planning/aorrtc.hpp"
#include "cspace/planning/rrt_connect.hpp"
#include "planning_arm_query.hpp"

namespace cspace::planning {

namespace {

class ConnectSearch {
  public:
    ConnectSearch(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options)
        : query_(space, problem, options),
          options_(options),
          trees_(query_.edges(), halton_table(int(query_.width())), options.seed, options.range) {}

    ArmPlan run() {
        if (query_.check_ends()) {
            query_.each_start([&](const float* q) { trees_.add_start(q); });
            query_.each_goal([&](const float* q) { trees_.add_goal(q); });
            query_.plan().status = search();
        }
        write_stats();
        return query_.take_plan();
    }

  private:
    using Trees = RrtConnect<ArmEdges>;

    ArmQuery query_;
    const ArmOptions& options_;
    Trees trees_;

    ArmStats& stats() { return query_.plan().stats; }

    PlanStatus search() {
        using Finish = ArmQuery::Finish;
        while (true) {
            const SearchEnd end = grow_trees();
            if (end == SearchEnd::edge_budget) return give_up(PlanStatus::edge_budget);
            if (end == SearchEnd::no_time) return give_up(PlanStatus::time_limit);
            write_path(trees_);
            const Finish finish = query_.finish_path([&](std::size_t i) { trees_.remove_edge(i); });
            if (finish == Finish::late) return give_up(PlanStatus::time_limit);
            if (finish == Finish::edge_removed) continue;
            if (options_.improve > 0) improve();
            return PlanStatus::found;
        }
    }
    SearchEnd grow_trees() {
        const StageTimer timer(stats().search_seconds);
        return trees_.run(options_.edges);
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
            if (end == SearchEnd::met && query_.keep_shorter([&] { write_path(trees); }))
                ++stats().improvements;
            left -= trees.counts().edges + edges.answer_edges() - before;
            stats().samples += trees.counts().samples, stats().edges += trees.counts().edges;
            stats().blocked += trees.counts().blocked;
            if (end != SearchEnd::met) return;
        }
    }
    PlanStatus give_up(PlanStatus status) {
        return query_.give_up(status, trees_.least_distance(), trees_.nearest_row(0).data(),
                              trees_.nearest_row(1).data());
    }
    void write_stats() {
        const Trees::Counts& counts = trees_.counts();
        stats().samples += counts.samples, stats().rejected = counts.rejected;
        stats().edges += counts.edges, stats().blocked += counts.blocked;
        stats().nodes = trees_.tree(0).size() + trees_.tree(1).size();
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
