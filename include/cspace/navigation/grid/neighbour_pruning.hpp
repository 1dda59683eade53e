// Where a shortest way over cells may go on that has come in one direction: of all ways that are equally long
// around a cell, one is enough. It turns off a diagonal as late as it can (Harabor & Grastien 2011); of the
// ways by four moves it goes along columns first.
//
// A straight step is left out only where a shorter way goes round the cell, a diagonal one also where one as
// long ends in a straight step. So of the best ways to any cell one has a last step that is kept, from
// whichever cell each of its cells was reached first: a search from cell to neighbouring cell may leave out
// the others for all of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cspace/navigation/grid/moves.hpp"

namespace cspace::navigation {

namespace jump {

// Whether straight steps turn into others only beside a corner that was passed, as they do where no diagonal
// step cuts it; else they turn diagonally in front of one.
constexpr bool turns_behind(Corners rule) { return rule == Corners::never || rule == Corners::four; }
// The directions that scan others at every step: the diagonal ones, or along columns where there are none.
constexpr bool is_leading(Corners rule, int d) {
    return rule == Corners::four ? d == 2 || d == 6 : is_diagonal(d);
}
// The two straight directions that a leading one scans.
constexpr int side_direction(Corners rule, int d, int which) {
    const int turn = rule == Corners::four ? 2 : 1;
    return (d + (which ? turn : 8 - turn)) & 7;
}

// The directions in which a way goes on that has come in direction d, a bit each.
constexpr unsigned keep_moves(Corners rule, unsigned around, int d) {
    unsigned open = bit_of(d);
    if (is_leading(rule, d)) open |= bit_of(side_direction(rule, d, 0)) | bit_of(side_direction(rule, d, 1));
    for (int turn : {1, -1}) {
        if (is_diagonal(d)) {
            if (moves::is_neighbour_blocked(around, d + 3 * turn)) open |= bit_of(d + 2 * turn);
        } else if (turns_behind(rule)) {
            if (moves::is_neighbour_blocked(around, d + 3 * turn))
                open |= bit_of(d + 2 * turn) | (rule == Corners::never ? bit_of(d + turn) : 0u);
        } else if (moves::is_neighbour_blocked(around, d + 2 * turn)) {
            open |= bit_of(d + turn);
        }
    }
    if (rule == Corners::never && is_diagonal(d)) open &= bit_of(d) | bit_of(d + 1) | bit_of(d - 1);
    return open & allowed_moves[std::size_t(rule)][around];
}

using PruningTable = std::array<std::array<std::uint8_t, 512>, 8>;
constexpr PruningTable make_pruning_table(Corners rule) {
    PruningTable table{};
    for (int d = 0; d < 8; ++d)
        for (unsigned around = 0; around < 512; ++around)
            table[std::size_t(d)][around] = std::uint8_t(keep_moves(rule, around, d));
    return table;
}

// A constant for each rule, because compilers bound the work that one constant may take.
template <Corners rule>
inline constexpr PruningTable pruning_of = make_pruning_table(rule);

}  // namespace jump

using jump::PruningTable;

// By rule, direction of arrival and pattern of the cells around.
inline constexpr std::array<const PruningTable*, corner_rules> pruned_moves = {
    &jump::pruning_of<Corners::never>, &jump::pruning_of<Corners::one>, &jump::pruning_of<Corners::always>,
    &jump::pruning_of<Corners::four>};

}  // namespace cspace::navigation
