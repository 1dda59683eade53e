// What every planner of arms does around its search: it checks the ends, and simplifies and proves the path.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "cspace/math/made_once.hpp"
#include "cspace/math/threads.hpp"
#include "cspace/math/wrapping.hpp"
#include "cspace/planning/path.hpp"
#include "cspace/planning/simplify.hpp"
#include "cspace/search/halton.hpp"
#include "planning_arm_edges.hpp"

namespace cspace::planning {

// Adds the time of its life to a number of seconds.
class StageTimer {
  public:
    explicit StageTimer(double& seconds) : seconds_(seconds) {}
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;
    ~StageTimer() { seconds_ += std::chrono::duration<double>(Clock::now() - begin_).count(); }

  private:
    double& seconds_;
    const Clock::time_point begin_ = Clock::now();
};

// A query of a planner. The search works on rows of floats: its roots are the starts and goals that are free.
class ArmQuery {
  public:
    using Row = std::array<float, search::most_dimensions>;

    ArmQuery(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options)
        : space_(space),
          problem_(problem),
          options_(options),
          width_(std::size_t(space.checker.dof())),
          bounds_(space),
          edges_(space, options, bounds_),
          path_(width_) {}

    std::size_t width() const { return width_; }
    const ArmOptions& options() const { return options_; }
    ArmEdges& edges() { return edges_; }
    ArmPlan& plan() { return plan_; }
    const Path& path() const { return path_; }

    // Whether there is a free start and a free goal; else the plan has its status.
    bool check_ends() {
        plan_.starts = report_rows(problem_.starts, starts_);
        plan_.goals = report_rows(problem_.goals, goals_);
        if (starts_.empty())
            plan_.status = PlanStatus::invalid_start;
        else if (goals_.empty())
            plan_.status = PlanStatus::invalid_goals;
        return !starts_.empty() && !goals_.empty();
    }
    // Calls add(row) for each root.
    template <class Add>
    void each_start(const Add& add) const {
        for (const int i : starts_) add(round_row(start_row(i)).data());
    }
    template <class Add>
    void each_goal(const Add& add) const {
        each_of_first_goals(goals_.size(), add);
    }
    template <class Add>
    void each_of_first_goals(std::size_t count, const Add& add) const {
        for (std::size_t k = 0; k < count; ++k) add(round_row(goal_row(goals_[k])).data());
    }
    std::size_t free_goals() const { return goals_.size(); }
    // Orders the roots of the goals by their distance from the nearest start.
    void sort_goals() {
        std::vector<std::pair<float, int>> order;
        for (const int g : goals_) {
            const Row to = round_row(goal_row(g));
            float least = std::numeric_limits<float>::infinity();
            for (const int s : starts_) {
                edges_.has_time();  // polls
                least = std::min(least, edges_.box().distance(round_row(start_row(s)).data(), to.data()));
            }
            order.emplace_back(least, g);
        }
        std::sort(order.begin(), order.end());
        for (std::size_t k = 0; k < order.size(); ++k) goals_[k] = order[k].second;
    }

    // The same in doubles, as given.
    template <class Add>
    void each_given_start(const Add& add) const {
        for (const int i : starts_) add(start_row(i));
    }
    template <class Add>
    void each_given_goal(const Add& add) const {
        for (const int i : goals_) add(goal_row(i));
    }

    // The path of a search, unwound: joints that wrap go on beyond ±π. Between a root of the starts and one
    // of the goals there are `inner` rows; copy(i, q) writes one of them.
    template <class CopyRow>
    void write_path(int start_root, int goal_root, std::size_t inner, const CopyRow& copy) {
        plan_.start = starts_[std::size_t(start_root)];
        plan_.goal = goals_[std::size_t(goal_root)];
        std::vector<double> row(start_row(plan_.start), start_row(plan_.start) + width_);
        path_.clear();
        path_.append(row.data(), Path::checked);
        Row to;
        for (std::size_t i = 0; i < inner; ++i) {
            copy(i, to.data());
            continue_to(to, row);
            path_.append(row.data(), int(i));
        }
        continue_to_goal(row);
        path_.append(row.data(), int(inner));
    }

