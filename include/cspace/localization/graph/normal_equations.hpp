// The normal equations of a pose graph, JᵀWJ d = −JᵀWe, in blocks.
//
// The pattern is analysed for the measurements in use. A solver of robust problems leaves out those of hardly
// any weight: random false edges fill the factor, and cost a hundred times the rest.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "cspace/localization/graph/residuals.hpp"
#include "cspace/localization/graph/robust_kernels.hpp"
#include "cspace/math/sparse/cholesky.hpp"

namespace cspace::localization {

// Where the variables of a graph stand among the blocks; −1 for those that are held.
struct BlockNumbers {
    std::vector<int> pose, landmark;
    std::vector<int> sizes;
};

template <class Space>
BlockNumbers number_blocks(const PoseGraph<Space>& graph, int pose_size, int landmark_size) {
    BlockNumbers numbers;
    const auto number = [&](const std::vector<char>& is_held, int size, std::vector<int>& blocks) {
        for (char held : is_held) {
            blocks.push_back(held ? -1 : int(numbers.sizes.size()));
            if (!held) numbers.sizes.push_back(size);
        }
    };
    number(graph.is_held, pose_size, numbers.pose);
    number(graph.is_landmark_held, landmark_size, numbers.landmark);
    return numbers;
}

// The weights of all measurements, in the order of their squared errors, and what they make of these.
struct FactorWeights {
    RobustKernel kernel = RobustKernel::none;
    double width = 1;
    std::vector<double> fixed;  // empty: 1 each
};

template <class Space, class Fronts>
class NormalEquations {
  public:
    using Solver = SparseCholesky<Fronts>;

    // The equations of the measurements in use, at least all trusted ones.
    NormalEquations(const PoseGraph<Space>& graph, const std::vector<char>& is_used)
        : graph_(&graph),
          numbers_(number_blocks(graph, Space::freedom, Space::dimension)),
          is_used_(is_used) {
        std::vector<BlockPair> pairs;
        pairs.reserve(graph.factors());
        visit_factors([&](std::size_t, int a, int b) {
            if (a >= 0 && b >= 0) pairs.push_back({a, b});
        });
        solver_ = std::make_unique<Solver>(make_block_graph(numbers_.sizes, pairs));
        diagonal_.reserve(numbers_.sizes.size());
        for (int block = 0; block < int(numbers_.sizes.size()); ++block)
            diagonal_.push_back(solver_->slot_of(block, block).at);
        mixed_.resize(graph.factors());
        visit_factors([&](std::size_t factor, int a, int b) {
            if (a >= 0 && b >= 0) mixed_[factor] = solver_->slot_of(a, b);
        });
        values_.allocate(solver_->value_count());
        gradient_.resize(std::size_t(solver_->rows()));
    }

    Solver& solver() { return *solver_; }
    const double* values() const { return values_.data(); }
    const std::vector<double>& gradient() const { return gradient_; }
    const BlockNumbers& numbers() const { return numbers_; }
    bool is_used(std::size_t factor) const { return is_used_[factor] != 0; }

    // Fills the equations at a state; returns the cost of the measurements in use. squares: the squared error
    // of each measurement in use, by number.
    double linearize(const GraphState<Space>& state, ResidualKind kind, const FactorWeights& weights,
                     std::vector<double>& squares) {
        clear_values();
        std::fill(gradient_.begin(), gradient_.end(), 0.0);
        squares.resize(graph_->factors());
        double cost = 0;
        InterruptPoll poll(1 << 6);
        for (std::size_t k = 0; k < graph_->edges.size(); ++k) {
            if (!is_used_[k]) continue;
            poll.step();
            const RelativePose<Space>& edge = graph_->edges[k];
            cost += add_model(linearize_edge(edge, state, kind), k, graph_->is_trusted[k] != 0, weights,
                              numbers_.pose[std::size_t(edge.from)], numbers_.pose[std::size_t(edge.to)],
                              squares);
        }
        for (std::size_t k = 0; k < graph_->sightings.size(); ++k) {
            const std::size_t factor = graph_->edges.size() + k;
            if (!is_used_[factor]) continue;
            poll.step();
            const Sighting<Space>& seen = graph_->sightings[k];
            cost += add_model(linearize_sighting(seen, state), factor, graph_->is_sighting_trusted[k] != 0,
                              weights, numbers_.pose[std::size_t(seen.pose)],
                              numbers_.landmark[std::size_t(seen.landmark)], squares);
        }
        anchor_unmeasured();
        return cost;
    }

    // The diagonal, in the order of the vectors.
    std::vector<double> diagonal() const {
        std::vector<double> found(gradient_.size());
        for (std::size_t block = 0; block < diagonal_.size(); ++block) {
            const auto size = std::size_t(numbers_.sizes[block]);
            double* const to = found.data() + solver_->row_of(int(block));
            const double* const from = values_.data() + diagonal_[block];
            for (std::size_t k = 0; k < size; ++k) to[k] = from[k * (size + 1)];
        }
        return found;
    }

