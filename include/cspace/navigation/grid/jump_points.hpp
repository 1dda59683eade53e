// Jump point search: of all equally long ways only the one that turns off a diagonal as late as it can is
// looked at, so a search goes from one point where such a way may have to turn to the next (Harabor &
// Grastien 2011; with words of 64 cells at a time and without stops on diagonals: the same, "Improving jump
// point search", 2014). Of the ways by four moves it is the one that goes along columns first.
//
// Cells are reached in a direction; if several are equally short, the cell is expanded for all of them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/navigation/grid/moves.hpp"
#include "cspace/navigation/grid/neighbour_pruning.hpp"
#include "cspace/navigation/grid/nodes.hpp"
#include "cspace/navigation/grid/order.hpp"

namespace cspace::navigation {

namespace jump {

// Word k of a line, each bit that of the place ahead of it, in a scan up the line or down.
template <bool up>
std::uint64_t look_ahead(const std::uint64_t* line, std::size_t k) {
    return up ? line[k] >> 1 | line[k + 1] << 63 : line[k] << 1 | line[k - 1] >> 63;
}

// How far a scan goes: to a place where the way may have to turn, or, negative, to the last before a blocked
// one.
template <Corners rule, bool up>
int scan_line(const std::uint64_t* left, const std::uint64_t* line, const std::uint64_t* right, int from) {
    const unsigned at = unsigned(from + 1);
    const std::uint64_t above = ~std::uint64_t(0) << (at & 63);
    std::uint64_t beyond = up ? above << 1 : ~above;
    for (std::size_t k = at >> 6;; up ? ++k : --k, beyond = ~std::uint64_t(0)) {
        const std::uint64_t blocked = line[k];
        std::uint64_t turn;
        if constexpr (turns_behind(rule)) {
            turn = (look_ahead<!up>(left, k) & ~left[k]) | (look_ahead<!up>(right, k) & ~right[k]);
        } else {
            turn = (left[k] & ~look_ahead<up>(left, k)) | (right[k] & ~look_ahead<up>(right, k));
            if constexpr (rule == Corners::one) turn &= ~look_ahead<up>(line, k);
        }
        const std::uint64_t stops = (blocked | turn) & beyond;
        if (!stops) continue;
        const int bit = up ? std::countr_zero(stops) : 63 - std::countl_zero(stops);
        const int away = int(64 * k) + bit - int(at), steps = up ? away : -away;
        return blocked >> bit & 1 ? 1 - steps : steps;
    }
}

}  // namespace jump

template <Corners rule>
class JumpPoints {
  public:
    JumpPoints(const maps::BitGrid& grid, const Order& order, SparseNodes& nodes)
        : grid_(grid),
          order_(order),
          goal_(order.goal),
          goal_number_(grid.number(order.goal)),
          nodes_(nodes) {
        nodes_.begin();
    }
    template <class Queue>
    void start(maps::Cell at, Queue& queue, search::Effort& effort) {
        effort_ = &effort;
        bool is_new;
        const std::uint32_t place = nodes_.find(grid_.number(at), is_new);
        nodes_[place].pending = 0xff;
        queue.push(order_.rank(Steps{}, at, place));
        ++effort.pushed;
    }

    bool settle(std::uint32_t place) const { return nodes_[place].pending != 0; }
    bool is_goal(std::uint32_t place) const { return nodes_[place].cell == goal_number_; }
    template <class Queue>
    void expand(std::uint32_t place, Queue& queue) {
        auto& node = nodes_[place];
        const maps::Cell from = grid_.cell(node.cell);
        const Steps g = node.g;
        const unsigned around = grid_.around(from.row, from.column);
        unsigned open = 0;
        if (node.pending == 0xff) {
            open = allowed_moves[std::size_t(rule)][around];
        } else {
            for (unsigned come = node.pending; come; come &= come - 1)
                open |= pruning_[std::size_t(std::countr_zero(come))][around];
        }
        open &= ~unsigned(node.done);
        node.done = std::uint8_t(node.done | open);
        node.pending = 0;
        for (; open; open &= open - 1) {
            const int d = std::countr_zero(open);
            if (jump::is_leading(rule, d))
                lead(place, from, g, d, queue);
            else
                scan(place, from, g, d, queue);
        }
    }

