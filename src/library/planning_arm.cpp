#include "planning_arm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <unordered_map>

#include "cspace/math/interrupts.hpp"
#include "cspace/math/made_once.hpp"
#include "cspace/math/threads.hpp"
#include "cspace/math/wrapping.hpp"
#include "cspace/planning/aorrtc.hpp"
#include "cspace/planning/rrt_connect.hpp"
#include "cspace/planning/simplify.hpp"
#include "kernels/search.hpp"

namespace cspace::planning {

namespace {

using collision::Contact;
using collision::Verdict;
using interrupts::Clock;

const search::HaltonTable& table_of(int width) {
    static const MadeOnce<search::HaltonTable> tables[search::most_dimensions + 1];
    return tables[width].get([&] { return std::make_unique<search::HaltonTable>(width); });
}

// The bounds in floats, none outside of those given; joints that wrap have their whole period.
class FloatBounds {
  public:
    explicit FloatBounds(const ArmSpace& space) {
        const int width = space.checker.dof();
        const bool any_wraps = std::any_of(space.wraps.begin(), space.wraps.end(), [](auto w) { return w; });
        box_ = {width, lower_, upper_, any_wraps ? space.wraps.data() : nullptr};
        for (int k = 0; k < width; ++k) {
            const double low = box_.is_wrapping(k) ? -pi : space.lower[std::size_t(k)];
            const double high = box_.is_wrapping(k) ? pi : space.upper[std::size_t(k)];
            lower_[k] = float(low), upper_[k] = float(high);
            if (lower_[k] < low) lower_[k] = std::nextafter(lower_[k], upper_[k]);
            if (upper_[k] > high) upper_[k] = std::nextafter(upper_[k], lower_[k]);
        }
    }
    FloatBounds(const FloatBounds&) = delete;
    FloatBounds& operator=(const FloatBounds&) = delete;
    const Box& box() const { return box_; }

  private:
    float lower_[collision::most_coordinates], upper_[collision::most_coordinates];
    Box box_;
};

// How often each pair of a link and what it touched blocked an edge.
class BlockerTally {
  public:
    void add(const Contact& contact) {
        if (!last_ || !is_same(last_->first, contact)) {
            last_ = &counts_[key_of(contact)];
            last_->first = contact;
        }
        ++last_->second;
    }
    // The pair with the greatest count, of equal ones that of the least numbers.
    void write_most(ArmPlan& plan) const {
        std::uint64_t best = 0;
        for (const auto& [key, entry] : counts_)
            if (entry.second > plan.blocker_edges || (entry.second == plan.blocker_edges && key < best))
                plan.blocker = entry.first, plan.blocker_edges = entry.second, best = key;
    }

  private:
    using Entry = std::pair<Contact, std::int64_t>;
    std::unordered_map<std::uint64_t, Entry> counts_;
    Entry* last_ = nullptr;

    static bool is_same(const Contact& a, const Contact& b) {
        return a.link == b.link && a.other == b.other && a.is_pair == b.is_pair;
    }
    static std::uint64_t key_of(const Contact& c) {
        return std::uint64_t(c.is_pair) << 63 | std::uint64_t(c.link) << 32 | std::uint64_t(c.other);
    }
};

// The edges of one problem, and its clock.
class ArmEdges {
  public:
    ArmEdges(const ArmSpace& space, const ArmOptions& options, const FloatBounds& bounds)
        : checker_(space.checker),
          options_(options),
          box_(bounds.box()),
          memory_(checker_.borrow_workspace()),
          is_search_proved_(options.search == EdgeTest::proved) {
        checker_.reset_workspace(*memory_);
        if (options.time_limit < longest_limit)
            deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(options.time_limit));
    }

    const Box& box() const { return box_; }
    search::NearRow find_nearest(const search::ConfigurationTree& tree, const float* q) const {
        return kernels::find_nearest(tree.blocks(), tree.size(), tree.width(), q, box_.wraps);
    }

    search::NearRow find_nearest_within(const search::ConfigurationTree& tree, const float* q,
                                        float bound) const {
        return kernels::find_nearest_within(tree.blocks(), tree.costs(), tree.size(), tree.width(), q,
                                            box_.wraps, bound);
    }