    // The state moved by a step, in the order of the vectors.
    void move_state(const GraphState<Space>& from, const double* step, GraphState<Space>& to) const {
        to = from;
        for (std::size_t k = 0; k < from.poses.size(); ++k) {
            if (numbers_.pose[k] >= 0)
                to.poses[k] = Space::move(from.poses[k], step + solver_->row_of(numbers_.pose[k]));
        }
        for (std::size_t k = 0; k < from.landmarks.size(); ++k) {
            if (numbers_.landmark[k] < 0) continue;
            const double* const here = step + solver_->row_of(numbers_.landmark[k]);
            for (std::size_t i = 0; i < Space::dimension; ++i) to.landmarks[k][i] += here[i];
        }
    }

  private:
    // visit(number, block, block) for each measurement in use.
    template <class Visit>
    void visit_factors(const Visit& visit) const {
        for (std::size_t k = 0; k < graph_->edges.size(); ++k) {
            if (is_used_[k])
                visit(k, numbers_.pose[std::size_t(graph_->edges[k].from)],
                      numbers_.pose[std::size_t(graph_->edges[k].to)]);
        }
        for (std::size_t k = 0; k < graph_->sightings.size(); ++k) {
            const std::size_t factor = graph_->edges.size() + k;
            if (is_used_[factor])
                visit(factor, numbers_.pose[std::size_t(graph_->sightings[k].pose)],
                      numbers_.landmark[std::size_t(graph_->sightings[k].landmark)]);
        }
    }

    void clear_values() {
        constexpr std::size_t chunk = 1 << 17;  // numbers between two looks at the clock
        const std::size_t count = solver_->value_count();
        for (std::size_t k = 0; k < count; k += chunk) {
            poll_interrupts();
            std::fill_n(values_.data() + k, std::min(chunk, count - k), 0.0);
        }
    }

    // Variables that no measurement in use moves stay where they are.
    void anchor_unmeasured() {
        for (std::size_t block = 0; block < diagonal_.size(); ++block) {
            const auto size = std::size_t(numbers_.sizes[block]);
            double* const at = values_.data() + diagonal_[block];
            double sum = 0;
            for (std::size_t k = 0; k < size; ++k) sum += at[k * (size + 1)];
            if (sum > 0) continue;
            for (std::size_t k = 0; k < size; ++k) at[k * (size + 1)] = 1;
        }
    }

    template <std::size_t a, std::size_t b>
    double add_model(const QuadraticModel<a, b>& model, std::size_t factor, bool is_trusted,
                     const FactorWeights& weights, int block_a, int block_b, std::vector<double>& squares) {
        squares[factor] = model.square;
        const double fixed = weights.fixed.empty() ? 1.0 : weights.fixed[factor];
        const KernelValue value = evaluate_kernel(is_trusted ? RobustKernel::none : weights.kernel,
                                                  fixed * model.square, weights.width);
        const double weight = fixed * value.weight;
        if (block_a >= 0) {
            add_diagonal<a>(weight, model.aa, diagonal_[std::size_t(block_a)]);
            add_gradient<a>(weight, model.ga, block_a);
        }
        if (block_b >= 0) {
            add_diagonal<b>(weight, model.bb, diagonal_[std::size_t(block_b)]);
            add_gradient<b>(weight, model.gb, block_b);
        }
        if (block_a >= 0 && block_b >= 0) add_mixed<a, b>(weight, model.ab, mixed_[factor]);
        return value.cost;
    }
    template <std::size_t n>
    void add_diagonal(double weight, const std::array<double, n * n>& block, std::size_t at) {
        double* const to = values_.data() + at;
        for (std::size_t k = 0; k < n * n; ++k) to[k] += weight * block[k];
    }
    template <std::size_t n>
    void add_gradient(double weight, const std::array<double, n>& part, int block) {
        double* const to = gradient_.data() + solver_->row_of(block);
        for (std::size_t k = 0; k < n; ++k) to[k] += weight * part[k];
    }
    // The block (a, b), row by row, into columns: as it is where the slot is transposed.
    template <std::size_t a, std::size_t b>
    void add_mixed(double weight, const std::array<double, a * b>& block, const BlockSlot& slot) {
        double* const to = values_.data() + slot.at;
        for (std::size_t i = 0; i < a; ++i) {
            for (std::size_t j = 0; j < b; ++j)
                to[slot.is_transposed ? i * b + j : j * a + i] += weight * block[i * b + j];
        }
    }

    const PoseGraph<Space>* graph_;
    BlockNumbers numbers_;
    std::vector<char> is_used_;
    std::unique_ptr<Solver> solver_;
    std::vector<std::size_t> diagonal_;  // value of each block's diagonal
    std::vector<BlockSlot> mixed_;       // of each measurement between two free variables
    RawNumbers values_;
    std::vector<double> gradient_;
};

}  // namespace cspace::localization