  private:
    static constexpr const jump::PruningTable& pruning_ = jump::pruning_of<rule>;

    // How far a straight scan from a cell goes, 0 where it leads nowhere; the goal is a place to stop.
    int stop(maps::Cell from, int d) const {
        return d == 0 || d == 4 ? stop_along<true>(from, d == 0) : stop_along<false>(from, d == 2);
    }
    template <bool by_rows>
    int stop_along(maps::Cell from, bool is_up) const {
        const int line = by_rows ? from.row : from.column, at = by_rows ? from.column : from.row;
        const int goal_line = by_rows ? goal_.row : goal_.column, goal = by_rows ? goal_.column : goal_.row;
        const auto words = [&](int k) { return by_rows ? grid_.row(k) : grid_.column(k); };
        const std::uint64_t *below = words(line - 1), *middle = words(line), *above = words(line + 1);
        const int steps = is_up ? jump::scan_line<rule, true>(below, middle, above, at)
                                : jump::scan_line<rule, false>(below, middle, above, at);
        const int ahead = is_up ? goal - at : at - goal;
        if (goal_line == line && ahead > 0 && ahead <= std::abs(steps)) return ahead;
        return std::max(steps, 0);
    }

    template <class Queue>
    void scan(std::uint32_t place, maps::Cell from, Steps g, int d, Queue& queue) {
        const int steps = stop(from, d);
        if (steps == 0) return;
        const maps::Cell to = {from.row + steps * row_step[d], from.column + steps * column_step[d]};
        reach(place, to, g + Steps{steps, 0}, d, queue);
    }

    // Along a leading direction, step by step, with a scan to either side after each.
    template <class Queue>
    void lead(std::uint32_t place, maps::Cell at, Steps g, int d, Queue& queue) {
        const int down = row_step[d], along = column_step[d];
        const int sides[2] = {jump::side_direction(rule, d, 0), jump::side_direction(rule, d, 1)};
        const Steps step = rule == Corners::four ? Steps{1, 0} : Steps{0, 1};
        while (may_step(at, down, along)) {
            at = {at.row + down, at.column + along};
            g = g + step;
            if (at == goal_) return reach(place, at, g, d, queue);
            if constexpr (!jump::turns_behind(rule)) {
                const unsigned around = grid_.around(at.row, at.column);
                const unsigned natural = bit_of(d) | bit_of(d + 1) | bit_of(d + 7);
                if (pruning_[std::size_t(d)][around] & ~natural) return reach(place, at, g, d, queue);
            }
            for (int aside : sides) scan(place, at, g, aside, queue);
        }
    }
    bool may_step(maps::Cell at, int down, int along) const {
        if (grid_.blocked(at.row + down, at.column + along)) return false;
        if constexpr (rule == Corners::never)
            return !grid_.blocked(at.row, at.column + along) && !grid_.blocked(at.row + down, at.column);
        if constexpr (rule == Corners::one)
            return !grid_.blocked(at.row, at.column + along) || !grid_.blocked(at.row + down, at.column);
        return true;
    }

    template <class Queue>
    void reach(std::uint32_t from, maps::Cell to, Steps g, int d, Queue& queue) {
        bool is_new;
        const std::uint32_t place = nodes_.find(grid_.number(to), is_new);
        auto& node = nodes_[place];
        if (is_new || g < node.g) {
            node.g = g;
            node.parent = from;
            node.pending = std::uint8_t(bit_of(d));
            node.done = 0;
        } else if (g == node.g) {
            if (node.pending) {  // it is open already
                node.pending = std::uint8_t(node.pending | bit_of(d));
                return;
            }
            const unsigned around = grid_.around(to.row, to.column);
            if (!(pruning_[std::size_t(d)][around] & ~unsigned(node.done))) return;
            node.pending = std::uint8_t(bit_of(d));
        } else {
            return;
        }
        queue.push(order_.rank(g, to, place));
        ++effort_->pushed;
    }

    const maps::BitGrid& grid_;
    const Order& order_;
    maps::Cell goal_;
    std::uint32_t goal_number_;
    SparseNodes& nodes_;
    search::Effort* effort_ = nullptr;
};

}  // namespace cspace::navigation
