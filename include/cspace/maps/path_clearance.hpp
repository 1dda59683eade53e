// The clearance of a polyline, exact up to rounding: the least distance between one of its pieces and
// a wall, or the square of a blocked cell.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "cspace/maps/boundary.hpp"
#include "cspace/maps/grid_frame.hpp"
#include "cspace/math/crossing.hpp"
#include "cspace/math/interrupts.hpp"

namespace cspace::maps {

inline double distance_to(const Box& box, const Box& other) {
    return std::hypot(std::max({0.0, other.low.x - box.high.x, box.low.x - other.high.x}),
                      std::max({0.0, other.low.y - box.high.y, box.low.y - other.high.y}));
}

inline Box box_of(Line s) { return bounds_of(std::array{s.from, s.to}); }

inline double distance_to(Point p, Line s) { return distance(p, nearest_on(s.from, s.to, p)); }

inline double distance_to(Line s, Line wall) {
    if (do_cross(s, wall)) return 0;
    return std::min({distance_to(s.from, wall), distance_to(s.to, wall), distance_to(wall.from, s),
                     distance_to(wall.to, s)});
}

// Between a piece and the square of the cell in the given row and column, in cells.
inline double distance_to_cell(Line s, int row, int column) {
    const Point corner[4] = {{double(column), double(row)},
                             {double(column + 1), double(row)},
                             {double(column + 1), double(row + 1)},
                             {double(column), double(row + 1)}};
    if (s.from.x > corner[0].x && s.from.x < corner[2].x && s.from.y > corner[0].y && s.from.y < corner[2].y)
        return 0;
    double best = distance_to(s, {corner[3], corner[0]});
    for (int k = 0; k < 3; ++k) best = std::min(best, distance_to(s, {corner[k], corner[k + 1]}));
    return best;
}

// The pieces of a path; of a single point one without length.
inline std::vector<Line> pieces_of(std::span<const Point> path) {
    std::vector<Line> pieces;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) pieces.push_back({path[i], path[i + 1]});
    if (path.size() == 1) pieces.push_back({path[0], path[0]});
    return pieces;
}

// The least distance [m] from a path to walls; infinite where there is no path. Walls that follow each
// other lie in one box, which is looked into only if it is nearer than the nearest wall so far.
inline double path_clearance(std::span<const Point> path, const Boundary& walls) {
    constexpr std::size_t together = 32;
    struct Group {
        Box box;
        std::vector<Line> walls;
    };
    std::vector<Group> groups;
    for (std::size_t e = 0; e < walls.size(); ++e) {
        const Line wall{walls.begin(std::int32_t(e)), walls.end(std::int32_t(e))};
        if (groups.empty() || groups.back().walls.size() == together) groups.push_back({box_of(wall), {}});
        for (const Point p : {wall.from, wall.to}) groups.back().box.include(p);
        groups.back().walls.push_back(wall);
    }
    double best = std::numeric_limits<double>::infinity();
    for (const Line s : pieces_of(path)) {
        const Box around = box_of(s);
        poll_interrupts();
        for (const Group& group : groups) {
            if (!(distance_to(group.box, around) < best)) continue;
            for (const Line wall : group.walls)
                if (distance_to(box_of(wall), around) < best) best = std::min(best, distance_to(s, wall));
        }
    }
    return best;
}

// The search for the nearest blocked cell, in cells.
class NearestCell {
  public:
    explicit NearestCell(const BitGrid& grid) : grid_(grid) {}
    double best = std::numeric_limits<double>::infinity();

    // Tests the blocked cells within `far` of a piece; all cells outside the grid are blocked.
    void look(Line s, double far) {
        const Box around = box_of(s);
        for (const Point p : {around.low, around.high})
            best = std::min(best, std::max(0.0, std::min({p.x, p.y, double(grid_.columns()) - p.x,
                                                          double(grid_.rows()) - p.y})));
        const int left = cell(around.low.x - far, grid_.columns());
        const int right = cell(around.high.x + far, grid_.columns());
        const int bottom = cell(around.low.y - far, grid_.rows());
        const int top = cell(around.high.y + far, grid_.rows());
        for (int row = bottom; row <= top; ++row) {
            const std::uint64_t* words = grid_.row(row);
            for (int word = (left + 1) / 64; word <= (right + 1) / 64; ++word)
                for (std::uint64_t bits = words[word]; bits; bits &= bits - 1) {
                    const int column = 64 * word + std::countr_zero(bits) - 1;
                    if (column >= left && column <= right) weigh(s, around, row, column);
                }
        }
    }

  private:
    void weigh(Line s, const Box& around, int row, int column) {
        const Box square{{double(column), double(row)}, {double(column + 1), double(row + 1)}};
        if (distance_to(square, around) < best) best = std::min(best, distance_to_cell(s, row, column));
    }
    static int cell(double at, int count) { return int(std::clamp(std::floor(at), 0.0, double(count - 1))); }

    const BitGrid& grid_;
};

// The least distance [m] from a path to blocked cells, or to the border of the grid; infinite where there
// is no path. Rings around its first point, each twice as wide, find a first cell; pieces as long as the
// distance so far bound where nearer ones can be.
inline double path_clearance(std::span<const Point> path, const BitGrid& grid, const GridFrame& frame) {
    NearestCell nearest(grid);
    std::vector<Line> pieces = pieces_of(path);
    const auto in_cells = [&](Point p) { return (1 / frame.resolution) * (p - frame.origin); };
    for (Line& s : pieces) s = {in_cells(s.from), in_cells(s.to)};
    if (pieces.empty()) return nearest.best;
    const Line first{pieces[0].from, pieces[0].from};
    for (double far = 1; far < nearest.best; far *= 2) nearest.look(first, far);
    for (const Line s : pieces) {
        poll_interrupts();
        const double length = distance(s.from, s.to);
        const int count = int(std::ceil(length / std::max(nearest.best, 4.0)));
        for (int k = 0; k < std::max(count, 1); ++k) {
            const auto at = [&](int i) {
                return i == count ? s.to : s.from + double(i) / std::max(count, 1) * (s.to - s.from);
            };
            nearest.look({at(k), at(k + 1)}, nearest.best);
        }
    }
    return frame.resolution * nearest.best;
}

}  // namespace cspace::maps
