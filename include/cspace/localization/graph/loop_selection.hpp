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
// True measurements pull as χ² says, times a scale of the information. Where their tails are heavier, the
// limit is the pull that one in a hundred exceeds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "cspace/localization/graph/doubted_measurements.hpp"
#include "cspace/localization/graph/loop_groups.hpp"
#include "cspace/localization/graph/optimizer.hpp"

namespace cspace::localization {

namespace loop_tests {

inline constexpr double heavy_tail = 0.01;     // of true edges, that may exceed the limit
inline constexpr double belief = 0.05;         // in a scale of 1, in numbers per unknown one
inline constexpr std::size_t least_group = 3;  // edges; smaller ones are found edge by edge
inline constexpr int most_rounds = 100, most_cycles = 6;
inline constexpr double same_scale = 0.9;   // of the last one: false edges made that larger
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
            const double scale = find_scale(answer);
            if (cycle > 0 && scale > loop_tests::same_scale * answer.scale && !was_taken_) break;
            answer.scale = std::min(answer.scale, scale);
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

    // The scale of the limits: χ² per degree of freedom, towards 1 where few numbers were measured, or that
    // of the heavier tail.
    double find_scale(const RobustAnswer<Space>& answer) {
        double numbers = -unknowns_;
        std::vector<double> pulls;
        for (std::size_t k = 0; k < answer.is_used.size(); ++k) {
            if (!answer.is_used[k]) continue;
            numbers += k < graph_.edges.size() ? Space::freedom : Space::dimension;
            if (k < graph_.edges.size() && is_doubted(k))
                pulls.push_back(measure_pull(answer.state, k) / limits_[k]);
        }
        if (!(numbers > 0) || !(cost_ > 0)) return answer.scale;
        const double mean =
            std::exp(numbers * std::log(cost_ / numbers) / (numbers + loop_tests::belief * unknowns_));
        if (pulls.empty()) return mean;
        // Edges that were dropped alone may be of the tail too.
        double alone = 0;
        for (std::size_t k = 0; k < was_alone_.size(); ++k) alone += was_alone_[k] && !answer.is_used[k];
        const auto above =
            std::ptrdiff_t(std::max(0.0, loop_tests::heavy_tail * (double(pulls.size()) + alone) - alone));
        std::nth_element(pulls.begin(), pulls.begin() + above, pulls.end(), std::greater<>());
        return std::max(mean, pulls[std::size_t(above)]);
    }

