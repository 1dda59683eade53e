// The parent rule of a search over a grid.
#pragma once

#include <bit>
#include <limits>
#include <type_traits>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/navigation/grid/line_of_sight.hpp"
#include "cspace/navigation/grid/moves.hpp"
#include "cspace/navigation/grid/nodes.hpp"
#include "cspace/navigation/grid/order.hpp"

namespace cspace::navigation {

// What a step costs: its length, exact.
struct StepLength {
    using G = Steps;
    G step(maps::Cell, maps::Cell, int direction) const {
        return is_diagonal(direction) ? Steps{0, 1} : Steps{1, 0};
    }
    G along(maps::Cell, int direction, unsigned) const { return step({}, {}, direction); }
};
// Every step counts alike: the number of a wave.
struct StepCount {
    using G = Steps;
    G step(maps::Cell, maps::Cell, int) const { return {1, 0}; }
    G along(maps::Cell, int, unsigned) const { return {1, 0}; }
};
// The integral of the cost of the cells along the step: half of it lies in either cell. [cells · cost]
class StepCost {
  public:
    using G = double;
    // costs: by rows.
    StepCost(const double* costs, int columns) : costs_(costs), columns_(columns) {
        for (int d = 0; d < 8; ++d) offset_[d] = std::ptrdiff_t(row_step[d]) * columns + column_step[d];
    }
    G step(maps::Cell from, maps::Cell, int direction) const { return along(from, direction, 1); }
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
    Reach<G> way(Search&, std::uint32_t number, const G& g, std::uint32_t, maps::Cell from, maps::Cell to,
                 int direction) const {
        return {g + length.step(from, to, direction), number};
    }
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
        if (sees(search.grid(), corners, before, to))
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
        if (node.parent == number || sees(search.grid(), corners, search.cell(node.parent), at)) return;
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
