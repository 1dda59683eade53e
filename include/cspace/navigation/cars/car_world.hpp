// What a vehicle covers of the plane, and whether that touches the blocked cells of a grid.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/grid_frame.hpp"
#include "cspace/navigation/curves/curve.hpp"

namespace cspace::navigation {

// A rectangle around a pose, grown by a radius: a disc has the radius alone, a car none.
struct Footprint {
    double rear, front;  // how far it reaches behind and before the pose [m]
    double half_width;   // [m]
    double radius;       // [m]

    // The farthest of its points from the pose.
    double reach() const { return std::hypot(std::max(rear, front), half_width) + radius; }
    // The largest disc that it contains has its centre so far before the pose.
    double middle() const { return 0.5 * (front - rear); }
    double inner_radius() const { return std::min(0.5 * (front + rear), half_width) + radius; }
};

// A grid whose outside is blocked. Touching is free; covering a part of a blocked cell is contact.
class CarWorld {
  public:
    CarWorld(const maps::BitGrid& grid, const maps::GridFrame& frame) : grid_(grid), frame_(frame) {}

    const maps::BitGrid& grid() const { return grid_; }
    const maps::GridFrame& frame() const { return frame_; }

    // Whether the footprint keeps a margin from everything blocked.
    bool is_clear(const Footprint& body, const CarPose& pose, double margin = 0) const {
        const Box box = box_of(body, pose, margin);
        const double slack = rounding * frame_.resolution;
        if (box.low.x < frame_.origin.x - slack || box.low.y < frame_.origin.y - slack ||
            box.high.x > frame_.origin.x + frame_.resolution * grid_.columns() + slack ||
            box.high.y > frame_.origin.y + frame_.resolution * grid_.rows() + slack)
            return false;
        const maps::Cell first = frame_.nearest_cell(grid_, box.low),
                         last = frame_.nearest_cell(grid_, box.high);
        for (int row = first.row; row <= last.row; ++row)
            if (!is_row_clear(box, body.radius + margin, row, first.column, last.column)) return false;
        return true;
    }

    // Whether the footprint stays clear on a way, all along: by halves, until what lies between two poses
    // that are clear is nearer to one of them than the margin that it keeps.
    bool is_way_clear(const Footprint& body, const CarPose& from, const Piece& piece, double radius) const {
        const double length = std::fabs(piece.length) * radius;
        const double motion = length + body.reach() * std::fabs(piece.turn * piece.length);
        if (!is_clear(body, from) || !is_clear(body, drive_piece(from, piece, radius))) return false;
        return halves_clear(body, from, piece, radius, 0, 1, motion);
    }

  private:
    static constexpr double rounding = 1e-9;  // of a cell: a touch that rounding makes
    static constexpr double closest = 1e-3;   // of a cell: poses so near to each other are one

    // The rectangle in the plane with the box around it.
    struct Box {
        Point center, along, low, high;
        double half_length, half_width;
    };

    static Box box_of(const Footprint& body, const CarPose& pose, double margin) {
        const Point along{std::cos(pose.theta), std::sin(pose.theta)};
        const Point center = Point{pose.x, pose.y} + body.middle() * along;
        const double half = 0.5 * (body.front + body.rear), grown = body.radius + margin;
        const double dx = std::fabs(along.x) * half + std::fabs(along.y) * body.half_width + grown;
        const double dy = std::fabs(along.y) * half + std::fabs(along.x) * body.half_width + grown;
        return {center, along,          {center.x - dx, center.y - dy}, {center.x + dx, center.y + dy},
                half,   body.half_width};
    }

    bool is_row_clear(const Box& box, double grown, int row, int first, int last) const {
        const std::uint64_t* words = grid_.row(row);
        for (int word = (first + 1) >> 6; word <= (last + 1) >> 6; ++word) {
            std::uint64_t bits = words[word];
            if (word == (first + 1) >> 6) bits &= ~std::uint64_t(0) << ((first + 1) & 63);
            if (word == (last + 1) >> 6) bits &= ~std::uint64_t(0) >> (63 - ((last + 1) & 63));
            for (; bits; bits &= bits - 1) {
                const int column = 64 * word + std::countr_zero(bits) - 1;
                if (touches(box, grown, frame_.center({row, column}))) return false;
            }
        }
        return true;
    }

    // Whether the grown rectangle covers a part of the cell around a point: axes that separate the two, else
    // the distance of their corners.
    bool touches(const Box& box, double grown, Point cell) const {
        const double half = 0.5 * frame_.resolution, slack = rounding * frame_.resolution;
        const Point way = cell - box.center;
        const double c = std::fabs(box.along.x), s = std::fabs(box.along.y), corner = half * (c + s);
        const double u = dot(way, box.along), v = cross(box.along, way);
        const double gap =
            std::max({std::fabs(u) - box.half_length - corner, std::fabs(v) - box.half_width - corner,
                      std::fabs(way.x) - half - c * box.half_length - s * box.half_width,
                      std::fabs(way.y) - half - s * box.half_length - c * box.half_width});
        if (gap >= grown - slack) return false;
        if (gap <= 0) return true;
        return distance_apart(box, cell, half) < grown - slack;
    }

    // Of two rectangles that do not overlap: from a corner of one to the other.
    static double distance_apart(const Box& box, Point cell, double half) {
        const auto outside = [](double x, double y, double a, double b) {
            return std::hypot(std::max(std::fabs(x) - a, 0.0), std::max(std::fabs(y) - b, 0.0));
        };
        double least = std::numeric_limits<double>::infinity();
        for (const double i : {-1.0, 1.0})
            for (const double j : {-1.0, 1.0}) {
                const Point of_cell = cell + Point{i * half, j * half} - box.center;
                const Point of_box = box.center + (i * box.half_length) * box.along +
                                     (j * box.half_width) * Point{-box.along.y, box.along.x} - cell;
                least = std::min({least,
                                  outside(dot(of_cell, box.along), cross(box.along, of_cell), box.half_length,
                                          box.half_width),
                                  outside(of_box.x, of_box.y, half, half)});
            }
        return least;
    }

    bool halves_clear(const Footprint& body, const CarPose& from, const Piece& piece, double radius, double a,
                      double b, double motion) const {
        const double middle = 0.5 * (a + b), moved = 0.5 * (b - a) * motion;
        const CarPose pose = drive_piece(from, {piece.turn, middle * piece.length}, radius);
        if (is_clear(body, pose, moved)) return true;
        if (!is_clear(body, pose)) return false;
        if (moved < closest * frame_.resolution) return true;
        return halves_clear(body, from, piece, radius, a, middle, motion) &&
               halves_clear(body, from, piece, radius, middle, b, motion);
    }

    const maps::BitGrid& grid_;
    maps::GridFrame frame_;
};

}  // namespace cspace::navigation
