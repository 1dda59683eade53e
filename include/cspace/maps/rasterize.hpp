// Which cells of a raster obstacles reach into.
#pragma once

#include <span>

#include "cspace/maps/free_space.hpp"
#include "cspace/math/interrupts.hpp"

namespace cspace::maps {

namespace detail {

// Whether the open square meets the convex polygon: no line along a side of either divides them.
inline bool reaches_into(const Point* corner, int count, const Box& square) {
    const auto [low, high] = bounds_of(std::span(corner, std::size_t(count)));
    if (high.x <= square.low.x || low.x >= square.high.x || high.y <= square.low.y || low.y >= square.high.y)
        return false;
    for (int i = 0; i < count; ++i) {
        const auto [least, greatest] = sides_of(corner[i], corner[(i + 1) % count], square);
        if (greatest <= 0 || (count == 2 && least >= 0)) return false;
    }
    return true;
}

}  // namespace detail

// Marks in blocked (rows × columns, row by row from the lower left corner of the bounds, cells of a side)
// those that an obstacle reaches into by more than a slack [m], which is what rounding makes of corners, and
// those equally near to a wall without thickness: a wall between two cells blocks both.
inline void rasterize_obstacles(const FreeSpace& space, Point origin, double side, int rows, int columns,
                                double slack, std::uint8_t* blocked) {
    const Triangulation& mesh = space.mesh;
    InterruptPoll poll(256);
    const auto mark = [&](const Point* corner, int count) {
        const double inset = count == 2 ? -slack : slack;
        const auto [low, high] = bounds_of(std::span(corner, std::size_t(count)));
        const auto cell = [&](double offset, int count_of) {
            return int(std::clamp(std::floor(offset / side), -1.0, double(count_of)));
        };
        const int row_end = std::min(rows - 1, cell(high.y - origin.y, rows) + 1);
        const int column_end = std::min(columns - 1, cell(high.x - origin.x, columns) + 1);
        for (int row = std::max(0, cell(low.y - origin.y, rows) - 1); row <= row_end; ++row)
            for (int column = std::max(0, cell(low.x - origin.x, columns) - 1); column <= column_end;
                 ++column) {
                poll.step();
                std::uint8_t& cell_of =
                    blocked[std::size_t(row) * std::size_t(columns) + std::size_t(column)];
                if (cell_of) continue;
                const Point at = origin + Point{column * side + inset, row * side + inset};
                const double inner = side - 2 * inset;
                cell_of = detail::reaches_into(corner, count, {at, at + Point{inner, inner}});
            }
    };
    for (Index t = 0; t < Index(mesh.triangles.size()); ++t) {
        const Triangle& tri = mesh[t];
        const Point corner[3] = {mesh.point(tri.corner[0]), mesh.point(tri.corner[1]),
                                 mesh.point(tri.corner[2])};
        if (!space.is_free(t)) {
            mark(corner, 3);
            continue;
        }
        for (int e = 0; e < 3; ++e) {
            const Point wall[2] = {corner[next_corner(e)], corner[previous_corner(e)]};
            if (space.is_wall(t, e) && space.is_free(tri.across[std::size_t(e)])) mark(wall, 2);
        }
    }
}

}  // namespace cspace::maps
