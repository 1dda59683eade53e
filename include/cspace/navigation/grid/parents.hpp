// The parent rule of a search over a grid.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <type_traits>
#include <utility>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/navigation/grid/moves.hpp"
#include "cspace/navigation/grid/nodes.hpp"
#include "cspace/navigation/grid/order.hpp"

namespace cspace::navigation {

// Whether the centres of two cells see each other, decided in integers. A sight line touches blocked cells in
// corners at most, and passes a corner under the rule for diagonal steps.

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

// Whether the centres of place `at` of line k and of place `end` of line `last` see each other.
template <class LineOf>
bool is_open(const LineOf& line_of, Corners rule, int k, int at, int last, int end) {
    if (last < k) std::swap(k, last), std::swap(at, end);
    if (k == last) return is_clear(line_of(k), std::min(at, end), std::max(at, end));
    return crosses(line_of, rule, k, at, last - k, end - at);
}

}  // namespace sight

inline bool can_see(const maps::BitGrid& grid, Corners rule, maps::Cell a, maps::Cell b) {
    if (std::abs(b.row - a.row) <= std::abs(b.column - a.column))
        return sight::is_open([&](int k) { return grid.row(k); }, rule, a.row, a.column, b.row, b.column);
    return sight::is_open([&](int k) { return grid.column(k); }, rule, a.column, a.row, b.column, b.row);
}

// What a step costs, along a row or column and between them.
template <Steps straight, Steps diagonal>
struct StepBy {
    using G = Steps;
    G along(maps::Cell, int direction, unsigned) const {
        return is_diagonal(direction) ? diagonal : straight;
    }
};
using StepLength = StepBy<Steps{1, 0}, Steps{0, 1}>;  // exact
using StepCount = StepBy<Steps{1, 0}, Steps{1, 0}>;   // the number of a wave
using StepNothing = StepBy<Steps{}, Steps{}>;         // the first way to a cell stays
// The integral of the cost of the cells along the step: half of it lies in either cell. [cells · cost]
class StepCost {
  public:
    using G = double;
    // costs: by rows.
    StepCost(const double* costs, int columns) : costs_(costs), columns_(columns) {
        for (int d = 0; d < 8; ++d) offset_[d] = std::ptrdiff_t(row_step[d]) * columns + column_step[d];
    }
    // is_open: 1, or 0 where the step may lead out of the grid: then it counts for nothing.
    G along(maps::Cell from, int direction, unsigned is_open) const {
        constexpr double half[2] = {0.5, 0.5 * sqrt_two};
        const double* at = costs_ + std::ptrdiff_t(from.row) * columns_ + from.column;
        return (at[0] + at[-std::ptrdiff_t(is_open) & offset_[direction]]) * half[direction & 1];
    }

  private:
    const double* costs_;
    std::ptrdiff_t columns_, offset_[8];
};

template <class G>
struct Reach {
    G g;
    std::uint32_t parent;
};

// The cell it is reached from.
template <class Length>
struct StepParents {
    using G = typename Length::G;
    static constexpr bool is_neighbour = true;
    static constexpr bool is_length = std::is_same_v<Length, StepLength>;
    Length length;
    template <class Search>
    void settle(Search&, std::uint32_t) const {}
};

// The parent of the cell it is reached from, if they see each other: Theta* (Nash, Daniel, Koenig & Felner
// 2007).
struct SightParents {
    using G = double;
    static constexpr bool is_neighbour = false, is_length = false;
    Corners corners;
    template <class Search>
    Reach<G> way(Search& search, std::uint32_t number, double g, std::uint32_t parent, maps::Cell,
                 maps::Cell to, int direction) const {
        const maps::Cell before = search.cell(parent);
        if (can_see(search.grid(), corners, before, to))
            return {search.node(parent).g + straight_distance(to.row - before.row, to.column - before.column),
                    parent};
        return {g + (is_diagonal(direction) ? sqrt_two : 1.0), number};
    }
    template <class Search>
    void settle(Search&, std::uint32_t) const {}
};

// The same, with the sight line looked at when a cell is settled, not each time it is reached: Lazy Theta*
// (Nash, Koenig & Tovey 2010).
struct LazySightParents {
    using G = double;
    static constexpr bool is_neighbour = false, is_length = false;
    Corners corners;
    template <class Search>
    Reach<G> way(Search& search, std::uint32_t, double, std::uint32_t parent, maps::Cell, maps::Cell to,
                 int) const {
        const maps::Cell before = search.cell(parent);
        return {search.node(parent).g + straight_distance(to.row - before.row, to.column - before.column),
                parent};
    }
    // Where the parent is out of sight, the best of the settled neighbours.
    template <class Search>
    void settle(Search& search, std::uint32_t number) const {
        auto& node = search.node(number);
        const maps::Cell at = search.cell(number);
        if (node.parent == number || can_see(search.grid(), corners, search.cell(node.parent), at)) return;
        node.g = std::numeric_limits<double>::infinity();
        const auto& allowed = allowed_moves[std::size_t(corners)];
        for (unsigned open = allowed[search.grid().around(at.row, at.column)]; open; open &= open - 1) {
            const int d = std::countr_zero(open);
            const std::uint32_t beside =
                search.grid().number({at.row + row_step[d], at.column + column_step[d]});
            const auto& neighbour = search.node(beside);
            const double g = neighbour.g + (is_diagonal(d) ? sqrt_two : 1.0);
            if (beside == number || !search.nodes().is_settled(neighbour) || !(g < node.g)) continue;
            node.g = g;
            node.parent = beside;
        }
    }
};

}  // namespace cspace::navigation
