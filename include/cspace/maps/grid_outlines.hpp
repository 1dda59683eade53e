// The outlines of the blocked cells of a grid, as edges between corners of cells: column and row are x and y.
#pragma once

#include <bit>
#include <cstdint>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/free_space.hpp"
#include "cspace/math/interrupts.hpp"

namespace cspace::maps {

// How many corners the outlines of a grid's blocked cells have, in time of its words.

// Points between four cells where an outline turns or two meet; the border is blocked.
inline std::int64_t count_corners(const BitGrid& grid) {
    std::int64_t count = 0;
    for (int row = 0; row <= grid.rows(); ++row) {
        const std::uint64_t *below = grid.row(row - 1), *above = grid.row(row);
        std::uint64_t before_below = 1, before_above = 1;  // left of the border all is blocked
        for (std::size_t k = 0; k < grid.row_words(); ++k) {
            const std::uint64_t b = below[k] << 1 | before_below, a = above[k] << 1 | before_above;
            const std::uint64_t turns_across = (b ^ below[k]) | (a ^ above[k]);
            const std::uint64_t turns_along = (b ^ a) | (below[k] ^ above[k]);
            std::uint64_t corners = turns_across & turns_along;
            const std::size_t columns = std::size_t(grid.columns()) + 2;  // behind the border nothing counts
            if (64 * (k + 1) > columns) corners &= ~std::uint64_t(0) >> (64 * (k + 1) - columns);
            count += std::popcount(corners);
            before_below = below[k] >> 63, before_above = above[k] >> 63;
        }
    }
    return count;
}

namespace detail {

// Visits the maximal edges between line k − 1 and line k of a grid: visit(k, begin, end). `differs(k, i)`
// says whether the cells on both sides of piece i differ, `crossed(k, i)` whether an edge across leaves from
// the point before piece i.
template <class Differs, class Crossed, class Visit>
void visit_edges(int lines, int length, Differs differs, Crossed crossed, Visit visit) {
    InterruptPoll poll(1 << 11);
    for (int k = 0; k <= lines; ++k)
        for (int i = 0; i < length;) {
            poll.step();
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
