// Monte Carlo localisation: what the bindings call.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "cspace/math/plane.hpp"
#include "maps_grid.hpp"
#include "table.hpp"

namespace cspace::localization {

using PoseRow = std::array<double, 3>;  // x, y [m], θ [rad]

// A score per cell for the ends of beams, and one for everything outside.
class ScoreMap {
  public:
    ScoreMap(maps::CellBytes scores, double resolution, Point origin, int outside);
    ~ScoreMap();
    struct State;
    const State& state() const { return *state_; }

  private:
    std::unique_ptr<State> state_;
};

// A reading of a landmark: range and bearing, NaN where not measured; the row of the landmark, −1 for
// unknown.
struct LandmarkSightings {
    std::span<const double> ranges, bearings;
    std::span<const std::int32_t> rows;
    std::span<const Point> points;
    PoseRow mount;
    double range_sigma, bearing_sigma;
    double false_share;  // of readings that no landmark explains
};

// Weighted poses; the same seed gives the same ones on every machine and number of threads.
class ParticleCloud {
  public:
    ParticleCloud(std::size_t most, std::uint64_t seed);
    ~ParticleCloud();

    std::size_t size() const;
    std::size_t most() const;
    // Puts particles at poses, at most `most`, with equal weights.
    void place(std::span<const PoseRow> poses);
    // T ← T D exp(w) with D a pose and w normal with a covariance (by rows).
    void move(const PoseRow& increment, const std::array<double, 9>& covariance, int threads);
    // Adds to the logarithms of weights `exponent` per unit of the summed scores (0 … 255) of the beams,
    // which end at points in base. Returns the best mean score of a particle (0 … 1).
    double add_scan(const ScoreMap& map, std::span<const Point> ends, double exponent, int threads);
    // The mean scores (0 … 1) of all particles, weights as they were.
    Table<double> score(const ScoreMap& map, std::span<const Point> ends, int threads);
    // Adds logarithms, one per particle.
    void add_logs(std::span<const double> logs);
    // Adds those of readings; the best mean logarithm per measured number.
    double add_sightings(const LandmarkSightings& readings, double exponent, int threads);
    // (Σ w)² / Σ w².
    double effective_count() const;
    // Systematic resampling to as many particles as the occupied bins need, at least `least`; equal weights.
    // Returns the number of bins.
    std::size_t resample(std::size_t least, double error, double z);
    // The modes: poses (k, 3), covariances (k, 9) in base, shares of the weight (k,).
    std::tuple<Table<double>, Table<double>, Table<double>> find_modes() const;
    Table<double> poses() const;  // (n, 3)
    // Those from begin to end − 1, and the one with the most weight, the first of equals.
    Table<double> poses(std::size_t begin, std::size_t end) const;
    Table<double> heaviest() const;  // (1, 3)
    Table<double> weights() const;   // (n,), of sum 1
    // Numbers that a draw of this cloud gives, for whoever places particles.
    Table<double> draw_normals(std::size_t count);  // (count, 3)

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Four random words of a counter (4,) and a key (2,): Philox 4×32 (Salmon et al. 2011).
Table<std::uint32_t> draw_counter_words(std::span<const std::uint32_t> counter,
                                        std::span<const std::uint32_t> key);
double count_particles_for_bins(std::size_t bins, double error, double z);

}  // namespace cspace::localization
