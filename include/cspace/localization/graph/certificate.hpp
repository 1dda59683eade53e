// A certificate that an answer is the global optimum, from the dual of its pose graph (Carlone, Rosen, Calafiore,
// Leonard & Dellaert 2015, "Lagrangian duality in 3D SLAM"; Rosen, Carlone, Bandeira & Leonard 2019, "SE-Sync").
//
// The dual is that of the chordal problem, in which each rotational error θ counts as 2 sin(θ/2): quadratic in the
// entries of rotations and positions, Σ tr(Y M Yᵀ) with RᵀR = I. For isotropic information its cost is nowhere
// above that of the twists, so that its least value bounds χ² of all states from below. A state where S = M − Λ
// is positive semidefinite has that least value; Λ are the multipliers that its stationarity gives.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cspace/localization/graph/initial_guess.hpp"
#include "cspace/localization/graph/optimizer.hpp"

namespace cspace::localization {

// The first measurement in use whose information is not isotropic, position and rotation apart; −1: none.
// Sightings of range and bearing have no such dual either.
template <class Space>
std::ptrdiff_t find_anisotropic(const PoseGraph<Space>& graph, const std::vector<char>& is_used) {
    constexpr double same = 1e-6;  // relative: files print seven digits and more
    constexpr std::size_t n = Space::freedom, d = Space::dimension;
    const auto fits = [](double value, double wanted, double scale) {
        return std::fabs(value - wanted) <= same * scale;
    };
    for (std::size_t k = 0; k < graph.edges.size(); ++k) {
        if (!is_used[k]) continue;
        const auto& W = graph.edges[k].W;
        const double position = W[0], rotation = W[n * n - 1], scale = std::max(position, rotation);
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) {
                const double own = i < d ? position : rotation;
                if (!fits(W[i * n + j], i == j ? own : 0, i == j ? own : std::sqrt(position * rotation)) ||
                    !(scale > 0))
                    return std::ptrdiff_t(k);
            }
        }
    }
    for (std::size_t k = 0; k < graph.sightings.size(); ++k) {
        const std::size_t factor = graph.edges.size() + k;
        if (!is_used[factor]) continue;
        const auto& seen = graph.sightings[k];
        if (seen.kind != SightingKind::point) return std::ptrdiff_t(factor);
        for (std::size_t i = 0; i < d * d; ++i) {
            if (!fits(seen.W[i], i % (d + 1) == 0 ? seen.W[0] : 0, seen.W[0])) return std::ptrdiff_t(factor);
        }
    }
    return -1;
}

template <class Space, class Fronts>
class DualCertificate {
  public:
    DualCertificate(const PoseGraph<Space>& graph, const std::vector<char>& is_used)
        : graph_(graph), is_used_(is_used), system_(block_sizes(graph), block_pairs(graph, is_used), int(sides)) {}

    // Moves a state to the stationary state of the chordal problem next to it, and tries to prove that this is the
    // global optimum.
    CertificateResult certify(GraphState<Space> state) {
        CertificateResult found;
        const double chordal_cost = settle(state, ResidualKind::chordal);
        add_measurements();
        hold_position();
        subtract_multipliers(relax(state));
        double at = 0;
        for (double share : dual_shifts) {
            const double shift = share * mean_weight_;
            shift_rotations(shift - at);
            at = shift;
            found.is_proved = system_.solver().factor_matrix(system_.values().data());
            if (!found.is_proved) continue;
            // The shift takes its product with the squared norm of all rotations from the dual's value.
            const double norm = double(graph_.start.poses.size()) * double(sides);
            found.bound = std::max(0.0, chordal_cost - shift * norm);
            break;
        }
        found.cost = settle(state, ResidualKind::twist);
        return found;
    }

  private:
    static constexpr std::size_t n = Space::relaxed, p = Space::relaxed_point, r = Space::rotation_part;
    static constexpr std::size_t sides = Space::right_sides, d = Space::dimension;
    // Of the mean weight of rotations, added to the dual matrix, which is singular at an optimum.
    static constexpr double dual_shifts[] = {1e-9, 1e-8, 1e-7};

    static std::vector<int> block_sizes(const PoseGraph<Space>& graph) {
        std::vector<int> sizes(graph.start.poses.size(), int(n));
        sizes.resize(sizes.size() + graph.start.landmarks.size(), int(p));
        return sizes;
    }
    static std::vector<BlockPair> block_pairs(const PoseGraph<Space>& graph, const std::vector<char>& is_used) {
        std::vector<BlockPair> pairs;
        for (std::size_t k = 0; k < graph.edges.size(); ++k) {
            if (is_used[k]) pairs.push_back({graph.edges[k].from, graph.edges[k].to});
        }
        for (std::size_t k = 0; k < graph.sightings.size(); ++k) {
            if (is_used[graph.edges.size() + k])
                pairs.push_back({graph.sightings[k].pose,
                                 int(graph.start.poses.size()) + graph.sightings[k].landmark});
        }
        return pairs;
    }