    enum class Finish { accepted, edge_removed, late };
    // Simplifies and proves the path. Calls remove_edge(i) for an edge of the search whose proof fails; edges
    // of the search are proved from then on.
    template <class RemoveEdge>
    Finish finish_path(const RemoveEdge& remove_edge) {
        plan_.raw_cost = path_.length();
        if (options_.simplify) simplify();
        const int failed = options_.answer == EdgeTest::sampled ? Path::checked : find_unproved();
        if (edges_.is_late()) return Finish::late;
        if (failed != Path::checked) {
            remove_edge(std::size_t(failed));
            edges_.prove_search();
            ++plan_.stats.removed;
            return Finish::edge_removed;
        }
        accept_path();
        return Finish::accepted;
    }
    // The same of a path that takes the place of a longer one; false if it does not.
    template <class WritePath, class RemoveEdge>
    bool keep_shorter(const WritePath& write, const RemoveEdge& remove_edge) {
        const int start = plan_.start, goal = plan_.goal;
        const std::vector<int> turns = plan_.turns;
        write();
        if (options_.simplify) Simplifier(edges_, path_).run();
        const int failed = options_.answer == EdgeTest::sampled ? Path::checked : find_failing();
        if (failed == Path::checked && path_.length() < plan_.cost) return accept_path(), true;
        plan_.start = start, plan_.goal = goal, plan_.turns = turns;
        if (failed != Path::checked) remove_edge(std::size_t(failed));
        return false;
    }

    // No path; `from` and `to`: the nearest configurations reached from a start and from a goal.
    PlanStatus give_up(PlanStatus status, float distance, const float* from, const float* to) {
        plan_.start = plan_.goal = -1;
        plan_.turns.clear();
        plan_.raw_cost = plan_.cost;
        plan_.approach = {distance, {from, from + width_}, {to, to + width_}};
        return status;
    }
    ArmPlan take_plan() {
        plan_.stats.blocks = edges_.blocks();
        edges_.tally().write_most(plan_);
        return std::move(plan_);
    }

  private:
    const ArmSpace& space_;
    const ArmProblem& problem_;
    const ArmOptions& options_;
    const std::size_t width_;
    const FloatBounds bounds_;
    ArmEdges edges_;
    std::vector<int> starts_, goals_;  // the given rows of the roots
    Path path_;
    ArmPlan plan_;

    const double* start_row(int i) const { return &problem_.starts[std::size_t(i) * width_]; }
    const double* goal_row(int i) const { return &problem_.goals[std::size_t(i) * width_]; }

    std::vector<RowReport> report_rows(std::span<const double> rows, std::vector<int>& free) {
        std::vector<RowReport> reports(rows.size() / width_);
        for (std::size_t i = 0; i < reports.size(); ++i) {
            edges_.has_time();  // polls
            const double* q = &rows[i * width_];
            RowReport& report = reports[i];
            if (!is_within_bounds(q))
                report.state = RowState::out_of_bounds;
            else if (!edges_.is_free(q, report.contact))
                report.state = RowState::in_collision;
            else
                free.push_back(int(i));
        }
        return reports;
    }
    bool is_within_bounds(const double* q) const {
        for (std::size_t k = 0; k < width_; ++k) {
            const bool is_within = edges_.box().is_wrapping(int(k))
                                       ? std::isfinite(q[k])
                                       : q[k] >= space_.lower[k] && q[k] <= space_.upper[k];
            if (!is_within) return false;
        }
        return true;
    }
    Row round_row(const double* q) const {
        Row row = {};
        for (std::size_t k = 0; k < width_; ++k)
            row[k] = float(edges_.box().is_wrapping(int(k)) ? short_way(q[k]) : q[k]);
        return row;
    }

    void continue_to(const Row& to, std::vector<double>& row) const {
        for (std::size_t k = 0; k < width_; ++k) {
            const double x = to[k];
            row[k] = edges_.box().is_wrapping(int(k)) ? x + nearest_multiple(row[k] - x)
                                                      : std::clamp(x, space_.lower[k], space_.upper[k]);
        }
    }
    void continue_to_goal(std::vector<double>& row) {
        const double* goal = goal_row(plan_.goal);
        plan_.turns.assign(width_, 0);
        for (std::size_t k = 0; k < width_; ++k) {
            const double turned = edges_.box().is_wrapping(int(k)) ? nearest_multiple(row[k] - goal[k]) : 0.0;
            row[k] = turned == 0 ? goal[k] : goal[k] + turned;
            plan_.turns[k] = int(count_turns(turned));
        }
    }

