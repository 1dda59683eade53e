// Which loops agree with each other: pairwise consistent measurement sets (Mangelson, Dominic, Eustice &
// Vasudevan 2018).
//
// Two loops and the two stretches of the chain between their ends close a cycle. Its error has a covariance,
// the sum of those of its four parts. The loops of a largest set in which each pair closes within a quantile
// are kept.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "cspace/localization/graph/planar_space.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::localization {

using PlanarSquare = PlanarSpace::Square;

// A M Aᵀ with A the adjoint of a pose.
inline PlanarSquare transport_covariance(const PlanarSpace::Pose& pose, const PlanarSquare& M) {
    const PlanarSquare A = PlanarSpace::adjoint(pose);
    PlanarSquare AM{}, result{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) AM[3 * i + j] += A[3 * i + k] * M[3 * k + j];
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) result[3 * i + j] += AM[3 * i + k] * A[3 * j + k];
    return result;
}
// eᵀ M⁻¹ e of a symmetric matrix; infinite where it is not positive definite.
inline double mahalanobis_square(PlanarSquare M, const PlanarSpace::Twist& e) {
    MatrixRows<double> rows{M.data(), 3};
    PlanarSpace::Twist y = e;
    if (!solve_positive(rows, 3, y.data())) return INFINITY;
    return e[0] * y[0] + e[1] * y[1] + e[2] * y[2];
}
inline PlanarSquare inverse_covariance(const PlanarSquare& M) {
    Cofactors inverse = find_cofactors(M);
    for (double& x : inverse.of) x *= 1 / inverse.determinant;
    return inverse.of;
}

// A relative pose between two poses of the chain that are far apart along it.
struct ClosedLoop {
    int from, to;
    PlanarSpace::Pose z;
    PlanarSquare covariance;  // of the twist at `to`
};

class LoopConsistency {
  public:
    using Pose = PlanarSpace::Pose;

    // Poses of the chain, one after the other, with the covariance of each step at its end.
    void add_pose(const Pose& pose, const PlanarSquare& step) {
        PlanarSquare sum = transport_covariance(pose, step);
        if (!sums_.empty())
            for (std::size_t k = 0; k < 9; ++k) sum[k] += sums_.back()[k];
        poses_.push_back(pose), sums_.push_back(sum);
    }
    const Pose& pose(int k) const { return poses_[std::size_t(k)]; }
    // The covariance of a stretch of the chain, in the frame of a pose.
    PlanarSquare stretch(int from, int to, const Pose& frame) const {
        PlanarSquare between;
        const PlanarSquare &first = sums_[std::size_t(std::min(from, to))],
                           &last = sums_[std::size_t(std::max(from, to))];
        for (std::size_t k = 0; k < 9; ++k) between[k] = last[k] - first[k];
        return transport_covariance(PlanarSpace::inverse(frame), between);
    }
    // The squared error of the cycle of two loops, in units of its covariance.
    double cycle_error(const ClosedLoop& a, const ClosedLoop& b) const {
        const Pose &ka = pose(a.to), &kb = pose(b.to), &ia = pose(a.from), &ib = pose(b.from);
        const Pose there = PlanarSpace::compose(a.z, PlanarSpace::between(ka, kb));  // to of b, in from of a
        const Pose back = PlanarSpace::compose(there, PlanarSpace::inverse(b.z));    // from of b
        const auto error = PlanarSpace::logarithm(PlanarSpace::compose(back, PlanarSpace::between(ib, ia)));
        PlanarSquare M = transport_covariance(a.z, a.covariance);
        add(M, transport_covariance(there, b.covariance));
        add(M, transport_covariance(a.z, stretch(a.to, b.to, ka)));
        add(M, transport_covariance(back, stretch(a.from, b.from, ib)));
        return mahalanobis_square(M, error);
    }

  private:
    static void add(PlanarSquare& sum, const PlanarSquare& M) {
        for (std::size_t k = 0; k < 9; ++k) sum[k] += M[k];
    }
    std::vector<Pose> poses_;
    std::vector<PlanarSquare> sums_;  // of the covariances of all steps, in the map
};

// Sets of numbers as bits, for the search of cliques.
class AgreementGraph {
  public:
    int size() const { return int(rows_.size()); }
    void add_node() {
        rows_.emplace_back();
        for (auto& row : rows_) row.resize(rows_.size() / 64 + 1, 0);
        degrees_.push_back(0);
    }
    void join(int a, int b) {
        rows_[std::size_t(a)][std::size_t(b) / 64] |= std::uint64_t(1) << (b % 64);
        rows_[std::size_t(b)][std::size_t(a) / 64] |= std::uint64_t(1) << (a % 64);
        ++degrees_[std::size_t(a)], ++degrees_[std::size_t(b)];
    }
    bool are_joined(int a, int b) const { return rows_[std::size_t(a)][std::size_t(b) / 64] >> (b % 64) & 1; }
    // Nodes of which all are joined, as many as a greedy search finds from every start whose degree allows
    // for more (Pattabiraman et al. 2015).
    std::vector<char> find_clique() const {
        std::vector<int> order(rows_.size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(),
                         [&](int a, int b) { return degrees_[std::size_t(a)] > degrees_[std::size_t(b)]; });
        std::vector<int> best, clique;
        int starts = 0;
        for (int start : order) {
            if (degrees_[std::size_t(start)] + 1 <= int(best.size()) || ++starts > most_starts) break;
            poll_interrupts();
            clique.assign(1, start);
            std::vector<std::uint64_t> left = rows_[std::size_t(start)];
            for (int next : order) {
                if (!(left[std::size_t(next) / 64] >> (next % 64) & 1)) continue;
                clique.push_back(next);
                for (std::size_t k = 0; k < left.size(); ++k) left[k] &= rows_[std::size_t(next)][k];
            }
            if (clique.size() > best.size()) best = clique;
        }
        std::vector<char> is_member(rows_.size(), 0);
        for (int node : best) is_member[std::size_t(node)] = 1;
        return is_member;
    }

  private:
    static constexpr int most_starts = 100;
    std::vector<std::vector<std::uint64_t>> rows_;
    std::vector<int> degrees_;
};

}  // namespace cspace::localization
