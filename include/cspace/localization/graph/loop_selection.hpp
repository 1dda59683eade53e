// Which doubted edges count in the end, tested against all others: leave-one-out tests of edges and of
// groups.
//
// The squared error of an edge at an answer says little where that edge pulls the answer towards itself. What
// counts is by how much χ² falls without it, its pull: eᵀ (W⁻¹ − J Σ Jᵀ)⁻¹ e, with the covariance Σ of its
// poses at the answer (Cook 1977, "Detection of influential observation in linear regression"). False edges
// that agree support each other, so that each alone pulls little; groups of them are tested as a whole.
// A rejected edge comes back where χ² rises little with it: eᵀ (W⁻¹ + J Σ Jᵀ)⁻¹ e, its gate (Bar-Shalom et
// al. 2001).
//
// True measurements pull as χ² says, times scales of the covariances. Where their tails are heavier, the
// scale of the edges themselves is such that one in 200 exceeds its limit. That of the poses, which are
// sums of many measurements, stays near χ² per degree of freedom. So an edge that nothing else measures well
// may not pull far, though others of the graph have large errors (`edge_test.hpp`).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "cspace/localization/graph/doubted_measurements.hpp"
#include "cspace/localization/graph/edge_test.hpp"
#include "cspace/localization/graph/loop_groups.hpp"
#include "cspace/localization/graph/optimizer.hpp"

namespace cspace::localization {

namespace loop_tests {

inline constexpr double heavy_tail = 0.005;    // of true edges, that may exceed the limit
inline constexpr double belief = 0.05;         // in a scale of 1, in numbers per unknown one
inline constexpr double most_belief = 10;      // in numbers: what it may weigh at most
inline constexpr std::size_t least_group = 3;  // edges; smaller ones are found edge by edge
inline constexpr double group_rank = 0.5;      // where one edge and a group disagree, the edge goes
inline constexpr int most_rounds = 100, most_cycles = 6;
inline constexpr double most_tail = 10;     // scale of edges, in that of the poses
inline constexpr double scale_step = 1.01;  // to which it is found
inline constexpr double same_scale = 0.97;  // of the last one: false edges made that larger
inline constexpr int tests_per_solve = 16;  // of groups, at most, for each factorisation until then

}  // namespace loop_tests

template <class Space, class Fronts>
class LoopSelection {
  public:
    using State = GraphState<Space>;

    // trusted, limits: by measurement; unknowns: numbers that are not held.
    LoopSelection(const PoseGraph<Space>& graph, const GraphOptions& options,
                  GraphOptimizer<Space, Fronts>& optimizer, const std::vector<char>& trusted,
                  const std::vector<double>& limits, std::ptrdiff_t unknowns)
        : graph_(graph),
          options_(options),
          optimizer_(optimizer),
          trusted_(trusted),
          limits_(limits),
          unknowns_(double(unknowns)),
          was_dropped_(graph.edges.size(), 0),
          was_alone_(graph.edges.size(), 0) {}

    // Rejects edges and groups that pull, the worst first, and takes back those that fit, until nothing
    // changes.
    RobustAnswer<Space> refine(RobustAnswer<Space> answer) {
        tests_left_ = std::ptrdiff_t(loop_tests::tests_per_solve) * optimizer_.stats().factorizations;
        use(answer, answer.is_used);
        for (int cycle = 0; cycle < loop_tests::most_cycles; ++cycle) {
            if (!invert_equations(answer)) break;
            const ErrorScales scales = find_scales(answer);
            if (cycle > 0 && !was_taken_ && scales.own > loop_tests::same_scale * scales_.own &&
                scales.graph > loop_tests::same_scale * scales_.graph)
                break;
            scales_ = {std::min(scales_.own, scales.own), std::min(scales_.graph, scales.graph)};
            answer.scale = scales_.own;
            drop_pulling(answer);
            was_taken_ = take_back(answer);
        }
        return finish(std::move(answer));
    }

  private:
    static constexpr std::size_t n = Space::freedom;
    using PairCovariance = std::array<double, 4 * n * n>;  // of the poses of an edge, row by row

    bool is_doubted(std::size_t k) const { return !trusted_[k]; }

