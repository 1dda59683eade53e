// SLAM of landmarks: what the bindings call.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "cspace/localization/landmarks/options.hpp"
#include "cspace/mobile/walk_rates.hpp"

namespace cspace::localization {

// Landmarks of a filter, a row each; covariances in axes of the map.
struct LandmarkRows {
    std::vector<std::int64_t> names;
    std::vector<double> points, covariances;  // 2 and 4 numbers
    std::vector<std::int32_t> seen;
    std::vector<std::uint8_t> is_confirmed;
};

class LandmarkFilter {
  public:
    virtual ~LandmarkFilter() = default;
    // The next pose in the last one, x, y, θ, and the covariance of its disturbance in the new base.
    virtual void predict(const std::array<double, 3>& increment, const std::array<double, 9>& noise) = 0;
    void predict_walk(const std::array<double, 3>& increment, const mobile::RandomWalk& walk,
                      double duration);
    // Readings of one time, rows name, range, bearing. Throws std::logic_error after an update that was
    // interrupted between two particles.
    virtual void update(std::span<const std::array<double, 3>> readings) = 0;
    virtual std::span<const ReadingOutcome> outcomes() const = 0;
    virtual std::array<double, 3> pose() const = 0;
    virtual std::array<double, 9> base_covariance() const = 0;
    virtual LandmarkRows landmarks() const = 0;
    virtual bool is_lost() const = 0;
    virtual const LandmarkCounts& counts() const = 0;
    // The joint covariance in axes of the map: x, y, θ and the landmarks; empty for particles.
    virtual std::vector<double> joint_covariance() const { return {}; }
    // Poses and shares of particles, rows x, y, θ, share.
    virtual std::vector<std::array<double, 4>> particles() const { return {}; }
    // Chunks of 16 landmarks that particles hold.
    virtual std::size_t chunks() const { return 0; }
};

std::unique_ptr<LandmarkFilter> make_ekf_slam(const EkfSlamRule& rule, const std::array<double, 3>& start,
                                              const std::array<double, 9>& covariance);
std::unique_ptr<LandmarkFilter> make_fast_slam(const FastSlamRule& rule, const std::array<double, 3>& start,
                                               const std::array<double, 9>& covariance);

}  // namespace cspace::localization