    struct Suspect {
        double share = 1;  // of its limit
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
            pulls_[k] = measure_pull(answer.state, k);
            const double share = pulls_[k] / (answer.scale * limits_[k]);
            if (share > worst.share) worst = {share, {k}};
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
        std::vector<std::vector<std::size_t>> groups =
            find_loop_groups(ends, [&](std::size_t a, std::size_t b) {
                typename Space::Twist between = error(numbers[a]);
                const typename Space::Twist other = error(numbers[b]);
                for (std::size_t i = 0; i < n; ++i) between[i] -= other[i];
                return weigh_residual(between, graph_.edges[numbers[a]].W) <=
                       2 * answer.scale * limits_[numbers[a]];
            });
        std::erase_if(groups, [](const auto& group) { return group.size() < loop_tests::least_group; });
        std::vector<std::pair<double, std::size_t>> order;
        for (std::size_t g = 0; g < groups.size(); ++g) {
            double most = 0;
            for (std::size_t& k : groups[g]) k = numbers[k], most = std::max(most, pulls_[k]);
            order.push_back({-most, g});
        }
        std::sort(order.begin(), order.end());
        std::vector<std::vector<std::size_t>> sorted;
        for (const auto& [most, g] : order) sorted.push_back(std::move(groups[g]));
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
            const double limit = answer.scale * quantile_999_of_many(double(n * group.size()));
            const double share = measure_group_pull(answer, group) / limit;
            if (share > worst.share) worst = {share, group};
            if (share > harmless) still.push_back(std::move(group));
        }
        suspected_ = std::move(still);
    }
    // What χ² loses without a group, by a step of Gauss–Newton.
    double measure_group_pull(const RobustAnswer<Space>& answer, const std::vector<std::size_t>& group) {
        auto& equations = optimizer_.equations();
        FactorWeights weights = optimizer_.weights();
        for (std::size_t k : group) weights.fixed[k] = 0;
        const double cost = equations.linearize(answer.state, options_.residual, weights, squares_);
        step_ = equations.gradient();
        double* const side = step_.data();
        if (!equations.solver().solve_matrix(equations.values(), nullptr, {&side, 1})) return 0;
        double decrease = 0;
        for (std::size_t k = 0; k < step_.size(); ++k) decrease += step_[k] * equations.gradient()[k];
        return cost_ - (cost - decrease);
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
    // Rejected edges, with the shares of their limits by which χ² would rise.
    std::vector<std::pair<double, std::size_t>> find_fitting(const RobustAnswer<Space>& answer) {
        constexpr int most_dropped = 1;  // times: then an edge stays out
        std::vector<std::pair<double, std::size_t>> fitting;
        InterruptPoll poll(1 << 6);
        for (std::size_t k = 0; k < graph_.edges.size(); ++k) {
            poll.step();
            if (!is_doubted(k) || answer.is_used[k] || was_dropped_[k] > most_dropped) continue;
            const double limit = answer.scale * limits_[k];
            if (measure_rise(answer.state, k, bound_covariance(k)) > limit) continue;
            const double rise = measure_rise(answer.state, k, solve_covariance(k));
            if (rise <= limit) fitting.push_back({rise / limit, k});
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

    double measure_pull(const State& state, std::size_t k) const {
        return change_square(state, k, read_covariance(k), -1);
    }
    double measure_rise(const State& state, std::size_t k, const PairCovariance& S) const {
        return change_square(state, k, S, 1);
    }
    // eᵀWe − sign gᵀ(Σ⁻¹ + sign A)⁻¹g of an edge, where A, g are its part of the equations; sign 1: what χ²
    // gains with it, −1: what it loses without it.
    double change_square(const State& state, std::size_t k, const PairCovariance& S, double sign) const {
        const auto model = linearize_edge(graph_.edges[k], state, options_.residual);
        double A[2 * n][2 * n] = {}, g[2 * n] = {};
        for (std::size_t r = 0; r < n; ++r) {
            g[r] = model.ga[r], g[n + r] = model.gb[r];
            for (std::size_t c = 0; c < n; ++c) {
                A[r][c] = model.aa[r * n + c], A[n + r][n + c] = model.bb[r * n + c];
                A[r][n + c] = A[n + c][r] = model.ab[r * n + c];
            }
        }
        // y of (I + sign ΣA) y = Σg.
        std::array<double, 4 * n * n> M;
        std::array<double, 2 * n> y{};
        for (std::size_t r = 0; r < 2 * n; ++r) {
            for (std::size_t c = 0; c < 2 * n; ++c) {
                double sum = r == c;
                for (std::size_t i = 0; i < 2 * n; ++i) sum += sign * S[r * 2 * n + i] * A[i][c];
                M[r * 2 * n + c] = sum;
                y[r] += S[r * 2 * n + c] * g[c];
            }
        }
        if (!solve_general(M, y)) return 0;
        double change = model.square;
        for (std::size_t r = 0; r < 2 * n; ++r) change -= sign * g[r] * y[r];
        return change;
    }
    // Gauss elimination with row pivots; false for singular matrices.
    template <std::size_t size>
    static bool solve_general(std::array<double, size * size>& M, std::array<double, size>& y) {
        constexpr double singular = 1e-12;
        for (std::size_t c = 0; c < size; ++c) {
            std::size_t pivot = c;
            for (std::size_t r = c + 1; r < size; ++r) {
                if (std::fabs(M[r * size + c]) > std::fabs(M[pivot * size + c])) pivot = r;
            }
            if (!(std::fabs(M[pivot * size + c]) > singular)) return false;
            for (std::size_t k = 0; k < size; ++k) std::swap(M[c * size + k], M[pivot * size + k]);
            std::swap(y[c], y[pivot]);
            for (std::size_t r = c + 1; r < size; ++r) {
                const double factor = M[r * size + c] / M[c * size + c];
                for (std::size_t k = c; k < size; ++k) M[r * size + k] -= factor * M[c * size + k];
                y[r] -= factor * y[c];
            }
        }
        for (std::size_t c = size; c-- > 0;) {
            for (std::size_t k = c + 1; k < size; ++k) y[c] -= M[c * size + k] * y[k];
            y[c] /= M[c * size + c];
        }
        return true;
    }

    const PoseGraph<Space>& graph_;
    const GraphOptions& options_;
    GraphOptimizer<Space, Fronts>& optimizer_;
    const std::vector<char>& trusted_;
    const std::vector<double>& limits_;
    double unknowns_;
    std::vector<char> pattern_;  // measurements that the equations are analysed for
    double cost_ = 0;            // χ² of the answer
    std::ptrdiff_t tests_left_ = 0;
    bool was_taken_ = false;  // whether edges came back last
    std::vector<std::vector<std::size_t>> suspected_;
    std::vector<char> was_dropped_;  // how often
    std::vector<char> was_alone_;    // whether dropped without a group
    std::vector<double> pulls_, squares_, step_;
};

}  // namespace cspace::localization
