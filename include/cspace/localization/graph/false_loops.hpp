// Pose graphs with false measurements: dynamic covariance scaling (Agarwal, Tipaldi, Spinello, Stachniss &
// Burgard 2013) and graduated non-convexity (Yang, Antonante, Tzoumas & Carlone 2020).
//
// Both start from dead reckoning along trusted edges. What they reject is tested again at the answer:
// measurements within the quantile of 99.9 % count, the others do not, and the graph is solved again until
// nothing changes. The information of many files is far too small, so that false measurements would pass as
// well; the quantile is scaled by χ² per degree of freedom of the measurements that count. Of several answers
// that with the least truncated cost is the better one. Its edges are then tested against each other.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "cspace/localization/graph/doubted_measurements.hpp"
#include "cspace/localization/graph/initial_guess.hpp"
#include "cspace/localization/graph/loop_selection.hpp"
#include "cspace/localization/graph/optimizer.hpp"

namespace cspace::localization {

template <class Space, class Fronts>
class FalseLoopSolver {
  public:
    using State = GraphState<Space>;

    FalseLoopSolver(const PoseGraph<Space>& graph, const GraphOptions& options)
        : graph_(graph),
          options_(options),
          optimizer_(graph, options),
          trusted_(find_trusted(graph)),
          limits_(find_limits(graph)) {
        unknowns_ =
            Space::freedom * std::count(graph.is_held.begin(), graph.is_held.end(), 0) +
            Space::dimension * std::count(graph.is_landmark_held.begin(), graph.is_landmark_held.end(), 0);
    }

    GraphOptimizer<Space, Fronts>& optimizer() { return optimizer_; }

    // Dynamic covariance scaling; width: the square root of its φ.
    RobustAnswer<Space> scale_covariances(const State& start, double width) {
        constexpr int most_steps = 60;
        constexpr double least_step = 1e-4;  // [m or rad]
        State state = start;
        std::vector<double> weights(graph_.factors(), 1.0);
        for (int step = 0; step < most_steps; ++step) {
            measure_squares(graph_, state, options_.residual, squares_);
            for (std::size_t k = 0; k < weights.size(); ++k)
                weights[k] =
                    trusted_[k] ? 1.0 : evaluate_kernel(RobustKernel::dcs, squares_[k], width).weight;
            if (!(step_with(weights, state) > least_step)) break;
        }
        return settle(state, find_kept(weights));
    }

    // The same in the order of time: measurements come in batches by the last of their poses, and the poses
    // to come follow by dead reckoning. Drift is small that way where it is large at the end of dead
    // reckoning; new measurements begin with wider kernels.
    RobustAnswer<Space> scale_in_time(const State& start, double width) {
        constexpr std::size_t most_batches = 40;
        constexpr int most_steps = 4;        // per width
        constexpr double least_step = 1e-2;  // [m or rad]
        constexpr double least = 1e-2;       // weight: wide kernels would keep false measurements
        constexpr double widths[] = {30, 10, 3, 1}, narrow = 3;
        State state = start;
        const std::vector<int> times = find_times();
        std::vector<double> weights(graph_.factors(), 1.0);
        // The measurements up to `end`, those after `begin` with kernels of this share of the width.
        const auto settle_until = [&](int begin, int end, double share) {
            for (int step = 0; step < most_steps; ++step) {
                measure_squares(graph_, state, options_.residual, squares_);
                for (std::size_t k = 0; k < weights.size(); ++k) {
                    const double own = times[k] > begin ? share * width : width;
                    weights[k] = times[k] > end ? 0.0
                                 : trusted_[k]  ? 1.0
                                                : evaluate_kernel(RobustKernel::dcs, squares_[k], own).weight;
                }
                if (!(step_with(weights, state, least) > least_step)) break;
            }
        };
        int begin = 0;
        for (int end : find_batches(times, most_batches)) {
            reckon_after(begin, state);
            const bool is_near = has_fitting(times, begin, end, state, width);
            for (double share : widths) {
                if (share <= narrow || !is_near) settle_until(begin, end, share);
            }
            begin = end;
        }
        // Once more for all, for true measurements that came too early.
        const bool is_near = has_fitting(times, -1, begin, state, width);
        for (double share : widths) {
            if (share <= narrow || !is_near) settle_until(-1, begin, share);
        }
        return scale_covariances(state, width);
    }

