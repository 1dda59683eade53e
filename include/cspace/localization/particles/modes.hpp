// Clusters of weighted particles: bins with weight that touch, each with its mean and covariance.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cspace/localization/particles/pose_bins.hpp"

namespace cspace::localization {

struct PoseMode {
    std::array<double, 3> pose;
    std::array<double, 9> covariance;  // of ξ in T exp ξ
    std::uint64_t weight;
};

struct WeightedParticles {
    std::span<const double> x, y;
    std::span<const Heading> headings;
    std::span<const std::uint32_t> weights;
    std::size_t size() const { return x.size(); }
};

inline constexpr BinRule mode_bins = {2.0, 24};
inline constexpr int least_share_of_bin = 64;  // bins with less of the heaviest one are no bridges

// The sets of bins that touch, of those that are heavy enough: the set of each bin, −1 without.
inline std::vector<int> join_bins(BinTable& bins, const std::vector<std::uint64_t>& weights) {
    const std::uint64_t heaviest = weights.empty() ? 0 : *std::max_element(weights.begin(), weights.end());
    std::vector<int> set(bins.size(), -1), open;
    int sets = 0;
    const auto is_heavy = [&](std::size_t k) {
        return weights[k] > 0 && weights[k] >= heaviest / least_share_of_bin;
    };
    for (std::size_t first = 0; first < bins.size(); ++first) {
        if (set[first] >= 0 || !is_heavy(first)) continue;
        set[first] = sets, open.assign(1, int(first));
        while (!open.empty()) {
            const PoseBin at = bins[std::size_t(open.back())];
            open.pop_back();
            for (int step = 0; step < 27; ++step) {
                const int sector = (at.sector + step / 9 + mode_bins.sectors - 1) % mode_bins.sectors;
                const int next = bins.find({at.column + step % 3 - 1, at.row + step / 3 % 3 - 1, sector});
                if (next < 0 || set[std::size_t(next)] >= 0 || !is_heavy(std::size_t(next))) continue;
                set[std::size_t(next)] = sets;
                open.push_back(next);
            }
        }
        ++sets;
    }
    return set;
}

// First and second moments of ξ about a pose, which is moved to the mean.
class ModeMoments {
  public:
    void begin(double x, double y, Heading heading) { x_ = x, y_ = y, heading_ = heading; }
    void add(double x, double y, Heading heading, double weight) {
        const double turn = double(std::int32_t(heading - heading_)) * heading_unit;
        total_ += weight, sum_[0] += weight * (x - x_), sum_[1] += weight * (y - y_),
            sum_[2] += weight * turn;
    }
    void move_to_mean() {
        x_ += sum_[0] / total_, y_ += sum_[1] / total_;
        heading_ += heading_of(sum_[2] / total_);
        const double angle = angle_of(heading_);
        cosine_ = std::cos(angle), sine_ = std::sin(angle);
    }
    // ξ = log(T̂⁻¹ T), with x cot x by its series, as headings of a mode are near each other.
    void add_square(double x, double y, Heading heading, double weight) {
        const double turn = double(std::int32_t(heading - heading_)) * heading_unit;
        const double u = cosine_ * (x - x_) + sine_ * (y - y_), v = cosine_ * (y - y_) - sine_ * (x - x_);
        const double half = 0.5 * turn, s = half * half, a = 1 - s * (1.0 / 3 + s * (1.0 / 45 + s * 2 / 945));
        const double xi[] = {a * u + half * v, a * v - half * u, turn};
        for (std::size_t i = 0, k = 0; i < 3; ++i)
            for (std::size_t j = 0; j <= i; ++j, ++k) square_[k] += weight * xi[i] * xi[j];
    }
    PoseMode finish(std::uint64_t weight) const {
        std::array<double, 6> P;
        for (std::size_t k = 0; k < 6; ++k) P[k] = square_[k] / total_;
        return {{x_, y_, angle_of(heading_)}, {P[0], P[1], P[3], P[1], P[2], P[4], P[3], P[4], P[5]}, weight};
    }

  private:
    double x_ = 0, y_ = 0, cosine_ = 1, sine_ = 0, total_ = 0;
    Heading heading_ = 0;
    std::array<double, 3> sum_ = {};
    std::array<double, 6> square_ = {};
};

// The modes of particles, the heaviest first. Weights of particles between them belong to none.
inline std::vector<PoseMode> find_pose_modes(const WeightedParticles& particles) {
    BinTable bins;
    std::vector<int> owner(particles.size(), -1);
    std::vector<std::uint64_t> weights;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (!particles.weights[i]) continue;
        owner[i] = bins.number_of(mode_bins.bin_of(particles.x[i], particles.y[i], particles.headings[i]));
        weights.resize(bins.size());
        weights[std::size_t(owner[i])] += particles.weights[i];
    }
    const std::vector<int> set = join_bins(bins, weights);
    const int sets = set.empty() ? 0 : *std::max_element(set.begin(), set.end()) + 1;
    std::vector<std::uint64_t> total = std::vector<std::uint64_t>(std::size_t(sets));
    for (std::size_t k = 0; k < set.size(); ++k)
        if (set[k] >= 0) total[std::size_t(set[k])] += weights[k];
    std::vector<ModeMoments> moments = std::vector<ModeMoments>(total.size());
    std::vector<bool> begun = std::vector<bool>(total.size());
    const auto visit = [&](const auto& call) {
        for (std::size_t i = 0; i < particles.size(); ++i) {
            if (owner[i] < 0 || set[std::size_t(owner[i])] < 0) continue;
            const std::size_t at = std::size_t(set[std::size_t(owner[i])]);
            call(at, particles.x[i], particles.y[i], particles.headings[i], double(particles.weights[i]));
        }
    };
    visit([&](std::size_t at, double x, double y, Heading heading, double weight) {
        if (!begun[at]) moments[at].begin(x, y, heading), begun[at] = true;
        moments[at].add(x, y, heading, weight);
    });
    for (ModeMoments& m : moments) m.move_to_mean();
    visit([&](std::size_t at, double x, double y, Heading heading, double weight) {
        moments[at].add_square(x, y, heading, weight);
    });
    std::vector<PoseMode> modes;
    for (std::size_t k = 0; k < moments.size(); ++k) modes.push_back(moments[k].finish(total[k]));
    std::stable_sort(modes.begin(), modes.end(),
                     [](const PoseMode& a, const PoseMode& b) { return a.weight > b.weight; });
    return modes;
}

}  // namespace cspace::localization