    // Solves with these measurements. The pattern stays while it covers them.
    void use(RobustAnswer<Space>& answer, std::vector<char> kept) {
        bool is_covered = !pattern_.empty();
        for (std::size_t k = 0; k < kept.size() && is_covered; ++k) is_covered = pattern_[k] || !kept[k];
        if (!is_covered) pattern_ = kept, optimizer_.use_factors(kept);
        optimizer_.weights().fixed.assign(kept.begin(), kept.end());
        answer.status = optimizer_.optimize(answer.state);
        answer.is_used = std::move(kept);
    }
    // Leaves the solver with the measurements of the answer.
    RobustAnswer<Space> finish(RobustAnswer<Space> answer) {
        if (pattern_ != answer.is_used) optimizer_.use_factors(answer.is_used);
        optimizer_.weights().fixed.clear();
        measure_squares(graph_, answer.state, options_.residual, answer.squares);
        return answer;
    }
    // Factors the equations at an answer, with the inverse on their pattern; false where they are singular.
    bool invert_equations(const RobustAnswer<Space>& answer) {
        auto& equations = optimizer_.equations();
        cost_ = equations.linearize(answer.state, options_.residual, optimizer_.weights(), squares_);
        if (!equations.solver().factor_matrix(equations.values())) return false;
        equations.solver().invert_pattern();
        return true;
    }

    // The scale of the poses: χ² per degree of freedom, towards 1 where few numbers were measured. That of
    // the edges is no less, and that of the heavier tail.
    ErrorScales find_scales(const RobustAnswer<Space>& answer) {
        double numbers = -unknowns_;
        std::vector<TestedEdge> tested;
        for (std::size_t k = 0; k < answer.is_used.size(); ++k) {
            const bool is_used = answer.is_used[k], is_edge = k < graph_.edges.size();
            if (is_used) numbers += is_edge ? Space::freedom : Space::dimension;
            // Edges that were dropped alone may be of the tail too.
            if (!is_edge || !is_doubted(k) || !(is_used || was_alone_[k])) continue;
            const PairCovariance S = is_used ? read_covariance(k) : solve_covariance(k);
            tested.push_back({whiten(answer.state, k, S), limits_[k], is_used});
        }
        if (!(numbers > 0) || !(cost_ > 0)) return {answer.scale, answer.scale};
        const double believed = std::min(loop_tests::belief * unknowns_, loop_tests::most_belief);
        const double mean = std::exp(numbers * std::log(cost_ / numbers) / (numbers + believed));
        return widen_scales(mean, tested);
    }
    struct TestedEdge {
        WhiteError<n> white;
        double limit;
        bool is_used;
    };
    // The least scales with which no more edges exceed their limits than heavy tails have.
    static ErrorScales widen_scales(double mean, const std::vector<TestedEdge>& tested) {
        const auto above = std::ptrdiff_t(loop_tests::heavy_tail * double(tested.size()));
        const auto suffices = [&](double own) {
            return std::count_if(tested.begin(), tested.end(), [&](const TestedEdge& edge) {
                       return (edge.is_used ? measure_pull(edge.white, {own, mean})
                                            : measure_rise(edge.white, {own, mean})) > edge.limit;
                   }) <= above;
        };
        if (suffices(mean)) return {mean, mean};
        double low = mean, high = loop_tests::most_tail * mean;
        while (high > loop_tests::scale_step * low) {
            const double middle = std::sqrt(low * high);
            (suffices(middle) ? high : low) = middle;
        }
        return {high, mean};
    }

    struct Suspect {
        double rank = 0;  // the share of its limit, that of groups times `group_rank`
        std::vector<std::size_t> edges;
    };

