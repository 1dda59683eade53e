// Point-to-line iterated closest points (Censi 2008): each point of a scan is drawn to the line through the
// two reference points nearest to it, and the farthest tenth is left out.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "cspace/localization/scans/scan_field.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::localization {

struct IcpResult {
    bool is_found = false;
    PlanarSpace::Pose pose;
    PlanarSpace::Square covariance{};
    double error = 0;  // root mean square distance from the lines [m]
    int pairs = 0;
};

namespace icp {

inline constexpr int most_iterations = 100;
inline constexpr double small_step = 1e-6;       // [m, rad]
inline constexpr double kept_share = 0.9;        // of the pairs, the nearest ones
inline constexpr double least_condition = 1e-6;  // of the equations: below it a direction is undetermined
inline constexpr int fewest_pairs = 6;

}  // namespace icp

// Nearest points, through buckets of a grid.
class NearestPoints {
  public:
    NearestPoints(std::span<const Point> points, double reach) : points_(points), reach_(reach) {
        if (points.empty()) return;
        box_ = bounds_of(points);
        const Point size = box_.high - box_.low;
        constexpr double most_side = 1024;
        bucket_ = std::max({reach, size.x / most_side, size.y / most_side});
        columns_ = 1 + int(size.x / bucket_), rows_ = 1 + int(size.y / bucket_);
        first_.assign(std::size_t(columns_ * rows_) + 1, 0);
        for (const Point p : points) ++first_[bucket_of(p) + 1];
        for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
        std::vector<int> next(first_.begin(), first_.end() - 1);
        members_.resize(points.size());
        for (std::size_t k = 0; k < points.size(); ++k)
            members_[std::size_t(next[bucket_of(points[k])]++)] = int(k);
    }
    // The two nearest points within reach; −1 for those that are not there.
    std::pair<int, int> find_two(Point p) const {
        int best = -1, second = -1;
        double near = reach_ * reach_, next = near;
        if (points_.empty()) return {best, second};
        const int column = int(std::floor((p.x - box_.low.x) / bucket_));
        const int row = int(std::floor((p.y - box_.low.y) / bucket_));
        for (int i = std::max(0, row - 1); i <= std::min(rows_ - 1, row + 1); ++i) {
            for (int j = std::max(0, column - 1); j <= std::min(columns_ - 1, column + 1); ++j) {
                const auto at = std::size_t(i * columns_ + j);
                for (int k = first_[at]; k < first_[at + 1]; ++k) {
                    const int member = members_[std::size_t(k)];
                    const double d = squared_norm(points_[std::size_t(member)] - p);
                    if (d < near) {
                        second = best, next = near;
                        best = member, near = d;
                    } else if (d < next) {
                        second = member, next = d;
                    }
                }
            }
        }
        return {best, second};
    }

  private:
    std::size_t bucket_of(Point p) const {
        return std::size_t(int((p.y - box_.low.y) / bucket_) * columns_ + int((p.x - box_.low.x) / bucket_));
    }
    std::span<const Point> points_;
    double reach_, bucket_ = 1;
    Box box_;
    int rows_ = 0, columns_ = 0;
    std::vector<int> first_, members_;
};

// The pose of a scan among reference points. reach: of a pair at the start [m].
inline IcpResult match_lines(std::span<const Point> reference, std::span<const Point> points,
                             const PlanarSpace::Pose& guess, double reach) {
    struct Pair {
        double square, rest, x, y, t;
    };
    IcpResult result;
    result.pose = guess;
    const NearestPoints nearest(reference, reach);
    std::vector<Pair> pairs;
    for (int iteration = 0; iteration < icp::most_iterations; ++iteration) {
        poll_interrupts();
        pairs.clear();
        for (const Point p : points) {
            const Point at = place_point(result.pose, p);
            const auto [a, b] = nearest.find_two(at);
            if (b < 0) continue;
            const Point along = reference[std::size_t(b)] - reference[std::size_t(a)];
            const double length = norm(along);
            if (!(length > 0)) continue;
            const Point normal{-along.y / length, along.x / length};
            const double rest = dot(normal, reference[std::size_t(a)] - at);
            const double x = result.pose.c * normal.x + result.pose.s * normal.y;
            const double y = result.pose.c * normal.y - result.pose.s * normal.x;
            pairs.push_back({rest * rest, rest, x, y, p.x * y - p.y * x});
        }
        const auto kept = std::size_t(icp::kept_share * double(pairs.size()));
        if (kept < icp::fewest_pairs) return result;
        std::nth_element(pairs.begin(), pairs.begin() + std::ptrdiff_t(kept), pairs.end(),
                         [](const Pair& a, const Pair& b) { return a.square < b.square; });
        pairs.resize(kept);
        PlanarSpace::Square H{};
        PlanarSpace::Twist g{};
        double squares = 0;
        for (const Pair& q : pairs) {
            squares += q.square;
            g[0] += q.rest * q.x, g[1] += q.rest * q.y, g[2] += q.rest * q.t;
            H[0] += q.x * q.x, H[1] += q.x * q.y, H[2] += q.x * q.t;
            H[4] += q.y * q.y, H[5] += q.y * q.t, H[8] += q.t * q.t;
        }
        result.error = std::sqrt(squares / double(kept)), result.pairs = int(kept);
        const auto [inverse, determinant] = find_cofactors(H);
        if (!(determinant > icp::least_condition * H[0] * H[4] * H[8])) return result;
        PlanarSpace::Twist twist;
        for (std::size_t i = 0; i < 3; ++i)
            twist[i] =
                (inverse[3 * i] * g[0] + inverse[3 * i + 1] * g[1] + inverse[3 * i + 2] * g[2]) / determinant;
        const double variance = squares / double(std::max(1, int(kept) - 3));
        for (std::size_t i = 0; i < 9; ++i) result.covariance[i] = variance * inverse[i] / determinant;
        result.pose = PlanarSpace::move(result.pose, twist.data());
        if (std::hypot(twist[0], twist[1]) + std::fabs(twist[2]) < icp::small_step) {
            result.is_found = true;
            return result;
        }
    }
    result.is_found = true;
    return result;
}

}  // namespace cspace::localization
