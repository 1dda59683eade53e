// Jump point search: of all equally long ways only the one that turns off a diagonal as late as it can is
// looked at, so a search goes from one point where such a way may have to turn to the next (Harabor &
// Grastien 2011; with words of 64 cells at a time and without stops on diagonals: the same, "Improving jump
// point search", 2014). Of the ways by four moves it is the one that goes along columns first.
//
// Cells are reached in a direction; if several are equally short, the cell is expanded for all of them.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/navigation/grid/moves.hpp"
#include "cspace/navigation/grid/neighbour_pruning.hpp"
#include "cspace/navigation/grid/nodes.hpp"
#include "cspace/navigation/grid/order.hpp"

namespace cspace::navigation {

namespace jump {

// How far a scan goes: to a place where the way may have to turn, or, negative, to the last before a blocked
// one.
template <Corners rule>
int forward(const std::uint64_t* left, const std::uint64_t* line, const std::uint64_t* right, int from) {
    const unsigned at = unsigned(from + 1);
    std::size_t k = at >> 6;
    std::uint64_t after = (~std::uint64_t(0) << (at & 63)) << 1;
    for (;; ++k, after = ~std::uint64_t(0)) {
        const std::uint64_t blocked = line[k];
        std::uint64_t turn;
        if constexpr (turns_behind(rule)) {
            turn = ((left[k] << 1 | left[k - 1] >> 63) & ~left[k]) |
                   ((right[k] << 1 | right[k - 1] >> 63) & ~right[k]);
        } else {
            turn = (left[k] & ~(left[k] >> 1 | left[k + 1] << 63)) |
                   (right[k] & ~(right[k] >> 1 | right[k + 1] << 63));
            if constexpr (rule == Corners::one) turn &= ~(blocked >> 1 | line[k + 1] << 63);
        }
        const std::uint64_t stops = (blocked | turn) & after;
        if (!stops) continue;
        const int bit = std::countr_zero(stops), steps = int(64 * k) + bit - int(at);
        return blocked >> bit & 1 ? 1 - steps : steps;
    }
}
template <Corners rule>
int backward(const std::uint64_t* left, const std::uint64_t* line, const std::uint64_t* right, int from) {
    const unsigned at = unsigned(from + 1);
    std::size_t k = at >> 6;
    std::uint64_t before = ~((~std::uint64_t(0)) << (at & 63));
    for (;; --k, before = ~std::uint64_t(0)) {
        const std::uint64_t blocked = line[k];
        std::uint64_t turn;
        if constexpr (turns_behind(rule)) {
            turn = ((left[k] >> 1 | left[k + 1] << 63) & ~left[k]) |
                   ((right[k] >> 1 | right[k + 1] << 63) & ~right[k]);
        } else {
            turn = (left[k] & ~(left[k] << 1 | left[k - 1] >> 63)) |
                   (right[k] & ~(right[k] << 1 | right[k - 1] >> 63));
            if constexpr (rule == Corners::one) turn &= ~(blocked << 1 | line[k - 1] >> 63);
        }
        const std::uint64_t stops = (blocked | turn) & before;
        if (!stops) continue;
        const int bit = 63 - std::countl_zero(stops), steps = int(at) - int(64 * k) - bit;
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
                open |= onward_[std::size_t(std::countr_zero(come))][around];
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
    static constexpr const jump::OnwardTable& onward_ = jump::onward_of<rule>;

    // How far a straight scan from a cell goes, 0 where it leads nowhere; the goal is a place to stop.
    int stop(maps::Cell from, int d) const {
        int steps, ahead;
        if (d == 0 || d == 4) {
            const std::uint64_t *above = grid_.row(from.row + 1), *line = grid_.row(from.row),
                                *below = grid_.row(from.row - 1);
            steps = d == 0 ? jump::forward<rule>(above, line, below, from.column)
                           : jump::backward<rule>(above, line, below, from.column);
            if (goal_.row != from.row) return steps > 0 ? steps : 0;
            ahead = d == 0 ? goal_.column - from.column : from.column - goal_.column;
        } else {
            const std::uint64_t *left = grid_.column(from.column - 1), *line = grid_.column(from.column),
                                *right = grid_.column(from.column + 1);
            steps = d == 2 ? jump::forward<rule>(left, line, right, from.row)
                           : jump::backward<rule>(left, line, right, from.row);
            if (goal_.column != from.column) return steps > 0 ? steps : 0;
            ahead = d == 2 ? goal_.row - from.row : from.row - goal_.row;
        }
        if (ahead > 0 && ahead <= (steps > 0 ? steps : -steps)) return ahead;
        return steps > 0 ? steps : 0;
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
        const int sides[2] = {jump::side(rule, d, 0), jump::side(rule, d, 1)};
        const Steps step = rule == Corners::four ? Steps{1, 0} : Steps{0, 1};
        while (may_step(at, down, along)) {
            at = {at.row + down, at.column + along};
            g = g + step;
            if (at == goal_) return reach(place, at, g, d, queue);
            if constexpr (!jump::turns_behind(rule)) {
                const unsigned around = grid_.around(at.row, at.column);
                const unsigned natural = bit_of(d) | bit_of(d + 1) | bit_of(d + 7);
                if (onward_[std::size_t(d)][around] & ~natural) return reach(place, at, g, d, queue);
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
            if (!(onward_[std::size_t(d)][around] & ~unsigned(node.done))) return;
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