    // All groups are tested at first, and again where no edge and no suspected group is left to drop.
    void drop_pulling(RobustAnswer<Space>& answer) {
        suspected_.clear();
        for (int round = 0; round < loop_tests::most_rounds; ++round) {
            if (!invert_equations(answer)) return;
            Suspect worst = find_worst_edge(answer);
            test_groups(answer, worst);
            if (round == 0 || worst.edges.empty()) {
                suspected_ = list_groups(answer);
                test_groups(answer, worst);
            }
            if (worst.edges.empty()) return;
            std::vector<char> kept = answer.is_used;
            for (std::size_t k : worst.edges)
                kept[k] = 0, ++was_dropped_[k], was_alone_[k] = worst.edges.size() == 1;
            use(answer, std::move(kept));
        }
    }
    // The edge that exceeds its limit most, and the pulls of all.
    Suspect find_worst_edge(const RobustAnswer<Space>& answer) {
        Suspect worst;
        pulls_.assign(graph_.edges.size(), 0.0);
        for (std::size_t k = 0; k < graph_.edges.size(); ++k) {
            if (!is_doubted(k) || !answer.is_used[k]) continue;
            const WhiteError<n> white = whiten(answer.state, k, read_covariance(k));
            pulls_[k] = measure_pull(white, {});
            const double share = measure_pull(white, scales_) / limits_[k];
            if (share > 1 && share > worst.rank) worst = {share, {k}};
        }
        return worst;
    }
    // The groups in use, those with the largest pull of an edge first.
    std::vector<std::vector<std::size_t>> list_groups(const RobustAnswer<Space>& answer) const {
        std::vector<std::size_t> numbers;
        std::vector<std::pair<int, int>> ends;
        for (std::size_t k = 0; k < graph_.edges.size(); ++k) {
            if (!is_doubted(k) || !answer.is_used[k]) continue;
            numbers.push_back(k), ends.push_back({graph_.edges[k].from, graph_.edges[k].to});
        }
        const auto error = [&](std::size_t k) {
            return evaluate_edge(graph_.edges[k], answer.state, options_.residual).e;
        };
        // Half the square of a difference is χ² of one error.
        const auto agree = [&](std::size_t a, std::size_t b) {
            typename Space::Twist between = error(numbers[a]);
            const typename Space::Twist other = error(numbers[b]);
            for (std::size_t i = 0; i < n; ++i) between[i] -= other[i];
            return weigh_residual(between, graph_.edges[numbers[a]].W) <=
                   2 * scales_.graph * limits_[numbers[a]];
        };
        std::vector<std::pair<double, std::vector<std::size_t>>> order;
        for (int sense : {1, -1}) {
            auto groups = find_loop_groups(ends, [&](std::size_t a, std::size_t b) {
                const int along = ends[b].first - ends[a].first, across = ends[b].second - ends[a].second;
                return sense * along * across >= 0 && agree(a, b);
            });
            for (auto& group : groups) {
                if (group.size() < loop_tests::least_group) continue;
                double most = 0;
                for (std::size_t& k : group) k = numbers[k], most = std::max(most, pulls_[k]);
                order.push_back({-most, std::move(group)});
            }
        }
        std::sort(order.begin(), order.end());
        order.erase(std::unique(order.begin(), order.end()), order.end());
        std::vector<std::vector<std::size_t>> sorted;
        for (auto& [most, group] : order) sorted.push_back(std::move(group));
        return sorted;
    }
    // Tests the suspected groups, of which those far below their limit are suspected no more.
    void test_groups(const RobustAnswer<Space>& answer, Suspect& worst) {
        constexpr double harmless = 0.3;  // of the limit
        std::vector<std::vector<std::size_t>> still;
        for (auto& group : suspected_) {
            if (tests_left_-- <= 0) break;
            if (std::any_of(group.begin(), group.end(), [&](std::size_t k) { return !answer.is_used[k]; }))
                continue;
            const double share = measure_group(answer, group) / limit_group(answer, group.size());
            if (share > 1 && loop_tests::group_rank * share > worst.rank)
                worst = {loop_tests::group_rank * share, group};
            if (share > harmless) still.push_back(std::move(group));
        }
        suspected_ = std::move(still);
    }
    // A group of most edges goes only where all its errors together would exceed their limit: most are true.
    double limit_group(const RobustAnswer<Space>& answer, std::size_t size) const {
        std::size_t doubted = 0;
        for (std::size_t k = 0; k < graph_.edges.size(); ++k) doubted += is_doubted(k) && answer.is_used[k];
        return 2 * size > doubted ? quantile_999_of_many(double(n * size)) : quantile_999(int(n));
    }
    // The squared error that all edges of a group have in common, at the poses that others and the shape of
    // the group make. Where the group hides what others say, at the poses without it; zero where there are
    // none.
    double measure_group(const RobustAnswer<Space>& answer, const std::vector<std::size_t>& group,
                         bool is_out = false) {
        constexpr double least_share = 1e-6;  // of others: below, digits are lost
        auto& equations = optimizer_.equations();
        FactorWeights weights = optimizer_.weights();
        for (std::size_t k : group) weights.fixed[k] = is_out ? 0.0 : 1.0;
        equations.linearize(answer.state, options_.residual, weights, squares_);
        CommonError common = add_errors(answer.state, group);
        const std::vector<double> columns = columns_;
        std::array<double*, n> sides;
        const std::size_t rows = columns.size() / n;
        for (std::size_t c = 0; c < n; ++c) sides[c] = columns_.data() + c * rows;
        if (!equations.solver().solve_matrix(equations.values(), nullptr, sides)) return 0;
        std::array<double, n * n> C;
        for (std::size_t c = 0; c < n; ++c) {
            common.g[c] -= std::inner_product(sides[c], sides[c] + rows, equations.gradient().begin(), 0.0);
            for (std::size_t r = 0; r < n; ++r)
                C[r * n + c] = std::inner_product(sides[c], sides[c] + rows,
                                                  columns.begin() + std::ptrdiff_t(r * rows), 0.0);
        }
        // Edges that agree may err together: as much as one of them.
        const ErrorScales scales{scales_.own * double(group.size()), scales_.graph};
        const WhiteError<n> white = whiten_error<n>(common.H, common.g, C);
        if (is_out) return measure_rise(white, scales);
        if (!(find_least_share(white) > least_share)) return measure_group(answer, group, true);
        return measure_pull(white, scales);
    }
    struct CommonError {
        std::array<double, n * n> H{};  // its information
        std::array<double, n> g{};      // its gradient
    };
    // The common error of edges; columns_: its rows of the equations.
    CommonError add_errors(const State& state, const std::vector<std::size_t>& group) {
        CommonError common;
        columns_.assign(n * optimizer_.equations().gradient().size(), 0.0);
        const auto& base = state.poses[std::size_t(graph_.edges[group.front()].to)];
        for (std::size_t k : group) {
            const auto& edge = graph_.edges[k];
            const auto model = linearize_edge(edge, state, options_.residual);
            const std::array<double, n * n> D =
                Space::adjoint(Space::between(state.poses[std::size_t(edge.to)], base));
            const std::array<double, n * n> bD = multiply<n, n, n>(model.bb, D);
            const std::array<double, n * n> H = transpose_times<n, n, n>(D, bD);
            const std::array<double, n> g = transpose_times<n, n, 1>(D, model.gb);
            for (std::size_t i = 0; i < n * n; ++i) common.H[i] += H[i];
            for (std::size_t i = 0; i < n; ++i) common.g[i] += g[i];
            add_columns(block_from(k), multiply<n, n, n>(model.ab, D));
            add_columns(block_to(k), bD);
        }
        return common;
    }
    void add_columns(int block, const std::array<double, n * n>& values) {
        if (block < 0) return;
        const auto row = std::size_t(optimizer_.equations().solver().row_of(block));
        const std::size_t rows = columns_.size() / n;
        for (std::size_t r = 0; r < n; ++r) {
            for (std::size_t c = 0; c < n; ++c) columns_[c * rows + row + r] += values[r * n + c];
        }
    }

