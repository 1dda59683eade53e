// Plans by a tree from the starts: RRT, RRT* and informed RRT*.
#include "cspace/planning/tree_space.hpp"
#include "cspace/search/random_tree.hpp"
#include "planning_arm.hpp"
#include "planning_arm_query.hpp"

namespace cspace::planning {

namespace {

class TreeSearch {
  public:
    TreeSearch(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
               const TreeOptions& tree)
        : query_(space, problem, options),
          options_(options),
          is_optimal_(tree.is_optimal),
          space_(query_.edges(), halton_table(int(query_.width())), options.seed, options.range,
                 tree.is_informed),
          tree_(space_, {tree.goal_bias, search::TreeGrowth::any_reach, tree.is_optimal}) {}

    ArmPlan run() {
        if (query_.check_ends()) query_.plan().status = search();
        write_stats();
        return query_.take_plan();
    }

  private:
    using Space = TreeSpace<ArmEdges>;
    using Finish = ArmQuery::Finish;
    // A path counts as shorter by this share.
    static constexpr double least_gain = 1e-3;
    // So many samples may be drawn in vain.
    static constexpr std::int64_t samples_per_edge = 1000;

    ArmQuery query_;
    const ArmOptions& options_;
    const bool is_optimal_;
    Space space_;
    search::RandomTree<Space> tree_;
    std::vector<int> path_;  // nodes, a start first

    ArmStats& stats() { return query_.plan().stats; }

    PlanStatus search() {
        add_roots();
        while (true) {
            if (!find_path())
                return give_up(query_.edges().is_late() ? PlanStatus::time_limit : PlanStatus::edge_budget);
            write_path();
            const Finish finish = query_.finish_path([&](std::size_t i) { remove_edge(i); });
            if (finish == Finish::late) return give_up(PlanStatus::time_limit);
            if (finish == Finish::edge_removed) continue;
            if (is_optimal_) improve();
            return PlanStatus::found;
        }
    }
    void add_roots() {
        const auto as_place = [&](const float* q) {
            typename Space::Place place;
            std::copy_n(q, query_.width(), place.begin());
            return place;
        };
        query_.each_goal([&](const float* q) { space_.add_goal(as_place(q)); });
        query_.each_start([&](const float* q) { tree_.add_root(as_place(q)); });
        space_.list_pairs();
        if (options_.edges > 0) tree_.try_roots();
    }
    bool find_path() {
        const StageTimer timer(stats().search_seconds);
        while (!tree_.has_path() && space_.counts().edges < options_.edges && query_.edges().has_time())
            tree_.grow();
        return tree_.has_path();
    }

    // Grows on, simplifies and proves each path that is shorter than the last, as long as the budget lasts.
    void improve() {
        const StageTimer timer(stats().improve_seconds);
        const std::int64_t first = checked_edges();
        const std::int64_t most_samples = space_.counts().samples + samples_per_edge * options_.improve;
        double last = tree_.goal_cost();
        while (checked_edges() - first < options_.improve && space_.counts().samples < most_samples &&
               query_.plan().cost > (1 + least_gain) * space_.least_cost() && query_.edges().has_time()) {
            tree_.grow(std::min(tree_.goal_cost(), query_.plan().cost));
            if (!(tree_.goal_cost() < (1 - least_gain) * last)) continue;
            last = tree_.goal_cost();
            stats().improvements +=
                query_.keep_shorter([&] { write_path(); }, [&](std::size_t i) { remove_edge(i); });
        }
    }
    std::int64_t checked_edges() { return space_.counts().edges + query_.edges().answer_edges(); }

    void write_path() {
        path_.clear();
        for (int n = tree_.last(); n >= 0; n = tree_.parent(n)) path_.push_back(n);
        std::reverse(path_.begin(), path_.end());
        query_.write_path(path_.front(), tree_.goal(), path_.size() - 1,
                          [&](std::size_t i, float* q) { space_.nodes().copy_row(path_[i + 1], q); });
    }
    void remove_edge(std::size_t i) {
        query_.edges().prove_search();
        if (i + 1 < path_.size())
            tree_.remove_branch(path_[i + 1]);
        else
            tree_.forget_path();
    }

    // Names the node nearest to a goal.
    PlanStatus give_up(PlanStatus status) {
        search::NearRow least = {0, std::numeric_limits<float>::infinity()};
        int goal = 0;
        for (int g = 0; g < space_.goals(); ++g) {
            const search::NearRow near = query_.edges().find_nearest(space_.nodes(), space_.goal(g).data());
            if (near.square < least.square) least = near, goal = g;
        }
        return query_.give_up(status, std::sqrt(least.square), space_.place(least.row).data(),
                              space_.goal(goal).data());
    }
    void write_stats() {
        const Space::Counts& counts = space_.counts();
        stats().samples = counts.samples, stats().edges = counts.edges, stats().blocked = counts.blocked;
        stats().nodes = tree_.size();
    }
};

void check_tree(const TreeOptions& tree) {
    require(tree.goal_bias >= 0 && tree.goal_bias <= 1, "the goal bias must lie between 0 and 1");
}

}  // namespace

ArmPlan plan_arm(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
                 const TreeOptions& tree) {
    check_tree(tree);
    return run_search<TreeSearch>(space, problem, options, tree);
}

std::vector<ArmPlan> plan_arms(const ArmSpace& space, std::span<const ArmProblem> problems,
                               const ArmOptions& options, int threads, const TreeOptions& tree) {
    check_tree(tree);
    return run_searches<TreeSearch>(space, problems, options, threads, tree);
}

}  // namespace cspace::planning
