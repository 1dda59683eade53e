// What SLAM of landmarks is asked for, and what became of a reading.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

namespace cspace::localization {

struct RangeBearingSensor {
    double range_sigma = 0.15, bearing_sigma = 0.015;  // [m], [rad]
    double range_bias = 0, bearing_bias = 0;
    std::array<double, 3> mount{};  // on base
    double most_range = 1e300, half_view = std::numbers::pi;
};

// One reading; NaN where not measured. A name below zero is unknown.
struct LandmarkReading {
    std::int64_t name = -1;
    double range = 0, bearing = 0;
};

enum class Linearization { invariant, first_estimate, plain };

// When a landmark without a name is kept, and when the robot is lost.
struct LandmarkRule {
    double gate = 0.999;       // share of χ² beyond which a reading is rejected
    double pair_share = 0.99;  // of χ², within which readings without names are paired: each, and all at once
    double new_share = 0.9999;  // a reading beyond this share of χ² of all landmarks is a new one
    int confirmed_after = 3;    // updates that saw a landmark without a name
    int dropped_after = 20;     // updates in a row that should have seen it, of one that is not confirmed
    int lost_after = 10;        // rejections in a row
};

struct EkfSlamRule {
    RangeBearingSensor sensor;
    Linearization linearization = Linearization::invariant;
    LandmarkRule landmarks;
    bool is_joint = true;  // false: sequential compatible nearest neighbour
    long most_nodes =
        20000;  // of the search for joint compatibility; then the best pairings so far are taken
};

struct FastSlamRule {
    RangeBearingSensor sensor;
    LandmarkRule landmarks;
    int version = 2;
    std::size_t particles = 100;
    std::uint64_t seed = 0;
    double resample_below = 0.5;  // effective number over the number of particles
};

enum class ReadingVerdict : std::uint8_t { used, rejected, created, skipped };

struct ReadingOutcome {
    std::int64_t name = -1;
    ReadingVerdict verdict = ReadingVerdict::skipped;
    int dof = 0;
    double nis = std::numeric_limits<double>::quiet_NaN();
    std::array<double, 2> innovation{nis, nis};
};

struct LandmarkCounts {
    long updates = 0, used = 0, rejected = 0, created = 0, skipped = 0, dropped = 0, inflations = 0,
         capped = 0, resamplings = 0;
};

}  // namespace cspace::localization