    // Uses rejected edges again with which χ² rises by less than their limit, those that fit best first;
    // whether there were any.
    bool take_back(RobustAnswer<Space>& answer) {
        constexpr int most_halves = 12;
        bool has_changed = false;
        for (int round = 0; round < most_halves; ++round) {
            if (!invert_equations(answer)) return has_changed;
            std::vector<std::pair<double, std::size_t>> fitting = find_fitting(answer);
            if (fitting.empty()) return has_changed;
            std::sort(fitting.begin(), fitting.end());
            std::vector<char> kept = answer.is_used;
            for (std::size_t k = 0; k < (fitting.size() + 1) / 2; ++k) kept[fitting[k].second] = 1;
            use(answer, std::move(kept));
            has_changed = true;
        }
        return has_changed;
    }
    // Rejected edges, with their squared errors as shares of their limits.
    std::vector<std::pair<double, std::size_t>> find_fitting(const RobustAnswer<Space>& answer) {
        constexpr int most_dropped = 1;  // times: then an edge stays out
        std::vector<std::pair<double, std::size_t>> fitting;
        InterruptPoll poll(1 << 6);
        for (std::size_t k = 0; k < graph_.edges.size(); ++k) {
            poll.step();
            if (!is_doubted(k) || answer.is_used[k] || was_dropped_[k] > most_dropped) continue;
            if (measure_rise(whiten(answer.state, k, bound_covariance(k)), scales_) > limits_[k]) continue;
            const double rise = measure_rise(whiten(answer.state, k, solve_covariance(k)), scales_);
            if (rise <= limits_[k]) fitting.push_back({rise / limits_[k], k});
        }
        return fitting;
    }

