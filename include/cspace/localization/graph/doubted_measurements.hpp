// The measurements of a pose graph that a robust method may reject, with the squared errors up to which they
// count.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "cspace/localization/graph/options.hpp"
#include "cspace/localization/graph/pose_graph.hpp"

namespace cspace::localization {

// Squared error that a true measurement of so many coordinates exceeds once in a thousand times.
inline double quantile_999(int coordinates) {
    constexpr double quantiles[] = {0, 10.828, 13.816, 16.266, 18.467, 20.515, 22.458};
    return quantiles[coordinates];
}

// The same of nine coordinates or more, within a part in 500 (Wilson & Hilferty 1931).
inline double quantile_999_of_many(double coordinates) {
    constexpr double deviations = 3.0902;  // of the normal distribution
    const double width = 2 / (9 * coordinates), root = 1 - width + deviations * std::sqrt(width);
    return coordinates * root * root * root;
}

template <class Space>
std::vector<double> find_limits(const PoseGraph<Space>& graph) {
    std::vector<double> limits(graph.edges.size(), quantile_999(Space::freedom));
    for (const auto& seen : graph.sightings) {
        int coordinates = 0;
        for (std::size_t k = 0; k < Space::dimension; ++k)
            coordinates += seen.W[k * (Space::dimension + 1)] > 0;
        limits.push_back(quantile_999(coordinates));
    }
    return limits;
}

template <class Space>
std::vector<char> find_trusted(const PoseGraph<Space>& graph) {
    std::vector<char> trusted(graph.is_trusted);
    trusted.insert(trusted.end(), graph.is_sighting_trusted.begin(), graph.is_sighting_trusted.end());
    return trusted;
}

template <class Space>
struct RobustAnswer {
    GraphState<Space> state;
    GraphStatus status = GraphStatus::stopped;
    std::vector<char> is_used;  // by measurement
    double scale = 1;           // of the limits of the squared errors
    std::vector<double> squares;
};

}  // namespace cspace::localization