    // An edge of a tree.
    bool is_free(const float* a, const float* b) {
        float end[collision::most_coordinates];
        if (box_.wraps) {
            for (int k = 0; k < box_.width; ++k) end[k] = a[k] + box_.difference(k, a[k], b[k]);
            b = end;
        }
        const Verdict verdict = is_search_proved_ ? checker_.prove_edge(a, b, *memory_)
                                                  : checker_.sample_edge(a, b, options_.resolution, *memory_);
        if (verdict == Verdict::blocked) tally_.add(memory_->w.contact);
        return verdict == Verdict::free;
    }
    // An edge of the answer.
    bool is_free(const double* a, const double* b) {
        ++answer_edges_;
        const Verdict verdict = options_.answer == EdgeTest::proved
                                    ? checker_.prove_edge(a, b, *memory_)
                                    : checker_.sample_edge(a, b, double(options_.resolution), *memory_);
        return verdict == Verdict::free;
    }
    // A configuration; false and what touches.
    bool is_free(const double* q, Contact& contact) {
        if (checker_.is_free(q, *memory_)) return true;
        contact = memory_->w.contact;
        return false;
    }
    // From now on the trees grow by proved edges only.
    void prove_search() { is_search_proved_ = true; }

    // False when the time is over. Looks at the clock about every ten microseconds, and polls.
    bool has_time() {
        constexpr int most_calls = 64;
        constexpr long long most_blocks = 64;
        if (--calls_left_ > 0 && memory_->w.blocks - blocks_seen_ < most_blocks) [[likely]]
            return !is_late_;
        calls_left_ = most_calls;
        blocks_seen_ = memory_->w.blocks;
        poll_interrupts();
        is_late_ = is_late_ || Clock::now() >= deadline_;
        return !is_late_;
    }
    bool is_late() const { return is_late_; }

    std::int64_t blocks() const { return memory_->w.blocks; }
    std::int64_t answer_edges() const { return answer_edges_; }
    const BlockerTally& tally() const { return tally_; }

  private:
    static constexpr double longest_limit = 1e9;  // [s], more is no limit

    const collision::Checker& checker_;
    const ArmOptions& options_;
    const Box& box_;
    collision::Checker::Borrowed memory_;
    bool is_search_proved_, is_late_ = false;
    Clock::time_point deadline_ = Clock::time_point::max();
    int calls_left_ = 0;
    long long blocks_seen_ = 0;
    std::int64_t answer_edges_ = 0;
    BlockerTally tally_;
};

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

class ArmSearch {
  public:
    ArmSearch(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options)
        : space_(space),
          problem_(problem),
          options_(options),
          width_(std::size_t(space.checker.dof())),
          bounds_(space),
          edges_(space, options, bounds_),
          path_(width_) {}

    ArmPlan run() {
        if (check_ends()) plan_.status = search();
        write_stats();
        return std::move(plan_);
    }

  private:
    using Trees = RrtConnect<ArmEdges>;

    const ArmSpace& space_;
    const ArmProblem& problem_;
    const ArmOptions& options_;
    const std::size_t width_;
    const FloatBounds bounds_;
    ArmEdges edges_;
    std::optional<Trees> trees_;
    std::vector<int> starts_, goals_;  // the given rows of the roots
    bool has_more_goals_ = false;      // than the trees have
    Path path_;
    ArmPlan plan_;

    const double* start_row(int i) const { return &problem_.starts[std::size_t(i) * width_]; }
    const double* goal_row(int i) const { return &problem_.goals[std::size_t(i) * width_]; }

    // Of more goals the nearest ones are tried alone first: a path to them is shorter.
    static constexpr std::size_t first_goals = 3;
    static constexpr std::int64_t first_edges = 2048;  // with them; about two milliseconds

