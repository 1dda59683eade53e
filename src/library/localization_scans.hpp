// Scan matching and laser SLAM: what the bindings call.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cspace/math/plane.hpp"

namespace cspace::localization {

using PoseRow = std::array<double, 3>;    // x, y [m], θ [rad]
using SquareRow = std::array<double, 9>;  // a matrix 3 × 3

// A field of scores: bytes (rows, columns) of cells, of which cell (0, 0) has its least corner at the origin.
struct ScoreArray {
    const std::uint8_t* scores;
    int rows, columns;
    double resolution;
    Point origin;
    int outside;
};
struct PointField {
    std::vector<std::uint8_t> scores;
    int columns;
    Point origin;
};

struct ScanMatchResult {
    bool is_found, is_ambiguous;
    PoseRow pose;
    SquareRow covariance;  // of the twist in base
    double score, second;
};

// The best pose of points of base on a field, within half sides of a window about a guess, refined between
// the cells if asked.
ScanMatchResult match_points(const ScoreArray& field, std::span<const Point> points, const PoseRow& guess,
                             double reach, double turn, bool refines);
// The pose of points among reference points, by point-to-line ICP; pairs lie within `reach`.
ScanMatchResult match_point_lines(const ScoreArray& field, std::span<const Point> reference,
                                  std::span<const Point> points, const PoseRow& guess, double reach);
// A field of bells about points, exp(−d²/2σ²).
PointField make_field_of_points(std::span<const Point> points, double resolution, double sigma);

// The points of scans, at most so many of each, evenly spread along the walls; first: where each scan begins,
// which is brought up to date.
std::vector<Point> thin_scans(std::span<const Point> points, std::vector<std::int32_t>& first, int most);

// A relative pose between two scans.
struct ScanRelation {
    std::int32_t from, to;
    PoseRow pose;
    SquareRow covariance;
    double score, second;
    int verdict;  // of loops: accepted, ambiguous, inconsistent, alone, clipped
};
struct SlamRule {
    double first_angle, span;  // of the field of view in the frame of the laser [rad]
    PoseRow T_base_laser;
    double resolution, sigma;
    bool finds_loops;
};

class LaserSlamRun {
  public:
    virtual ~LaserSlamRun() = default;
    // Works on so many scans more; false when all are done.
    virtual bool advance(int scans) = 0;
    virtual int done() const = 0;
    virtual int tried() const = 0;
    virtual int optimizations() const = 0;
    virtual std::vector<PoseRow> poses() const = 0;
    virtual std::vector<PoseRow> matched() const = 0;
    virtual std::vector<ScanRelation> edges() const = 0;
    virtual std::vector<ScanRelation> loops() const = 0;
};

// points of all scans in base, first (n + 1): where each scan begins; steps: twists between the scans.
// Throws std::invalid_argument for arrays that do not fit together.
std::unique_ptr<LaserSlamRun> make_laser_slam(std::span<const Point> points,
                                              std::span<const std::int32_t> first,
                                              std::span<const PoseRow> steps, const SlamRule& rule);

}  // namespace cspace::localization
