// Least squares on a pose graph: Gauss–Newton, Levenberg–Marquardt (Marquardt 1963; damping as in Nielsen
// 1999) and Powell's dog-leg (1970).
//
// Far from the optimum the cost may rise before it falls, by orders of magnitude, while monotone methods
// crawl. Gauss–Newton therefore tolerates some rises, and keeps the state of least cost; where it does not
// settle, Levenberg–Marquardt goes on from there. Where errors are large it converges linearly; its last
// steps are then mixed (Anderson 1965, "Iterative procedures for nonlinear integral equations").
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "cspace/localization/graph/normal_equations.hpp"
#include "cspace/localization/graph/options.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::localization {

namespace descent {

inline constexpr int most_rises = 8;         // of the cost in a row, before Gauss–Newton gives up
inline constexpr double least_cost = 1e-12;  // [squared standard deviations]: below it there is no error left
inline constexpr double first_damping = 1e-5;  // of the diagonal
inline constexpr double least_damping = 1e-12, largest_damping = 1e12;
inline constexpr double settled_damping = 1e-2;  // above it a small step says nothing
inline constexpr double least_radius = 1e-12;    // of the first one
inline constexpr double slow_ratio = 0.3;        // of two steps in a row, from which convergence is linear
inline constexpr double near_decrease = 0.1;     // of the cost, that a step predicts near the optimum
inline constexpr std::size_t most_mixed = 4;     // earlier steps that are mixed with one

}  // namespace descent

template <class Space, class Fronts>
class GraphOptimizer {
  public:
    using State = GraphState<Space>;
    using Equations = NormalEquations<Space, Fronts>;

    GraphOptimizer(const PoseGraph<Space>& graph, const GraphOptions& options)
        : graph_(graph), options_(options) {}

    FactorWeights& weights() { return weights_; }
    GraphStats& stats() { return stats_; }
    Equations& equations() { return *equations_; }
    int failed_block() const { return equations_ ? equations_->solver().failed_block() : -1; }

    // Uses these measurements from now on.
    void use_factors(const std::vector<char>& is_used) {
        equations_ = std::make_unique<Equations>(graph_, is_used);
        ++stats_.analyses;
    }

    // Improves a state, which is the one of least cost at any moment.
    GraphStatus optimize(State& best) {
        prepare_vectors();
        iterations_left_ = options_.most_iterations;
        switch (options_.method) {
            case GraphMethod::levenberg_marquardt:
                return descend_damped(best);
            case GraphMethod::dog_leg:
                return descend_in_region(best);
            case GraphMethod::gauss_newton:
                break;
        }
        const Outcome outcome = descend_newton(best);
        return outcome == Outcome::unsettled ? descend_damped(best) : GraphStatus(int(outcome));
    }

    // One step of Gauss–Newton, whatever it does to the cost; its largest entry, or infinity where there is
    // none.
    double take_step(State& state) {
        prepare_vectors();
        const double cost = linearize(state);
        if (!std::isfinite(cost) || !solve_step(nullptr)) return INFINITY;
        equations_->move_state(state, step_.data(), trial_);
        std::swap(state, trial_);
        return largest_entry();
    }

    // The cost of a state, of the measurements in use.
    double measure_cost(const State& state) {
        measure_squares(graph_, state, options_.residual, squares_);
        double cost = 0;
        for (std::size_t k = 0; k < squares_.size(); ++k) {
            if (!equations_->is_used(k)) continue;
            const bool is_trusted = k < graph_.edges.size()
                                        ? graph_.is_trusted[k] != 0
                                        : graph_.is_sighting_trusted[k - graph_.edges.size()] != 0;
            const double fixed = weights_.fixed.empty() ? 1.0 : weights_.fixed[k];
            cost += evaluate_kernel(is_trusted ? RobustKernel::none : weights_.kernel, fixed * squares_[k],
                                    weights_.width)
                        .cost;
        }
        return cost;
    }

  private:
    enum class Outcome {
        converged = int(GraphStatus::converged),
        stopped = int(GraphStatus::stopped),
        singular = int(GraphStatus::singular),
        unsettled
    };

    void prepare_vectors() { step_.resize(equations_->gradient().size()); }
    double linearize(const State& state) {
        poll_interrupts();
        const double cost = equations_->linearize(state, options_.residual, weights_, squares_);
        stats_.costs.push_back(cost);
        ++stats_.iterations;
        return cost;
    }
    // −(H + added)⁻¹ g.
    bool solve_step(const double* added) {
        ++stats_.factorizations;
        auto& solver = equations_->solver();
        const auto& gradient = equations_->gradient();
        for (std::size_t k = 0; k < step_.size(); ++k) step_[k] = -gradient[k];
        double* const side = step_.data();
        return solver.solve_matrix(equations_->values(), added, {&side, 1});
    }
    static double inner(const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0;
        for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
        return sum;
    }
    double largest_entry() const {
        double largest = 0;
        for (double x : step_) largest = std::max(largest, std::fabs(x));
        return largest;
    }
    // Whether a step that predicts this decrease of the cost is the last one.
    bool is_last(double decrease, double cost) const {
        return cost <= descent::least_cost ||
               (decrease <= options_.least_decrease * cost + descent::least_cost &&
                largest_entry() <= options_.least_step);
    }

