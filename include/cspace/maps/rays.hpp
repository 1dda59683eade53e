// Rays on a grid: how far one goes from a point until it enters a blocked cell (Amanatides & Woo 1987, with
// every border computed from its number, so that no rounding adds up).
//
// A ray along the border of two cells is stopped where both are blocked; one through a corner where the cell
// behind it is, or both next to it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/grid_frame.hpp"

namespace cspace::maps {

namespace rays {

// One axis of a ray in units of cells: the cell it is in, and when it comes to the next border.
struct Axis {
    double at, slope;
    int cell, beside;  // beside: the other cell, where the ray runs along a border or begins on one
    int step;

    Axis(double at, double slope) : at(at), slope(slope), cell(int(std::floor(at))), beside(cell) {
        step = slope > 0 ? 1 : slope < 0 ? -1 : 0;
        if (at == std::floor(at)) {
            if (step < 0) --cell, beside = cell;
            if (step == 0) beside = cell - 1;
        }
    }
    double next() const {
        if (step == 0) return std::numeric_limits<double>::infinity();
        return (cell + (step > 0 ? 1 : 0) - at) / slope;
    }
    void go() { cell += step, beside = cell; }
};

}  // namespace rays

// The distance [m] to the first blocked cell from a point in the grid, in the direction of a unit vector;
// `most` where it is farther. From inside a blocked cell it is 0. The outside is blocked.
inline double cast_ray(const BitGrid& grid, const GridFrame& frame, Point from, Point direction,
                       double most) {
    rays::Axis x((from.x - frame.origin.x) / frame.resolution, direction.x);
    rays::Axis y((from.y - frame.origin.y) / frame.resolution, direction.y);
    const double limit = most / frame.resolution;
    const auto in_sight = [&](int row, int column) {
        return row >= -1 && row <= grid.rows() && column >= -1 && column <= grid.columns();
    };
    const auto stopped = [&] {
        for (const int row : {y.cell, y.beside})
            for (const int column : {x.cell, x.beside})
                if (in_sight(row, column) && !grid.blocked(row, column)) return false;
        return true;
    };
    if (stopped()) return 0;
    for (;;) {
        const double tx = x.next(), ty = y.next(), t = std::min(tx, ty);
        if (!(t < limit)) return most;
        if (tx == ty) {
            const bool pinched =
                grid.blocked(y.cell + y.step, x.cell) && grid.blocked(y.cell, x.cell + x.step);
            x.go(), y.go();
            if (pinched) return frame.resolution * t;
        } else if (tx < ty) {
            x.go();
        } else {
            y.go();
        }
        if (stopped()) return frame.resolution * t;
    }
}

}  // namespace cspace::maps
