// Whether the centres of two cells see each other, decided in integers. A sight line touches blocked cells in
// corners at most, and passes a corner under the rule for diagonal steps.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/navigation/grid/moves.hpp"

namespace cspace::navigation {

namespace sight {

// Whether the bits of the places first … last of a line are clear.
inline bool is_clear(const std::uint64_t* line, int first, int last) {
    const unsigned from = unsigned(first + 1), to = unsigned(last + 1);
    const std::uint64_t head = ~std::uint64_t(0) << (from & 63), tail = ~std::uint64_t(0) >> (63 - (to & 63));
    std::size_t k = from >> 6;
    const std::size_t end = to >> 6;
    if (k == end) return !(line[k] & head & tail);
    if (line[k] & head) return false;
    for (++k; k < end; ++k)
        if (line[k]) return false;
    return !(line[end] & tail);
}
inline bool is_blocked(const std::uint64_t* line, int at) {
    return line[(at + 1) >> 6] >> ((at + 1) & 63) & 1;
}

// The line from the centre of place `at` in line k to that of place at + along in line k + down, down > 0;
// line_of(k) gives the bits of line k. It crosses the border between lines k + i - 1 and k + i where it has
// made along · (2 i - 1) / (2 down) of its way, in cells.
template <class LineOf>
bool crosses(const LineOf& line_of, Corners rule, int k, int at, int down, int along) {
    const std::int64_t width = 2 * std::int64_t(down);  // of a cell, times down
    const int forward = along >= 0 ? 1 : -1;
    // Counted from the near side of the first cell, growing along the line even where it goes back.
    const std::int64_t step = std::abs(std::int64_t(along));
    const auto place = [&](std::int64_t cells) { return forward > 0 ? at + int(cells) : at - int(cells); };
    std::int64_t entered = 0;
    bool through_corner = false;
    for (int i = 1; i <= down + 1; ++i) {
        const std::uint64_t* line = line_of(k + i - 1);
        std::int64_t leaves = step, corner = 0;
        if (i <= down) {
            const std::int64_t crossing = down + step * (2 * std::int64_t(i) - 1);
            leaves = crossing / width;
            corner = crossing % width == 0;
        }
        // At a corner the line leaves from the cell before it; a rule that asks for both sides looks at one
        // more.
        const bool wide = rule == Corners::never || rule == Corners::four;
        const std::int64_t first = entered - (through_corner && wide), last = leaves - (corner && !wide);
        const int a = place(first), b = place(last);
        if (!is_clear(line, a < b ? a : b, a < b ? b : a)) return false;
        if (corner && rule == Corners::one && is_blocked(line, place(leaves)) &&
            is_blocked(line_of(k + i), place(leaves - 1)))
            return false;
        entered = leaves;
        through_corner = corner;
    }
    return true;
}

}  // namespace sight

inline bool sees(const maps::BitGrid& grid, Corners rule, maps::Cell a, maps::Cell b) {
    const bool by_rows = std::abs(b.row - a.row) <= std::abs(b.column - a.column);
    if (by_rows) {
        if (b.row < a.row) std::swap(a, b);
        const auto line = [&](int k) { return grid.row(k); };
        if (a.row == b.row)
            return sight::is_clear(line(a.row), std::min(a.column, b.column), std::max(a.column, b.column));
        return sight::crosses(line, rule, a.row, a.column, b.row - a.row, b.column - a.column);
    }
    if (b.column < a.column) std::swap(a, b);
    const auto line = [&](int k) { return grid.column(k); };
    if (a.column == b.column)
        return sight::is_clear(line(a.column), std::min(a.row, b.row), std::max(a.row, b.row));
    return sight::crosses(line, rule, a.column, a.row, b.column - a.column, b.row - a.row);
}

}  // namespace cspace::navigation
