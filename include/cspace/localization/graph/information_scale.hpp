// By what factor the information of a graph is too large, judged by what robust answers keep.
//
// Robust methods compare errors with what the information says. Where that is ten times too large, true loops
// exceed their limits, and all go. So the graph is also solved as if its information was W / c, and the
// answer that explains the measurements best counts: those that it keeps have the probability of normal
// errors, and those that it rejects are spread evenly over all relative poses that the graph has room for. −2
// log of this is, but for what is the same for all c,
//
//     Σ eᵀWe / c + (measured − unknown numbers) log c + Σ over the rejected (2 log V + log det W / (2π)ⁿ).
//
// The poses are integrated out (Laplace's method), since otherwise a graph that keeps no loop would fit too
// well. Nothing depends on the units. Information that is too small is left to the tests of `LoopSelection`:
// true errors have heavy tails, so that scales below 1 would cost true loops.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "cspace/localization/graph/doubted_measurements.hpp"
#include "cspace/localization/graph/edge_test.hpp"
#include "cspace/localization/graph/initial_guess.hpp"

namespace cspace::localization {

namespace information_scale {

inline constexpr double factor = 10;       // from one scale to the next
inline constexpr int most_steps = 4;       // of that factor
inline constexpr int least_steps = 2;      // before steps without gain end it
inline constexpr double most_fit = 1.5;    // χ² per degree of freedom beyond which it is tried
inline constexpr double few_kept = 0.1;    // of the loops: the information may be too large
inline constexpr double least_kept = 0.2;  // of the loops, for another scale to count: some false ones agree
// Of the cost of rejected measurements: false loops alone fold a graph until errors fit some large scale.
inline constexpr double evenness = 0.5;
inline constexpr double odds = 10;  // −2 log of those at which another scale counts

}  // namespace information_scale

// The same graph with the information divided by a scale.
template <class Space>
PoseGraph<Space> divide_information(PoseGraph<Space> graph, double scale) {
    for (auto& edge : graph.edges) {
        for (double& w : edge.W) w /= scale;
    }
    for (auto& seen : graph.sightings) {
        for (double& w : seen.W) w /= scale;
    }
    return graph;
}

template <class Space>
class LoopEvidence {
  public:
    explicit LoopEvidence(const PoseGraph<Space>& graph)
        : graph_(graph), trusted_(find_trusted(graph)), costs_(find_limits(graph)) {
        constexpr std::size_t n = Space::freedom, d = Space::dimension;
        unknowns_ = double(n) * count_free(graph.is_held) + double(d) * count_free(graph.is_landmark_held);
        const double length = find_extent();
        for (std::size_t k = 0; k < graph.edges.size(); ++k)
            raise_cost<n>(k, graph.edges[k].W, length, [](std::size_t axis) { return axis >= d; });
        for (std::size_t k = 0; k < graph.sightings.size(); ++k) {
            const bool has_bearing = graph.sightings[k].kind == SightingKind::range_bearing;
            raise_cost<d>(graph.edges.size() + k, graph.sightings[k].W, length,
                          [&](std::size_t axis) { return has_bearing && axis == 1; });
        }
    }

    // −2 log of the evidence. squares: of the errors, with the information that the graph has.
    double measure_cost(const std::vector<double>& squares, const std::vector<char>& is_used,
                        double scale) const {
        double cost = count_spare(is_used) * std::log(scale);
        for (std::size_t k = 0; k < squares.size(); ++k) cost += is_used[k] ? squares[k] / scale : costs_[k];
        return cost;
    }
    // χ² per degree of freedom of what is kept; 1 where nothing is left over.
    double measure_fit(const std::vector<double>& squares, const std::vector<char>& is_used) const {
        double sum = 0;
        for (std::size_t k = 0; k < squares.size(); ++k) sum += is_used[k] ? squares[k] : 0;
        const double spare = count_spare(is_used);
        return spare > 0 ? sum / spare : 1;
    }
    // The share of the doubted measurements that is kept; 1 where there are none.
    double measure_share(const std::vector<char>& is_used) const {
        double kept = 0, doubted = 0;
        for (std::size_t k = 0; k < is_used.size(); ++k) {
            if (!trusted_[k]) doubted += 1, kept += is_used[k] ? 1 : 0;
        }
        return doubted > 0 ? kept / doubted : 1;
    }

  private:
    static double count_free(const std::vector<char>& is_held) {
        return double(std::count(is_held.begin(), is_held.end(), 0));
    }
    // Measured numbers minus unknown ones.
    double count_spare(const std::vector<char>& is_used) const {
        double numbers = -unknowns_;
        for (std::size_t k = 0; k < is_used.size(); ++k) {
            if (is_used[k]) numbers += k < graph_.edges.size() ? Space::freedom : Space::dimension;
        }
        return std::max(numbers, 0.0);
    }
    // The diagonal of the box about dead reckoning.
    double find_extent() const {
        const GraphState<Space> state = reckon_poses(graph_);
        typename Space::Point low = Space::position(state.poses.front()), high = low;
        for (const auto& pose : state.poses) {
            const typename Space::Point at = Space::position(pose);
            for (std::size_t k = 0; k < Space::dimension; ++k)
                low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
        }
        double sum = 0;
        for (std::size_t k = 0; k < Space::dimension; ++k) sum += (high[k] - low[k]) * (high[k] - low[k]);
        return std::sqrt(sum);
    }
    // What it costs to reject a measurement, at least its limit.
    template <std::size_t size, class IsAngle>
    void raise_cost(std::size_t k, const std::array<double, size * size>& W, double length,
                    const IsAngle& is_angle) {
        constexpr double circle = 2 * std::numbers::pi;
        const std::array<double, size * size> L = factor_semidefinite<size>(W, least_pivot);
        double cost = 0;
        for (std::size_t axis = 0; axis < size; ++axis) {
            const double root = L[axis * (size + 1)];
            if (root > 0) cost += 2 * std::log((is_angle(axis) ? circle : length) * root) - std::log(circle);
        }
        costs_[k] = std::max(costs_[k], information_scale::evenness * cost);
    }

    const PoseGraph<Space>& graph_;
    std::vector<char> trusted_;
    std::vector<double> costs_;  // of a measurement that is rejected
    double unknowns_ = 0;
};

}  // namespace cspace::localization
