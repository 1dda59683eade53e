// A field of scores in which a scan fits best where its points lie on those of other scans: every point is
// stamped as exp(−d²/2σ²), and each cell keeps the greatest.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "cspace/localization/graph/planar_space.hpp"
#include "cspace/maps/byte_field.hpp"
#include "cspace/math/plane.hpp"

namespace cspace::localization {

inline constexpr int full_score = 255;

// The bell of one point, for several places of the point within its cell.
class PointStamp {
  public:
    // Throws std::invalid_argument for a bell that is wider than `widest` cells.
    PointStamp(double resolution, double sigma)
        : radius_(count_cells(sigma / resolution)), width_(pack * ((2 * radius_ + pack) / pack)) {
        bytes_.assign(std::size_t(parts * parts * (2 * radius_ + 1) * width_), 0);
        for (int part = 0; part < parts * parts; ++part) {
            const double x = (part % parts + 0.5) / parts - 0.5, y = (part / parts + 0.5) / parts - 0.5;
            for (int row = -radius_; row <= radius_; ++row) {
                for (int column = -radius_; column <= radius_; ++column) {
                    const double across = (column - x) * resolution, up = (row - y) * resolution;
                    const double bell = std::exp(-(across * across + up * up) / (2 * sigma * sigma));
                    bytes_[index(part, row + radius_) + std::size_t(column + radius_)] =
                        std::uint8_t(std::lround(full_score * bell));
                }
            }
        }
    }

    // Points whose stamp does not lie inside of the field whole are left out.
    void stamp_point(maps::ByteField& field, Point p) const {
        const double across = (p.x - field.frame.origin.x) / field.frame.resolution;
        const double up = (p.y - field.frame.origin.y) / field.frame.resolution;
        if (!(across >= radius_ && up >= radius_ && across < field.columns - radius_ &&
              up < field.rows - radius_))
            return;
        const int column = int(across), row = int(up);
        const int part = int(parts * (up - row)) * parts + int(parts * (across - column));
        const int left = column - radius_, columns = 2 * radius_ + 1;
        const bool is_inside = left + width_ <= field.columns;
        std::uint8_t* to =
            field.scores.data() + std::size_t(row - radius_) * std::size_t(field.columns) + std::size_t(left);
        const std::uint8_t* from = bytes_.data() + index(part, 0);
        for (int k = 0; k < columns; ++k, to += field.columns, from += width_) {
            if (is_inside) {
                for (int at = 0; at < width_; at += pack) raise_pack(to + at, from + at);
            } else {
                for (int at = 0; at < columns; ++at) to[at] = std::max(to[at], from[at]);
            }
        }
    }

    int radius() const { return radius_; }

    static constexpr double widest = 100;  // σ of a bell [cells]: its stamps take 16 MB

  private:
    static constexpr double reach = 2.5;  // of a stamp [σ]: beyond it a score is below 4 %
    static constexpr int parts = 8;       // of a cell's side, for the place of the point in it
    static constexpr int pack = 16;

    static int count_cells(double cells) {
        if (!(cells > 0 && cells <= widest)) throw std::invalid_argument("the bell of a point is too wide");
        return int(std::ceil(reach * cells));
    }
    static void raise_pack(std::uint8_t* to, const std::uint8_t* from) {
        for (int k = 0; k < pack; ++k) to[k] = std::max(to[k], from[k]);
    }
    std::size_t index(int part, int row) const {
        return std::size_t((part * (2 * radius_ + 1) + row) * width_);
    }

    int radius_, width_;
    std::vector<std::uint8_t> bytes_;
};

// A field of zeros that covers a box.
inline void clear_field(maps::ByteField& field, const Box& box, double resolution) {
    constexpr double most_cells = 1 << 28;
    field.frame.resolution = resolution, field.frame.origin = box.low;
    const double columns = std::ceil((box.high.x - box.low.x) / resolution);
    const double rows = std::ceil((box.high.y - box.low.y) / resolution);
    if (!(rows * columns < most_cells)) throw std::length_error("the field has too many cells");
    field.columns = std::max(1, int(columns)), field.rows = std::max(1, int(rows));
    field.outside = 0;
    field.scores.assign(std::size_t(field.rows) * std::size_t(field.columns), 0);
}

// Places of points of base, in map.
inline Point place_point(const PlanarSpace::Pose& pose, Point p) {
    return {pose.x + pose.c * p.x - pose.s * p.y, pose.y + pose.s * p.x + pose.c * p.y};
}

// A field of points in its own frame, with a margin about them.
inline maps::ByteField make_point_field(std::span<const Point> points, double resolution, double sigma) {
    const PointStamp stamp(resolution, sigma);
    const double margin = (stamp.radius() + 1) * resolution;
    Box box = points.empty() ? Box{} : bounds_of(points);
    // Corners at multiples of the resolution: fields of turned points are turned fields.
    box.low = {resolution * std::floor((box.low.x - margin) / resolution),
               resolution * std::floor((box.low.y - margin) / resolution)};
    box.high = {resolution * std::ceil((box.high.x + margin) / resolution),
                resolution * std::ceil((box.high.y + margin) / resolution)};
    maps::ByteField field;
    clear_field(field, box, resolution);
    for (const Point p : points) stamp.stamp_point(field, p);
    return field;
}

}  // namespace cspace::localization
