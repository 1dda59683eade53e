// D* Lite (Koenig & Likhachev 2002, optimised version): the shortest way from where the robot is to the goal,
// mended when cells become blocked or free. The search runs from the goal, so that what it has found stays
// true while the robot moves; each cell knows g, its way to the goal as last settled, and rhs, that by its
// best neighbour.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/grid/moves.hpp"
#include "cspace/navigation/grid/nodes.hpp"
#include "cspace/navigation/grid/order.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

class DStarLite {
  public:
    // start and goal lie within the grid; blocked or not.
    DStarLite(const maps::BitGrid& grid, Corners corners, maps::Cell start, maps::Cell goal)
        : grid_(grid), corners_(corners), start_(start), goal_(goal) {
        Node& last = at(grid_.number(goal));
        last.rhs = {{0, 0}};
        wait(goal, last);
    }

    const maps::BitGrid& grid() const { return grid_; }
    // The robot has moved. The keys of open nodes were computed for its old position and are too large by at
    // most the distance moved; keys from now on are increased by that distance.
    void move(maps::Cell start) {
        travelled_ = travelled_ + left(start_, start);
        start_ = start;
    }
    // A cell becomes blocked or free: its moves and those past it change.
    void set(maps::Cell cell, bool blocked) {
        if (grid_.blocked(cell) == blocked) return;
        grid_.set(cell.row, cell.column, blocked);
        for (int down = -1; down <= 1; ++down)
            for (int along = -1; along <= 1; ++along) {
                const maps::Cell beside = {cell.row + down, cell.column + along};
                if (grid_.contains(beside)) look_again(beside);
            }
    }
    // Repairs the search after changes. False if no path leads to the goal. Stopped by an interrupt, it goes
    // on in the next call.
    bool replan(search::Effort& effort) {
        if (grid_.blocked(start_) || grid_.blocked(goal_)) return false;
        const std::uint32_t start = grid_.number(start_);
        InterruptPoll poll(128);
        while (!queue_.empty()) {
            poll.step();
            const Entry top = queue_.top();
            Node& node = at(top.cell);
            const Node& target = at(start);
            const bool is_outdated = !node.waits || !(top.key == node.key);
            if (!is_outdated && !(top.key < key_of(target, start_)) && !(target.g < target.rhs)) break;
            queue_.pop();
            if (is_outdated) continue;
            node.waits = false;
            settle(top, node, effort);
        }
        return !at(start).rhs.is_infinite();
    }
    // The cells of the path from the start to the goal; replan() must have returned true.
    void way(std::vector<maps::Cell>& cells) {
        cells.assign(1, start_);
        for (maps::Cell c = start_; !(c == goal_);) {
            c = best_neighbour(c).second;
            cells.push_back(c);
        }
    }

  private:
    // A length, or none: more straight steps than any way has.
    struct Length : Steps {
        static constexpr std::int32_t none = 1 << 30;
        static Length infinite() { return {{none, 0}}; }
        bool is_infinite() const { return straight >= none; }
        Length operator+(Steps more) const { return is_infinite() ? *this : Length{Steps(*this) + more}; }
    };
    struct Key {
        Steps f, g;
        friend bool operator<(const Key& x, const Key& y) { return x.f < y.f || (!(y.f < x.f) && x.g < y.g); }
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct Entry {
        Key key;
        std::uint32_t cell;
        friend bool operator<(const Entry& x, const Entry& y) { return x.key < y.key; }
    };
    struct Node {
        Length g = Length::infinite(), rhs = Length::infinite();
        Key key;  // its key in the queue
        bool waits = false;
    };

    Steps left(maps::Cell a, maps::Cell b) const {
        const int down = a.row - b.row, along = a.column - b.column;
        return corners_ == Corners::four ? Steps{std::abs(down) + std::abs(along), 0}
                                         : octile_steps(down, along);
    }
    Key key_of(const Node& node, maps::Cell cell) const {
        const Length least = node.g < node.rhs ? node.g : node.rhs;
        return {least + (left(start_, cell) + travelled_), least};
    }
    void wait(maps::Cell cell, Node& node) {
        const Key key = key_of(node, cell);
        if (node.waits && node.key == key) return;
        node.key = key;
        node.waits = true;
        queue_.push({node.key, grid_.number(cell)});
    }
    void settle(const Entry& top, Node& node, search::Effort& effort) {
        const maps::Cell cell = grid_.cell(top.cell);
        if (top.key < key_of(node, cell)) {  // the robot has moved since
            wait(cell, node);
            return;
        }
        ++effort.settled;
        if (effort.order) effort.order->push_back(top.cell);
        if (node.rhs < node.g) {
            node.g = node.rhs;
        } else {
            node.g = Length::infinite();
            look_again(cell);
        }
        for (unsigned open = moves(cell); open; open &= open - 1) {
            const int d = std::countr_zero(open);
            look_again({cell.row + row_step[d], cell.column + column_step[d]});
            ++effort.pushed;
        }
    }
    unsigned moves(maps::Cell c) const {
        if (grid_.blocked(c)) return 0;
        return allowed_moves[std::size_t(corners_)][grid_.around(c.row, c.column)];
    }
    // The least way to the goal through a neighbour, and that neighbour.
    std::pair<Length, maps::Cell> best_neighbour(maps::Cell c) {
        std::pair<Length, maps::Cell> best = {Length::infinite(), c};
        for (unsigned open = moves(c); open; open &= open - 1) {
            const int d = std::countr_zero(open);
            const maps::Cell to = {c.row + row_step[d], c.column + column_step[d]};
            const Length through = at(grid_.number(to)).g + (is_diagonal(d) ? Steps{0, 1} : Steps{1, 0});
            if (through < best.first) best = {through, to};
        }
        return best;
    }
    void look_again(maps::Cell cell) {
        Node& node = at(grid_.number(cell));
        if (!(cell == goal_)) node.rhs = best_neighbour(cell).first;
        if (node.g == node.rhs)
            node.waits = false;
        else
            wait(cell, node);
    }
    Node& at(std::uint32_t cell) {
        auto& page = pages_[cell >> page_bits];
        if (page.empty()) page.resize(std::size_t(1) << page_bits);
        return page[cell & ((1u << page_bits) - 1)];
    }

    static constexpr int page_bits = 10;
    maps::BitGrid grid_;
    Corners corners_;
    maps::Cell start_, goal_;
    Steps travelled_;  // how far the robot has moved since the first search, at least: k_m
    search::Heap<Entry> queue_;
    std::vector<std::vector<Node>> pages_ =
        std::vector<std::vector<Node>>((grid_.numbers() >> page_bits) + 1);
};

}  // namespace cspace::navigation