    // Graduated non-convexity of truncated least squares.
    RobustAnswer<Space> graduate(const State& start) {
        constexpr int most_rounds = 60, steps_per_round = 2, least_rounds = 4;
        constexpr double growth = 1.4;   // of the convexity, as in the paper
        constexpr double binary = 1e-3;  // weights so near to 0 or 1 are that
        State state = start;
        measure_squares(graph_, state, options_.residual, squares_);
        double convexity = first_convexity();
        std::vector<double> weights(graph_.factors(), 1.0);
        for (int round = 0; round < most_rounds; ++round, convexity *= growth) {
            for (int step = 0; step < steps_per_round; ++step) {
                if (!std::isfinite(step_with(weights, state))) return settle(start, trusted_);
            }
            measure_squares(graph_, state, options_.residual, squares_);
            double farthest = 0;
            for (std::size_t k = 0; k < weights.size(); ++k) {
                weights[k] = trusted_[k] ? 1.0 : graduated_weight(squares_[k], limits_[k], convexity);
                farthest = std::max(farthest, std::fabs(weights[k] - std::round(weights[k])));
            }
            if (farthest < binary && round >= least_rounds) break;
        }
        return settle(state, find_kept(weights));
    }

    // The squared errors of an answer, those of doubted measurements truncated at their limits times a scale.
    double truncated_cost(const RobustAnswer<Space>& answer, double scale) const {
        double cost = 0;
        for (std::size_t k = 0; k < answer.squares.size(); ++k)
            cost += trusted_[k] ? answer.squares[k] : std::min(answer.squares[k], scale * limits_[k]);
        return cost;
    }

    // Tests each edge and each group of edges of an answer against all others.
    RobustAnswer<Space> select_loops(RobustAnswer<Space> answer) {
        LoopSelection<Space, Fronts> selection(graph_, options_, optimizer_, trusted_, limits_, unknowns_);
        return selection.refine(std::move(answer));
    }

    // How many doubted measurements an answer keeps, and how many there are.
    std::size_t count_kept(const RobustAnswer<Space>& answer) const {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < trusted_.size(); ++k)
            kept += std::size_t(!trusted_[k] && answer.is_used[k]);
        return kept;
    }
    // On how many doubted measurements two answers differ.
    std::size_t count_differences(const RobustAnswer<Space>& a, const RobustAnswer<Space>& b) const {
        std::size_t count = 0;
        for (std::size_t k = 0; k < trusted_.size(); ++k) count += std::size_t(a.is_used[k] != b.is_used[k]);
        return count;
    }
    std::size_t count_doubted() const { return std::size_t(std::count(trusted_.begin(), trusted_.end(), 0)); }

  private:
    // The last pose of each measurement.
    std::vector<int> find_times() const {
        std::vector<int> times;
        times.reserve(graph_.factors());
        for (const auto& edge : graph_.edges) times.push_back(std::max(edge.from, edge.to));
        for (const auto& seen : graph_.sightings) times.push_back(seen.pose);
        return times;
    }
    // The last times of batches with about as many doubted measurements each; the last one takes everything.
    std::vector<int> find_batches(const std::vector<int>& times, std::size_t most) const {
        std::vector<int> doubted;
        for (std::size_t k = 0; k < times.size(); ++k) {
            if (!trusted_[k]) doubted.push_back(times[k]);
        }
        std::sort(doubted.begin(), doubted.end());
        std::vector<int> ends;
        for (std::size_t batch = 1; batch < most && !doubted.empty(); ++batch) {
            const int end = doubted[batch * doubted.size() / most];
            if (ends.empty() || end > ends.back()) ends.push_back(end);
        }
        const int last = int(graph_.start.poses.size());
        if (ends.empty() || ends.back() < last) ends.push_back(last);
        return ends;
    }
    // Whether more than a few doubted measurements of a time fit a state as it is: wide kernels would only
    // keep false ones, which fill the factor.
    bool has_fitting(const std::vector<int>& times, int begin, int end, const State& state, double width) {
        constexpr double least = 0.1;  // of them
        measure_squares(graph_, state, options_.residual, squares_);
        double fitting = 0, all = 0;
        for (std::size_t k = 0; k < times.size(); ++k) {
            if (trusted_[k] || times[k] <= begin || times[k] > end) continue;
            all += 1;
            fitting += evaluate_kernel(RobustKernel::dcs, squares_[k], width).weight >= 0.5;
        }
        return fitting >= least * all;
    }
    // Moves the poses after one along trusted measurements.
    void reckon_after(int time, State& state) const {
        std::vector<char> is_known(graph_.is_held);
        for (int k = 0; k <= time && k < int(is_known.size()); ++k) is_known[std::size_t(k)] = 1;
        reckon_from(graph_, std::move(is_known), state);
    }
    static double graduated_weight(double square, double limit, double convexity) {
        if (square <= convexity / (convexity + 1) * limit) return 1;
        if (square >= (convexity + 1) / convexity * limit) return 0;
        return std::clamp(std::sqrt(limit * convexity * (convexity + 1) / square) - convexity, 0.0, 1.0);
    }
    double first_convexity() const {
        constexpr double least = 1e-9, no_doubt = 1e9;
        double found = no_doubt;
        for (std::size_t k = 0; k < squares_.size(); ++k) {
            if (!trusted_[k])
                found = std::min(found, limits_[k] / std::max(2 * squares_[k] - limits_[k], least));
        }
        return std::max(found, least);
    }