    // Roots of the trees are the starts and goals that are free.
    bool check_ends() {
        plan_.starts = report_rows(problem_.starts, starts_);
        plan_.goals = report_rows(problem_.goals, goals_);
        has_more_goals_ = goals_.size() > first_goals;
        if (has_more_goals_) sort_goals();
        plant_roots(has_more_goals_ ? first_goals : goals_.size());
        if (starts_.empty())
            plan_.status = PlanStatus::invalid_start;
        else if (goals_.empty())
            plan_.status = PlanStatus::invalid_goals;
        return !starts_.empty() && !goals_.empty();
    }
    void plant_roots(std::size_t goals) {
        trees_.emplace(edges_, table_of(int(width_)), options_.seed, options_.range);
        for (const int i : starts_) trees_->add_start(round_row(start_row(i)).data());
        for (std::size_t k = 0; k < goals; ++k) trees_->add_goal(round_row(goal_row(goals_[k])).data());
    }
    // By their distance from the nearest start.
    void sort_goals() {
        std::vector<std::pair<float, int>> order;
        for (const int g : goals_) {
            const Trees::Row to = round_row(goal_row(g));
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
    Trees::Row round_row(const double* q) const {
        Trees::Row row = {};
        for (std::size_t k = 0; k < width_; ++k)
            row[k] = float(edges_.box().is_wrapping(int(k)) ? short_way(q[k]) : q[k]);
        return row;
    }

    PlanStatus search() {
        while (true) {
            const SearchEnd end = grow_trees();
            if (end == SearchEnd::edge_budget && has_more_goals_) {
                add_other_goals();
                continue;
            }
            if (end == SearchEnd::edge_budget) return give_up(PlanStatus::edge_budget);
            if (end == SearchEnd::no_time) return give_up(PlanStatus::time_limit);
            write_raw_path(*trees_);
            plan_.raw_cost = path_.length();
            if (options_.simplify) simplify();
            const bool is_whole = options_.answer == EdgeTest::sampled || prove_rest();
            if (edges_.is_late()) return give_up(PlanStatus::time_limit);
            if (!is_whole) continue;
            accept_path();
            if (options_.improve > 0) improve();
            return PlanStatus::found;
        }
    }
    SearchEnd grow_trees() {
        const StageTimer timer(plan_.stats.search_seconds);
        const std::int64_t left = options_.edges - plan_.stats.edges;
        return trees_->run(has_more_goals_ ? std::min(first_edges, left) : left);
    }
    // Grows new trees from all roots.
    void add_other_goals() {
        count_edges();
        has_more_goals_ = false;
        plant_roots(goals_.size());
    }

    // The path of the trees, unwound: joints that wrap go on beyond ±π. Roots are the first nodes.
    template <class AnyTrees>
    void write_raw_path(const AnyTrees& trees) {
        const auto& nodes = trees.path();
        plan_.start = starts_[std::size_t(nodes.front().node)];
        plan_.goal = goals_[std::size_t(nodes.back().node)];
        std::vector<double> row(start_row(plan_.start), start_row(plan_.start) + width_);
        path_.clear();
        path_.append(row.data(), Path::checked);
        for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
            continue_to_node(trees.tree(nodes[i].tree), nodes[i].node, row);
            path_.append(row.data(), int(i - 1));
        }
        continue_to_goal(row);
        path_.append(row.data(), int(nodes.size() - 2));
    }
    void continue_to_node(const search::ConfigurationTree& tree, int node, std::vector<double>& row) const {
        Trees::Row to;
        tree.copy_row(node, to.data());
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
            plan_.turns[k] = int(std::round(turned / (2 * pi)));
        }
    }

    void simplify() {
        const StageTimer timer(plan_.stats.simplify_seconds);
        const std::int64_t before = edges_.answer_edges();
        Simplifier(edges_, path_).run();
        plan_.stats.shortcuts += edges_.answer_edges() - before;
    }

    // Proves what is left of the edges of the trees. One that fails leaves its tree.
    bool prove_rest() {
        const StageTimer timer(plan_.stats.proof_seconds);
        for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
            if (path_.source(i) == Path::checked) continue;
            if (!edges_.has_time()) return false;
            ++plan_.stats.proofs;
            if (!edges_.is_free(path_.row(i), path_.row(i + 1))) {
                trees_->remove_edge(std::size_t(path_.source(i)));
                edges_.prove_search();
                ++plan_.stats.removed;
                return false;
            }
            path_.set_source(i, Path::checked);
        }
        return true;
    }

    void accept_path() {
        plan_.path = path_.rows();
        plan_.cost = path_.length();
        plan_.certified = options_.answer == EdgeTest::proved;
    }