    void simplify() {
        const StageTimer timer(plan_.stats.simplify_seconds);
        const std::int64_t before = edges_.answer_edges();
        Simplifier(edges_, path_).run();
        plan_.stats.shortcuts += edges_.answer_edges() - before;
    }
    // The edge of the search whose part has no proof, or `checked`: proves what is left of its edges.
    int find_unproved() {
        const StageTimer timer(plan_.stats.proof_seconds);
        for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
            if (path_.source(i) == Path::checked) continue;
            if (!edges_.has_time()) return path_.source(i);
            ++plan_.stats.proofs;
            if (!edges_.is_free(path_.row(i), path_.row(i + 1))) return path_.source(i);
            path_.set_source(i, Path::checked);
        }
        return Path::checked;
    }
    // The same without a look at the clock, and uncounted.
    int find_failing() {
        for (std::size_t i = 0; i + 1 < path_.size(); ++i)
            if (path_.source(i) != Path::checked && !edges_.is_free(path_.row(i), path_.row(i + 1)))
                return path_.source(i);
        return Path::checked;
    }
    void accept_path() {
        plan_.path = path_.rows();
        plan_.cost = path_.length();
        plan_.certified = options_.answer == EdgeTest::proved;
    }
};

// Of so many dimensions; shared by all searches.
inline const search::HaltonTable& halton_table(int width) {
    static const MadeOnce<search::HaltonTable> tables[search::most_dimensions + 1];
    return tables[width].get([&] { return std::make_unique<search::HaltonTable>(width); });
}

inline void require(bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument(rule);
}

inline void check_space(const ArmSpace& space) {
    const std::size_t width = std::size_t(space.checker.dof());
    require(space.lower.size() == width && space.upper.size() == width,
            "bounds must have one entry per coordinate");
    require(space.wraps.empty() || space.wraps.size() == width, "wraps must have one entry per coordinate");
    for (std::size_t k = 0; k < width; ++k) {
        if (!space.wraps.empty() && space.wraps[k])
            require(space.checker.has_period(int(k)), "only revolute joints wrap");
        else
            require(std::isfinite(space.lower[k]) && std::isfinite(space.upper[k]) &&
                        space.lower[k] <= space.upper[k],
                    "bounds must be finite, the lower not above the upper");
    }
}
inline void check_problem(const ArmSpace& space, const ArmProblem& problem) {
    const std::size_t width = std::size_t(space.checker.dof());
    for (const auto rows : {problem.starts, problem.goals})
        require(width > 0 && !rows.empty() && rows.size() % width == 0,
                "starts and goals must be rows with one entry per coordinate, one row at least");
}
inline void check_options(const ArmOptions& options) {
    require(options.edges >= 0 && options.improve >= 0, "budgets of edges must not be negative");
    require(options.range > 0 && std::isfinite(options.range), "the range must be positive");
    require(options.resolution > 0 && std::isfinite(options.resolution), "the resolution must be positive");
    require(options.time_limit >= 0, "the time limit must not be negative");
}

// A Search is made of a space, a problem and further options, and has run().
template <class Search, class... More>
auto run_search(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options,
                const More&... more) {
    check_space(space), check_options(options), check_problem(space, problem);
    return Search(space, problem, options, more...).run();
}
// Each as if alone, on so many threads (0: all).
template <class Search, class... More>
auto run_searches(const ArmSpace& space, std::span<const ArmProblem> problems, const ArmOptions& options,
                  int threads, const More&... more) {
    check_space(space), check_options(options);
    for (const ArmProblem& problem : problems) check_problem(space, problem);
    std::vector<decltype(std::declval<Search&>().run())> plans(problems.size());
    over_rows(problems.size(), threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        ArmOptions own = options;
        for (; begin < end; ++begin) {
            own.time_limit = std::min(options.time_limit, problems[begin].time_limit);
            plans[begin] = Search(space, problems[begin], own, more...).run();
        }
        return true;
    });
    return plans;
}

}  // namespace cspace::planning
