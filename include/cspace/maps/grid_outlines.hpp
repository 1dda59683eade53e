// The outlines of the blocked cells of a grid, as edges between corners of cells: column and row are x and y.
#pragma once

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/free_space.hpp"

namespace cspace::maps {

namespace detail {

// Visits the maximal edges between line k − 1 and line k of a grid: visit(k, begin, end). `differs(k, i)`
// says whether the cells on both sides of piece i differ, `crossed(k, i)` whether an edge across leaves from
// the point before piece i.
template <class Differs, class Crossed, class Visit>
void visit_edges(int lines, int length, Differs differs, Crossed crossed, Visit visit) {
    for (int k = 0; k <= lines; ++k)
        for (int i = 0; i < length;) {
            if (!differs(k, i)) {
                ++i;
                continue;
            }
            const int begin = i++;
            while (i < length && differs(k, i) && !crossed(k, i)) ++i;
            visit(k, begin, i);
        }
}

}  // namespace detail

inline Outlines outlines_of(const BitGrid& grid) {
    Outlines world;
    const int rows = grid.rows(), columns = grid.columns();
    world.high = {double(columns), double(rows)};
    world.obstacles = 1;
    const auto blocked = [&](int row, int column) {  // beyond the border nothing is
        return grid.contains({row, column}) && grid.blocked(row, column);
    };
    const auto add = [&](Point a, Point b) {
        world.edges.push_back({Index(world.points.size()), Index(world.points.size() + 1), 0});
        world.points.push_back(a);
        world.points.push_back(b);
    };
    const auto below = [&](int row, int column) { return blocked(row - 1, column) != blocked(row, column); };
    const auto before = [&](int row, int column) { return blocked(row, column - 1) != blocked(row, column); };
    detail::visit_edges(
        rows, columns, below, [&](int k, int i) { return before(k - 1, i) || before(k, i); },
        [&](int k, int begin, int end) { add({double(begin), double(k)}, {double(end), double(k)}); });
    detail::visit_edges(
        columns, rows, [&](int k, int i) { return before(i, k); },
        [&](int k, int i) { return below(i, k - 1) || below(i, k); },
        [&](int k, int begin, int end) { add({double(k), double(begin)}, {double(k), double(end)}); });
    return world;
}

}  // namespace cspace::maps
