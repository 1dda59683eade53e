#include "planning_arm_grid.hpp"

#include <algorithm>

#include "cspace/planning/grid_search.hpp"
#include "planning_arm_potential.hpp"
#include "planning_arm_query.hpp"

namespace cspace::planning {

namespace {

// What is left from a configuration to the nearest goal.
class GridEstimate {
  public:
    GridEstimate(const ArmSpace& space, const GridRule& rule, const GoalRows& goals)
        : rule_(rule),
          is_greedy_(GridOrder(rule.order) == GridOrder::best_first),
          goals_(goals),
          gains_{1, rule.k_r, rule.rho_0, 1},
          pairs_(space.checker.robot_data(), space.checker.scene(), space.checker.scene_data(), rule.rho_0,
                 0.0) {}

    double operator()(const float* q) {
        if (GridOrder(rule_.order) == GridOrder::breadth_first) return goals_.find_nearest(q).second;
        const double left = goals_.find_nearest(q).second;
        if (!rule_.has_potential) return is_greedy_ ? left : rule_.weight * left;
        const double potential = rule_.scale * (left + repulsion(q));
        return is_greedy_ ? potential : std::min(potential, rule_.weight * left);
    }

  private:
    static constexpr double least_rho = 1e-9;  // [m]: closer is contact, and the cap holds

    const GridRule& rule_;
    bool is_greedy_;
    const GoalRows& goals_;
    search::Gains gains_;
    collision::NearPairs pairs_;

    double repulsion(const float* q) {
        double row[most_grid_joints], least = rule_.rho_0;
        std::copy_n(q, goals_.width(), row);
        pairs_.visit(row, [&](const collision::Contact&, double rho, std::span<const double>) {
            least = std::min(least, rho);
        });
        return std::min(gains_.repulsion(std::max(least, least_rho)), rule_.cap);
    }
};

// The arm as the search over its grid knows it.
class GridArm {
  public:
    GridArm(const ArmSpace& space, const GridRule& rule, ArmEdges& edges, const GoalRows& goals)
        : checker_(space.checker), edges_(edges), goals_(goals), estimate_(space, rule, goals) {}

    std::size_t width() const { return goals_.width(); }
    double distance(const float* a, const float* b) const {
        double sum = 0;
        for (std::size_t k = 0; k < width(); ++k) {
            double d = double(b[k]) - double(a[k]);
            if (goals_.is_wrapping(k)) d = short_way(d);
            sum += d * d;
        }
        return std::sqrt(sum);
    }
    bool is_free(const float* a, const float* b) { return edges_.is_free(a, b); }
    bool has_time() { return edges_.has_time(); }
    double estimate(const float* q) { return estimate_(q); }
    void check_rows(const std::vector<float>& rows, std::vector<std::uint8_t>& blocked) {
        rows_.assign(rows.begin(), rows.end());
        checker_.check_rows(rows_.data(), blocked.size(), blocked.data(), 1);
    }

  private:
    const collision::Checker& checker_;
    ArmEdges& edges_;
    const GoalRows& goals_;
    GridEstimate estimate_;
    std::vector<double> rows_;
};

class SearchOnGrid {
  public:
    SearchOnGrid(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
                 const GridRule& rule)
        : space_(space),
          options_(options),
          rule_(rule),
          query_(space, problem, options),
          grid_(query_.edges().box(), rule.cells) {}

    ArmPlan run() {
        if (query_.check_ends()) query_.plan().status = search();
        return query_.take_plan();
    }

  private:
    using Search = GridSearch<GridArm>;

    const ArmSpace& space_;
    const ArmOptions& options_;
    const GridRule& rule_;
    ArmQuery query_;
    JointGrid grid_;

    ArmStats& stats() { return query_.plan().stats; }

    GoalRows read_goals() const {
        std::vector<double> rows;
        query_.each_goal([&](const float* q) { rows.insert(rows.end(), q, q + query_.width()); });
        return {space_, std::move(rows)};
    }
    PlanStatus search() {
        const GoalRows goals = read_goals();
        GridArm arm(space_, rule_, query_.edges(), goals);
        const bool reopens = rule_.has_potential;
        Search search(arm, grid_, GridOrder(rule_.order), reopens, rule_.reach);
        query_.each_start([&](const float* q) { search.add_start(q); });
        query_.each_goal([&](const float* q) { search.add_goal(q); });
        const PlanStatus status = find_path(search);
        stats().edges = search.edges(), stats().blocked = search.blocked();
        stats().nodes = search.reached(), stats().expansions = std::int64_t(search.expansions());
        return status == PlanStatus::found ? status : give_up(search, goals, status);
    }
    PlanStatus find_path(Search& search) {
        using Finish = ArmQuery::Finish;
        while (true) {
            if (!run_search(search))
                return query_.edges().is_late()   ? PlanStatus::time_limit
                       : search.is_out_of_edges() ? PlanStatus::edge_budget
                                                  : PlanStatus::disconnected;
            const std::vector<std::uint32_t> path = search.path();
            query_.write_path(int(search.start_of(path.front())), int(search.goal_of(path.back())),
                              path.size() - 2,
                              [&](std::size_t i, float* q) { search.write_row(path[i + 1], q); });
            const Finish finish =
                query_.finish_path([&](std::size_t i) { search.ban_edge(path[i], path[i + 1]); });
            if (finish == Finish::accepted) return PlanStatus::found;
            if (finish == Finish::late) return PlanStatus::time_limit;
        }
    }
    bool run_search(Search& search) {
        const StageTimer timer(stats().search_seconds);
        return search.run(options_.edges);
    }
    PlanStatus give_up(const Search& search, const GoalRows& goals, PlanStatus status) {
        ArmQuery::Row from = {}, to = {};
        if (search.nearest() == search::no_node) {  // the time was over at the start
            query_.each_start([&](const float* q) { std::copy_n(q, query_.width(), from.data()); });
        } else {
            search.write_row(search.nearest(), from.data());
        }
        const auto [goal, distance] = goals.find_nearest(from.data());
        for (std::size_t k = 0; k < query_.width(); ++k)
            to[k] = float(double(from[k]) + goals.difference(goal, k, double(from[k])));
        return query_.give_up(status, float(distance), from.data(), to.data());
    }
};

void check_rule(const GridRule& rule) {
    require(rule.order >= 0 && rule.order <= int(GridOrder::breadth_first), "the order has no such number");
    require(rule.reach >= 1 && rule.weight >= 0 && rule.scale >= 0 && rule.k_r >= 0 && rule.rho_0 > 0 &&
                rule.cap >= 0,
            "a grid takes positive numbers");
}

}  // namespace

ArmPlan plan_on_grid(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
                     const GridRule& rule) {
    check_rule(rule);
    return run_search<SearchOnGrid>(space, problem, options, rule);
}

std::vector<ArmPlan> plan_each_on_grid(const ArmSpace& space, std::span<const ArmProblem> problems,
                                       const ArmOptions& options, const GridRule& rule, int threads) {
    check_rule(rule);
    return run_searches<SearchOnGrid>(space, problems, options, threads, rule);
}

}  // namespace cspace::planning