    int block_from(std::size_t k) const {
        return optimizer_.equations().numbers().pose[std::size_t(graph_.edges[k].from)];
    }
    int block_to(std::size_t k) const {
        return optimizer_.equations().numbers().pose[std::size_t(graph_.edges[k].to)];
    }
    // A block of the inverse, times a factor, where it is in the pattern.
    void read_block(int i, int j, std::size_t row, std::size_t column, double factor,
                    PairCovariance& to) const {
        std::array<double, n * n> block;
        if (i < 0 || j < 0 || !optimizer_.equations().solver().inverse_block(i, j, block.data())) return;
        for (std::size_t r = 0; r < n; ++r) {
            for (std::size_t c = 0; c < n; ++c)
                to[(row + r) * 2 * n + column + c] = factor * block[r * n + c];
        }
    }
    PairCovariance read_covariance(std::size_t k) const {
        PairCovariance S{};
        const int a = block_from(k), b = block_to(k);
        read_block(a, a, 0, 0, 1, S), read_block(a, b, 0, n, 1, S);
        read_block(b, a, n, 0, 1, S), read_block(b, b, n, n, 1, S);
        return S;
    }
    // Not below the joint covariance, whatever the correlation.
    PairCovariance bound_covariance(std::size_t k) const {
        PairCovariance S{};
        read_block(block_from(k), block_from(k), 0, 0, 2, S);
        read_block(block_to(k), block_to(k), n, n, 2, S);
        return S;
    }
    PairCovariance solve_covariance(std::size_t k) {
        PairCovariance S = read_covariance(k);
        const int a = block_from(k), b = block_to(k);
        if (a < 0 || b < 0) return S;
        auto& solver = optimizer_.equations().solver();
        for (std::size_t c = 0; c < n; ++c) {
            step_.assign(std::size_t(solver.rows()), 0.0);
            step_[std::size_t(solver.row_of(b)) + c] = 1;
            solver.solve(step_.data());
            for (std::size_t r = 0; r < n; ++r)
                S[r * 2 * n + n + c] = S[(n + c) * 2 * n + r] = step_[std::size_t(solver.row_of(a)) + r];
        }
        return S;
    }

    WhiteError<n> whiten(const State& state, std::size_t k, const PairCovariance& S) const {
        return whiten_edge<n>(linearize_edge(graph_.edges[k], state, options_.residual), S);
    }

    const PoseGraph<Space>& graph_;
    const GraphOptions& options_;
    GraphOptimizer<Space, Fronts>& optimizer_;
    const std::vector<char>& trusted_;
    const std::vector<double>& limits_;
    double unknowns_;
    std::vector<char> pattern_;  // measurements that the equations are analysed for
    ErrorScales scales_;
    double cost_ = 0;  // χ² of the answer
    std::ptrdiff_t tests_left_ = 0;
    bool was_taken_ = false;  // whether edges came back last
    std::vector<std::vector<std::size_t>> suspected_;
    std::vector<char> was_dropped_;  // how often
    std::vector<char> was_alone_;    // whether dropped without a group
    std::vector<double> pulls_, squares_, step_, columns_;
};

}  // namespace cspace::localization