    // Looks for shorter paths, below the cost of the last one, as long as the budget lasts.
    void improve() {
        const StageTimer timer(plan_.stats.improve_seconds);
        InformedSamples samples(edges_.box(), options_.seed);
        std::int64_t left = options_.improve;
        while (left > 0) {
            CostBoundedTrees<ArmEdges> trees(edges_, samples, options_.range);
            for (const int i : starts_) trees.add_start(round_row(start_row(i)).data());
            for (const int i : goals_) trees.add_goal(round_row(goal_row(i)).data());
            const std::int64_t before = edges_.answer_edges();
            const SearchEnd end = trees.run(float(plan_.cost), left);
            if (end == SearchEnd::met) keep_shorter(trees);
            left -= trees.counts().edges + edges_.answer_edges() - before;
            plan_.stats.samples += trees.counts().samples, plan_.stats.edges += trees.counts().edges;
            plan_.stats.blocked += trees.counts().blocked;
            if (end != SearchEnd::met) return;
        }
    }
    void keep_shorter(const CostBoundedTrees<ArmEdges>& trees) {
        const ArmPlan last = plan_;
        write_raw_path(trees);
        if (options_.simplify) Simplifier(edges_, path_).run();
        const bool is_whole = options_.answer == EdgeTest::sampled || prove_improved();
        if (is_whole && path_.length() < plan_.cost) {
            accept_path();
            ++plan_.stats.improvements;
        } else {
            plan_.start = last.start, plan_.goal = last.goal, plan_.turns = last.turns;
        }
    }
    bool prove_improved() {
        for (std::size_t i = 0; i + 1 < path_.size(); ++i)
            if (path_.source(i) != Path::checked && !edges_.is_free(path_.row(i), path_.row(i + 1)))
                return false;
        return true;
    }
    PlanStatus give_up(PlanStatus status) {
        plan_.start = plan_.goal = -1;
        plan_.turns.clear();
        plan_.raw_cost = plan_.cost;
        plan_.approach.distance = trees_->least_distance();
        const auto copy = [&](int t) {
            const auto& row = trees_->nearest_row(t);
            return std::vector<double>(row.begin(), row.begin() + std::ptrdiff_t(width_));
        };
        plan_.approach.from = copy(0), plan_.approach.to = copy(1);
        return status;
    }
    // Adds what the trees did to the statistics.
    void count_edges() {
        const Trees::Counts& counts = trees_->counts();
        ArmStats& stats = plan_.stats;
        stats.samples += counts.samples, stats.rejected += counts.rejected;
        stats.edges += counts.edges, stats.blocked += counts.blocked;
    }
    void write_stats() {
        count_edges();
        ArmStats& stats = plan_.stats;
        stats.blocks = edges_.blocks();
        stats.nodes = trees_->tree(0).size() + trees_->tree(1).size();
        edges_.tally().write_most(plan_);
    }
};

void require(bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument(rule);
}

void check_space(const ArmSpace& space) {
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
void check_problem(const ArmSpace& space, const ArmProblem& problem) {
    const std::size_t width = std::size_t(space.checker.dof());
    for (const auto rows : {problem.starts, problem.goals})
        require(width > 0 && !rows.empty() && rows.size() % width == 0,
                "starts and goals must be rows with one entry per coordinate, one row at least");
}
void check_options(const ArmOptions& options) {
    require(options.edges >= 0 && options.improve >= 0, "budgets of edges must not be negative");
    require(options.range > 0 && std::isfinite(options.range), "the range must be positive");
    require(options.resolution > 0 && std::isfinite(options.resolution), "the resolution must be positive");
    require(options.time_limit >= 0, "the time limit must not be negative");
}

}  // namespace

ArmPlan plan_arm(const ArmSpace& space, const ArmProblem& problem, const ArmOptions& options) {
    check_space(space), check_options(options), check_problem(space, problem);
    return ArmSearch(space, problem, options).run();
}

std::vector<ArmPlan> plan_arms(const ArmSpace& space, std::span<const ArmProblem> problems,
                               const ArmOptions& options, int threads) {
    check_space(space), check_options(options);
    for (const ArmProblem& problem : problems) check_problem(space, problem);
    std::vector<ArmPlan> plans(problems.size());
    over_rows(problems.size(), threads, 1, 1, [&](std::size_t begin, std::size_t end) {
        for (; begin < end; ++begin) plans[begin] = ArmSearch(space, problems[begin], options).run();
        return true;
    });
    return plans;
}

}  // namespace cspace::planning