    // Measurements of less weight are left out. Many of hardly any weight still pull together, when they are
    // true.
    static constexpr double least_weight = 1e-6;

    // A step of Gauss–Newton with these weights; its largest entry.
    double step_with(const std::vector<double>& weights, State& state, double least = least_weight) {
        constexpr double waste =
            1.1;  // measurements in use against those needed, before the pattern is found anew
        std::size_t used = 0, needed = 0;
        bool is_covered = !is_used_.empty();
        std::vector<char> wanted(weights.size());
        for (std::size_t k = 0; k < weights.size(); ++k) {
            wanted[k] = weights[k] >= least;
            needed += std::size_t(wanted[k]);
            if (is_covered) used += std::size_t(is_used_[k]), is_covered = is_used_[k] || !wanted[k];
        }
        if (!is_covered || double(used) > waste * double(needed)) {
            is_used_ = wanted;
            optimizer_.use_factors(is_used_);
        }
        optimizer_.weights().fixed = weights;
        return optimizer_.take_step(state);
    }

    // χ² per degree of freedom of these measurements, between the bounds of a scale; towards 1 where few more
    // numbers were measured than are unknown, which say little.
    double find_scale(const std::vector<char>& is_used) const {
        constexpr double least = 0.1;    // errors have heavier tails than the quantile knows
        constexpr double belief = 0.05;  // in 1, in numbers per unknown one
        double sum = 0, numbers = -double(unknowns_);
        for (std::size_t k = 0; k < is_used.size(); ++k) {
            if (is_used[k])
                sum += squares_[k], numbers += k < graph_.edges.size() ? Space::freedom : Space::dimension;
        }
        if (!(numbers > 0)) return 1;
        const double believed = belief * double(unknowns_);
        return std::clamp((sum + believed) / (numbers + believed), least, 1.0);
    }

    // Solves with the measurements within their limits, until these stay the same. is_kept: those that count
    // at first.
    RobustAnswer<Space> settle(const State& start, const std::vector<char>& is_kept) {
        constexpr int most_rounds = 12;
        RobustAnswer<Space> answer;
        answer.state = start;
        optimizer_.weights().fixed.clear();
        std::vector<char> kept = is_kept;
        for (int round = 0; round < most_rounds; ++round) {
            measure_squares(graph_, answer.state, options_.residual, squares_);
            answer.scale = find_scale(kept);
            for (std::size_t k = 0; k < kept.size(); ++k)
                kept[k] = trusted_[k] || squares_[k] <= answer.scale * limits_[k];
            if (kept == answer.is_used) break;
            answer.is_used = is_used_ = kept;
            optimizer_.use_factors(is_used_);
            answer.status = optimizer_.optimize(answer.state);
        }
        measure_squares(graph_, answer.state, options_.residual, answer.squares);
        return answer;
    }
    // The measurements of so much weight.
    static std::vector<char> find_kept(const std::vector<double>& weights) {
        constexpr double least = 0.5;
        std::vector<char> kept(weights.size());
        for (std::size_t k = 0; k < kept.size(); ++k) kept[k] = weights[k] >= least;
        return kept;
    }

    const PoseGraph<Space>& graph_;
    GraphOptions options_;
    GraphOptimizer<Space, Fronts> optimizer_;
    std::vector<char> trusted_, is_used_;
    std::vector<double> limits_, squares_;
    std::ptrdiff_t unknowns_ = 0;
};

}  // namespace cspace::localization
