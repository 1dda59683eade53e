// Evidence of cells being occupied, summed over scans of a range finder (Moravec & Elfes 1985; Thrun, Burgard
// & Fox 2005, section 9.2): log-odds as whole numbers.
//
// In each scan a cell counts once: as hit if a beam ends in it, else as missed if one passes through it. Sums
// of whole numbers depend on the order of scans in no bit.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/math/plane.hpp"

namespace cspace::maps {

// A part of an endless grid: cell (row, column) of the part spans y in anchor.y + resolution · [row +
// low_row, row + low_row + 1], and x likewise. So grids of one anchor have the same cells.
struct EvidencePart {
    double resolution;
    Point anchor;
    std::int32_t low_row, low_column, rows, columns;
};

// What a scan adds to a cell, and which ranges count [m].
struct EvidenceRule {
    std::int32_t hit, miss;
    double max_range;    // a beam that returned from farther away misses all cells up to here
    double clear_range;  // one that did not return misses all up to here
};

// A scan of `angles` [rad] with x forwards, from a pose of the laser; ranges that are not finite, or not
// below `most`, are no returns.
struct LaserPose {
    double x, y, theta;
};
struct LaserBeams {
    std::span<const double> angles;
    double most;
};

namespace evidence {

// A beam in units of cells from the anchor, and whether its last cell is hit.
struct Ray {
    Point from, to;
    bool is_hit;
    bool is_used = true;
};

inline Ray make_ray(const EvidencePart& part, const EvidenceRule& rule, const LaserBeams& beams,
                    const LaserPose& laser, std::size_t beam, float measured) {
    const bool has_return = std::isfinite(measured) && measured < beams.most;
    const bool is_hit = has_return && measured > 0 && measured <= rule.max_range;
    const double range = is_hit ? measured : has_return ? rule.max_range : rule.clear_range;
    const double angle = laser.theta + beams.angles[beam];
    const Point from = (1 / part.resolution) * (Point{laser.x, laser.y} - part.anchor);
    const Point along{std::cos(angle), std::sin(angle)};
    const bool is_used = is_hit || ((!has_return || measured > 0) && range > 0);
    return {from, from + (range / part.resolution) * along, is_hit, is_used};
}

inline std::int64_t cell_of(double at) { return std::int64_t(std::floor(at)); }

// Calls visit(row, column) for the cells of a segment in order, the last one not.
template <class Visit>
void visit_cells(const Ray& ray, const Visit& visit) {
    std::int64_t row = cell_of(ray.from.y), column = cell_of(ray.from.x);
    const std::int64_t last_row = cell_of(ray.to.y), last_column = cell_of(ray.to.x);
    const Point along = ray.to - ray.from;
    const int up = last_row > row ? 1 : -1, right = last_column > column ? 1 : -1;
    constexpr double never = std::numeric_limits<double>::infinity();
    const auto next = [](std::int64_t cell, int step, std::int64_t last, double at, double slope) {
        return cell == last ? never : (double(cell + (step > 0)) - at) / slope;
    };
    double to_row = next(row, up, last_row, ray.from.y, along.y);
    double to_column = next(column, right, last_column, ray.from.x, along.x);
    while (row != last_row || column != last_column) {
        visit(row, column);
        if (to_column <= to_row && column != last_column)
            column += right, to_column = next(column, right, last_column, ray.from.x, along.x);
        else
            row += up, to_row = next(row, up, last_row, ray.from.y, along.y);
    }
}

}  // namespace evidence

// The cells that scans reach, as the lowest and the highest row and column; low above high for none.
struct CellRange {
    std::int64_t low_row = std::numeric_limits<std::int64_t>::max(), high_row = -low_row;
    std::int64_t low_column = low_row, high_column = -low_row;

    void include(Point p) {
        const std::int64_t row = evidence::cell_of(p.y), column = evidence::cell_of(p.x);
        low_row = std::min(low_row, row), high_row = std::max(high_row, row);
        low_column = std::min(low_column, column), high_column = std::max(high_column, column);
    }
};

inline CellRange reached_cells(const EvidencePart& part, const EvidenceRule& rule, const LaserBeams& beams,
                               std::span<const LaserPose> lasers, std::span<const float> ranges) {
    CellRange reached;
    InterruptPoll poll(8);
    for (std::size_t k = 0; k < lasers.size(); ++k) {
        poll.step();
        reached.include((1 / part.resolution) * (Point{lasers[k].x, lasers[k].y} - part.anchor));
        for (std::size_t b = 0; b < beams.angles.size(); ++b) {
            const evidence::Ray ray =
                evidence::make_ray(part, rule, beams, lasers[k], b, ranges[k * beams.angles.size() + b]);
            if (ray.is_used) reached.include(ray.to);
        }
    }
    return reached;
}

// Adds scans to sums of evidence, by row · columns + column. All that they reach lies in the part.
class EvidenceMarker {
  public:
    EvidenceMarker(const EvidencePart& part, const EvidenceRule& rule, std::int32_t* sums)
        : part_(part),
          rule_(rule),
          sums_(sums),
          stamps_(filled_vector<std::uint32_t>(std::size_t(part.rows) * std::size_t(part.columns))) {}

    void add(const LaserBeams& beams, const LaserPose& laser, std::span<const float> ranges) {
        next_stamp();
        rays_.clear();
        for (std::size_t b = 0; b < beams.angles.size(); ++b) {
            const evidence::Ray ray = evidence::make_ray(part_, rule_, beams, laser, b, ranges[b]);
            if (!ray.is_used) continue;
            rays_.push_back(ray);
            if (ray.is_hit) count(evidence::cell_of(ray.to.y), evidence::cell_of(ray.to.x), rule_.hit);
        }
        for (const evidence::Ray& ray : rays_) {
            evidence::visit_cells(
                ray, [&](std::int64_t row, std::int64_t column) { count(row, column, rule_.miss); });
            if (!ray.is_hit) count(evidence::cell_of(ray.to.y), evidence::cell_of(ray.to.x), rule_.miss);
        }
    }

  private:
    void next_stamp() {
        if (++stamp_ == 0) {
            std::fill(stamps_.begin(), stamps_.end(), 0);
            stamp_ = 1;
        }
    }
    void count(std::int64_t row, std::int64_t column, std::int32_t change) {
        const std::int64_t down = row - part_.low_row, along = column - part_.low_column;
        if (down < 0 || down >= part_.rows || along < 0 || along >= part_.columns) return;
        const std::size_t at = std::size_t(down) * std::size_t(part_.columns) + std::size_t(along);
        if (stamps_[at] == stamp_) return;
        stamps_[at] = stamp_;
        sums_[at] += change;
    }

    const EvidencePart part_;
    const EvidenceRule rule_;
    std::int32_t* sums_;
    std::vector<std::uint32_t> stamps_;  // of each cell: the last scan that counted it
    std::uint32_t stamp_ = 0;
    std::vector<evidence::Ray> rays_;
};

}  // namespace cspace::maps