    // The optimum next to a state; its cost.
    double settle(GraphState<Space>& state, ResidualKind residual) const {
        GraphOptions options;
        options.residual = residual;
        options.least_step = 1e-9, options.least_decrease = 1e-14;  // of what the multipliers are made
        GraphOptimizer<Space, Fronts> optimizer(graph_, options);
        optimizer.use_factors(is_used_);
        optimizer.optimize(state);
        return optimizer.measure_cost(state);
    }
    void add_measurements() {
        double sum = 0, count = 0;
        for (std::size_t k = 0; k < graph_.edges.size(); ++k) {
            if (!is_used_[k]) continue;
            const auto& edge = graph_.edges[k];
            const auto A = Space::relaxed_motion(edge.z);
            const auto mean = average_information<Space>(edge.W);
            std::array<double, n> weights;
            for (std::size_t i = 0; i < n; ++i) weights[i] = i < r ? mean.rotation : mean.position;
            system_.add_equation(edge.from, edge.to, A.data(), int(n), int(n), weights.data(), nullptr, nullptr,
                                 nullptr);
            sum += mean.rotation, count += 1;
        }
        for (std::size_t k = 0; k < graph_.sightings.size(); ++k) {
            if (!is_used_[graph_.edges.size() + k]) continue;
            const auto& seen = graph_.sightings[k];
            const auto motion = Space::relaxed_motion(Space::with_position(typename Space::Pose{}, seen.z));
            std::array<double, p> weights;
            weights.fill(seen.W[0]);
            system_.add_equation(seen.pose, int(graph_.start.poses.size()) + seen.landmark,
                                 motion.data() + (n - p) * n, int(p), int(n), weights.data(), nullptr, nullptr,
                                 nullptr);
        }
        mean_weight_ = count > 0 ? sum / count : 1;
    }
    double& diagonal(int block, int row) {
        const BlockSlot slot = system_.solver().slot_of(block, block);
        return system_.values()[slot.at + std::size_t(row) * std::size_t(slot.rows + 1)];
    }
    // The first pose is at the origin, which takes no generality away and makes translations determined.
    void hold_position() {
        for (int row = int(r); row < int(n); ++row) diagonal(0, row) += mean_weight_;
    }
    // The state as unknowns of the quadratic problem, one vector per side, with the first pose at the origin.
    std::vector<std::vector<double>> relax(const GraphState<Space>& state) {
        auto& solver = system_.solver();
        std::vector<std::vector<double>> Y(sides, std::vector<double>(std::size_t(solver.rows())));
        const auto origin = Space::position(state.poses[0]);
        const auto shift = [&](typename Space::Point at) {
            for (std::size_t k = 0; k < d; ++k) at[k] -= origin[k];
            return at;
        };
        for (std::size_t k = 0; k < state.poses.size(); ++k) {
            std::array<double, n * sides> relaxed;
            const auto& pose = state.poses[k];
            Space::write_relaxed(Space::with_position(pose, shift(Space::position(pose))), relaxed.data());
            for (std::size_t side = 0; side < sides; ++side)
                std::copy_n(relaxed.data() + side * n, n, Y[side].data() + solver.row_of(int(k)));
        }
        for (std::size_t k = 0; k < state.landmarks.size(); ++k) {
            const auto at = shift(state.landmarks[k]);
            const int row = solver.row_of(int(state.poses.size() + k));
            for (std::size_t side = 0; side < sides; ++side)
                std::copy_n(at.data() + side * p, p, Y[side].data() + row);
        }
        return Y;
    }
    // Λ = sym(Rᵀ (Y M)): of each pose a number in the plane, and a matrix in space.
    void subtract_multipliers(const std::vector<std::vector<double>>& Y) {
        auto& solver = system_.solver();
        std::vector<std::vector<double>> products(sides, std::vector<double>(Y[0].size()));
        for (std::size_t side = 0; side < sides; ++side)
            solver.multiply(system_.values().data(), Y[side].data(), products[side].data());
        for (int k = 0; k < int(graph_.start.poses.size()); ++k) {
            const auto row = std::size_t(solver.row_of(k));
            std::array<double, r * r> L{};
            for (std::size_t side = 0; side < sides; ++side) {
                const double *const y = Y[side].data() + row, *const m = products[side].data() + row;
                for (std::size_t i = 0; i < r; ++i) {
                    for (std::size_t j = 0; j < r; ++j)
                        L[i * r + j] += 0.5 * (y[i] * m[j] + m[i] * y[j]);
                }
            }
            if constexpr (d == 2) L = {L[0] + L[3], 0, 0, L[0] + L[3]};  // rotations are complex numbers
            const BlockSlot slot = solver.slot_of(k, k);
            for (std::size_t i = 0; i < r; ++i) {
                for (std::size_t j = 0; j < r; ++j) system_.values()[slot.at + j * n + i] -= L[i * r + j];
            }
        }
    }
    void shift_rotations(double shift) {
        for (int k = 0; k < int(graph_.start.poses.size()); ++k) {
            for (int row = 0; row < int(r); ++row) diagonal(k, row) += shift;
        }
    }

    const PoseGraph<Space>& graph_;
    const std::vector<char>& is_used_;
    LinearGraph<Fronts> system_;
    double mean_weight_ = 1;
};

}  // namespace cspace::localization