    Outcome descend_newton(State& best) {
        State state = best;
        double least = INFINITY;
        last_step_.clear(), differences_.clear();
        // The other half is for Levenberg–Marquardt, where this goes round in a cycle.
        const int kept = options_.most_iterations / 2;
        for (int rises = 0; iterations_left_ > kept;) {
            --iterations_left_;
            const double cost = linearize(state);
            if (!std::isfinite(cost)) return Outcome::unsettled;
            if (cost < least) {
                least = cost, best = state, rises = 0;
            } else if (++rises > descent::most_rises) {
                return Outcome::unsettled;
            }
            if (!solve_step(nullptr)) return std::isfinite(least) ? Outcome::singular : Outcome::unsettled;
            const double decrease = -inner(step_, equations_->gradient());
            equations_->move_state(state, step_.data(), trial_);
            if (!is_last(decrease, cost)) {
                mix_steps(state, decrease <= descent::near_decrease * cost);
            } else {
                constexpr double same = 1e-6;  // relative: within it two costs are of one minimum
                if (cost > least * (1 + same)) return Outcome::unsettled;
                if (measure_cost(trial_) < least) best = trial_;
                return Outcome::converged;
            }
            std::swap(state, trial_);
        }
        return Outcome::unsettled;
    }

    // Replaces the state after a step by that after a mix of the last ones, where convergence is linear and
    // its cost is less; whether it did.
    bool mix_steps(const State& state, bool is_near) {
        if (!last_step_.empty()) keep_difference();
        const bool is_slow =
            is_near && !differences_.empty() &&
            inner(step_, step_) >= descent::slow_ratio * descent::slow_ratio * inner(last_step_, last_step_);
        last_step_ = step_;
        if (!is_near) return last_step_.clear(), differences_.clear(), false;
        if (is_slow) {
            find_mix();
            equations_->move_state(state, mixed_.data(), other_);
            if (measure_cost(other_) < measure_cost(trial_)) {
                std::swap(trial_, other_);
                last_move_ = mixed_;
                return true;
            }
        }
        last_move_ = step_;
        return false;
    }
    // How the step has changed over the last move.
    void keep_difference() {
        if (differences_.size() == descent::most_mixed) differences_.erase(differences_.begin());
        differences_.push_back({last_step_, last_move_});
        Difference& last = differences_.back();
        for (std::size_t k = 0; k < step_.size(); ++k) {
            last.step[k] = step_[k] - last.step[k];
            last.move[k] += last.step[k];
        }
    }
    // The step, less the combination of earlier changes that leaves the least of it.
    void find_mix() {
        constexpr double dependent =
            1e-14;  // of the largest square: changes of no direction of their own are left out
        const std::size_t n = differences_.size();
        double A[descent::most_mixed][descent::most_mixed] = {}, y[descent::most_mixed] = {}, largest = 0;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) A[i][j] = inner(differences_[i].step, differences_[j].step);
            y[i] = inner(differences_[i].step, step_);
            largest = std::max(largest, A[i][i]);
        }
        solve_positive(A, int(n), y, dependent * largest);
        mixed_ = step_;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t k = 0; k < mixed_.size(); ++k) mixed_[k] -= y[i] * differences_[i].move[k];
        }
    }

    GraphStatus descend_damped(State& best) {
        double damping = descent::first_damping, growth = 2;
        last_step_.clear(), differences_.clear();
        while (iterations_left_-- > 0) {
            const double cost = linearize(best);
            const std::vector<double> diagonal = equations_->diagonal();
            std::vector<double> added(diagonal);
            for (bool is_better = false; !is_better;) {
                if (damping > descent::largest_damping) return GraphStatus::stopped;
                for (std::size_t k = 0; k < added.size(); ++k) added[k] = damping * diagonal[k];
                if (!solve_step(added.data())) {
                    if (damping * growth > descent::largest_damping) return GraphStatus::singular;
                    damping *= growth, growth *= 2;
                    continue;
                }
                double decrease = -inner(step_, equations_->gradient());
                for (std::size_t k = 0; k < added.size(); ++k) decrease += added[k] * step_[k] * step_[k];
                equations_->move_state(best, step_.data(), trial_);
                double trial_cost = measure_cost(trial_);
                const bool ends = damping <= descent::settled_damping && is_last(decrease, cost);
                is_better = trial_cost < cost;
                if (is_better) {
                    if (!ends && mix_steps(best, decrease <= descent::near_decrease * cost))
                        trial_cost = measure_cost(trial_);
                    std::swap(best, trial_);
                    const double gain = 2 * (cost - trial_cost) / decrease - 1;
                    damping =
                        std::max(damping * std::max(0.1, 1 - gain * gain * gain), descent::least_damping);
                    growth = 2;
                }
                if (ends) return GraphStatus::converged;
                if (!is_better) damping *= growth, growth *= 2;
            }
        }
        return GraphStatus::stopped;
    }

    // The region is a ball in the norm of the diagonal.
    GraphStatus descend_in_region(State& best) {
        double radius = -1, first_radius = 0;
        std::vector<double> newton, steepest;
        while (iterations_left_-- > 0) {
            const double cost = linearize(best);
            if (!solve_step(nullptr)) return GraphStatus::singular;
            newton = step_;
            const std::vector<double> diagonal = equations_->diagonal();
            find_steepest(diagonal, steepest);
            const double newton_length = scaled_norm(newton, diagonal);
            if (radius < 0) radius = first_radius = newton_length;
            for (bool is_better = false; !is_better;) {
                if (radius < descent::least_radius * first_radius) return GraphStatus::stopped;
                blend_steps(newton, steepest, diagonal, radius);
                product_.resize(step_.size());
                equations_->solver().multiply(equations_->values(), step_.data(), product_.data());
                const double decrease = -2 * inner(step_, equations_->gradient()) - inner(step_, product_);
                equations_->move_state(best, step_.data(), trial_);
                const double trial_cost = measure_cost(trial_);
                const bool ends = newton_length <= radius && is_last(decrease, cost);
                const double gain = (cost - trial_cost) / decrease;
                is_better = trial_cost < cost;
                if (is_better) std::swap(best, trial_);
                if (ends) return GraphStatus::converged;
                if (!(gain > 0.25)) radius = 0.25 * std::min(radius, newton_length);
                if (gain > 0.75) radius = std::max(radius, 2 * scaled_norm(step_, diagonal));
            }
        }
        return GraphStatus::stopped;
    }
    static double scaled_norm(const std::vector<double>& x, const std::vector<double>& diagonal) {
        double sum = 0;
        for (std::size_t k = 0; k < x.size(); ++k) sum += diagonal[k] * x[k] * x[k];
        return std::sqrt(sum);
    }
    // The minimum along −D⁻¹g.
    void find_steepest(const std::vector<double>& diagonal, std::vector<double>& steepest) {
        const auto& gradient = equations_->gradient();
        steepest.resize(gradient.size()), product_.resize(gradient.size());
        for (std::size_t k = 0; k < gradient.size(); ++k)
            steepest[k] = diagonal[k] > 0 ? -gradient[k] / diagonal[k] : 0;
        equations_->solver().multiply(equations_->values(), steepest.data(), product_.data());
        const double curvature = inner(steepest, product_);
        const double scale = curvature > 0 ? -inner(gradient, steepest) / curvature : 0;
        for (double& x : steepest) x *= scale;
    }
    void blend_steps(const std::vector<double>& newton, const std::vector<double>& steepest,
                     const std::vector<double>& diagonal, double radius) {
        const double long_step = scaled_norm(newton, diagonal), short_step = scaled_norm(steepest, diagonal);
        if (long_step <= radius) {
            step_ = newton;
            return;
        }
        if (short_step >= radius) {
            for (std::size_t k = 0; k < step_.size(); ++k) step_[k] = radius / short_step * steepest[k];
            return;
        }
        double a = 0, b = 0;  // |s + t (n − s)|² = radius²
        for (std::size_t k = 0; k < step_.size(); ++k) {
            const double across = newton[k] - steepest[k];
            a += diagonal[k] * across * across, b += diagonal[k] * across * steepest[k];
        }
        const double c = short_step * short_step - radius * radius;
        const double t = -c / (b + std::sqrt(b * b - a * c));
        for (std::size_t k = 0; k < step_.size(); ++k) step_[k] = steepest[k] + t * (newton[k] - steepest[k]);
    }

    const PoseGraph<Space>& graph_;
    GraphOptions options_;
    FactorWeights weights_;
    GraphStats stats_;
    std::unique_ptr<Equations> equations_;
    // Of two steps in a row; move: the move between them and that change together.
    struct Difference {
        std::vector<double> step, move;
    };

    State trial_, other_;
    std::vector<double> step_, squares_, product_;
    std::vector<double> last_step_, last_move_, mixed_;
    std::vector<Difference> differences_;
    int iterations_left_ = 0;
};

}  // namespace cspace::localization
