// The space of a search from cell to neighbouring cell; the parent rule gives the cost of a path and its
// parent.
#pragma once

#include <bit>
#include <cstdint>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/navigation/grid/moves.hpp"
#include "cspace/navigation/grid/neighbour_pruning.hpp"
#include "cspace/navigation/grid/nodes.hpp"
#include "cspace/navigation/grid/order.hpp"
#include "cspace/navigation/grid/parents.hpp"

namespace cspace::navigation {

template <class Parents, class Order = navigation::Order>
class GridSearch {
  public:
    using G = typename Parents::G;
    using Nodes = PagedNodes<G>;

    // reopen: whether a settled cell that a shorter way reaches is settled again.
    GridSearch(const maps::BitGrid& grid, Corners corners, const Order& order, Parents parents, Nodes& nodes,
               bool reopen)
        : grid_(grid),
          allowed_(allowed_moves[std::size_t(corners)]),
          order_(order),
          parents_(parents),
          nodes_(nodes),
          goal_(grid.number(order.goal)),
          offset_(grid.stride()),
          reopen_(reopen) {
        if (Parents::is_length && order.is_exact() && !reopen) pruning_ = pruned_moves[std::size_t(corners)];
        nodes_.begin(grid.numbers());
    }
    template <class Queue>
    void start(maps::Cell at, Queue& queue, search::Effort& effort) {
        const std::uint32_t number = grid_.number(at);
        effort_ = &effort;
        nodes_.reach(nodes_.at(number), G{}, number);
        queue.push(order_.rank(G{}, at, number));
        ++effort.pushed;
    }

    bool settle(std::uint32_t number) {
        auto& node = nodes_.at(number);
        if (nodes_.is_settled(node)) return false;
        nodes_.settle(node);
        parents_.settle(*this, number);
        return true;
    }
    bool is_goal(std::uint32_t number) const { return number == goal_; }
    template <class Queue>
    void expand(std::uint32_t number, Queue& queue) {
        const maps::Cell from = grid_.cell(number);
        const auto [g, parent, stamp] = nodes_.at(number);
        const unsigned around = grid_.around(from.row, from.column);
        Improved better[8];
        int count;
        if constexpr (!Parents::is_neighbour) {
            count = improved(number, g, parent, from, allowed_[around], better);
        } else if (parent == number) {
            count = improved<8>(number, g, from, allowed_[around], 0, better);
        } else {
            const int d = arrival(number - parent);
            const unsigned open =
                pruning_ ? (*pruning_)[std::size_t(d)][around] : allowed_[around] & ahead(d);
            count = improved<5>(number, g, from, open, d + 6, better);
        }
        for (int k = 0; k < count; ++k) {
            const auto& [way, d] = better[k];
            const maps::Cell to = {from.row + row_step[d], from.column + column_step[d]};
            nodes_.reach(nodes_.at(number + offset_[d]), way.g, way.parent);
            queue.push(order_.rank(way.g, to, number + offset_[d]));
            ++effort_->pushed;
        }
    }

    const maps::BitGrid& grid() const { return grid_; }
    maps::Cell cell(std::uint32_t number) const { return grid_.cell(number); }
    auto& node(std::uint32_t number) { return nodes_.at(number); }
    Nodes& nodes() { return nodes_; }

  private:
    using Node = typename Nodes::Node;
    struct Improved {
        Reach<G> way;
        int direction;
    };
    // The neighbours in open directions to which the way over this cell is the shortest so far.
    int improved(std::uint32_t number, G g, std::uint32_t parent, maps::Cell from, unsigned open,
                 Improved* better) {
        int count = 0;
        for (; open; open &= open - 1) {
            const int d = std::countr_zero(open);
            Node& node = nodes_.at(number + offset_[d]);
            if (!reopen_ && nodes_.is_settled(node)) continue;
            const maps::Cell to = {from.row + row_step[d], from.column + column_step[d]};
            better[count] = {parents_.way(*this, number, g, parent, from, to, d), d};
            count += !nodes_.is_reached(node) || better[count].way.g < node.g;
        }
        return count;
    }
    // The same where cells are reached from their neighbours. Which of them wait for a shorter way no
    // processor foresees, so there is no branch for that, and where most are open none for those that are
    // not.
    template <int directions>
    int improved(std::uint32_t number, G g, maps::Cell from, unsigned open, int first, Improved* better) {
        int count = 0;
        const auto look = [&](int d, unsigned is_open) {
            Node& node = nodes_.at(number + offset_[d]);
            const G way = g + parents_.length.along(from, d, is_open);
            better[count] = {{way, number}, d};
            count += int(is_open & unsigned(reopen_ | !nodes_.is_settled(node)) &
                         (unsigned(!nodes_.is_reached(node)) | unsigned(way < node.g)));
        };
        if constexpr (Parents::is_length)
            for (; open; open &= open - 1) look(std::countr_zero(open), 1);
        else
            for (int k = first; k < first + directions; ++k) look(k & 7, open >> (k & 7) & 1);
        return count;
    }
    // All but those that lead to cells beside the one before: from there they are no farther, whatever cells
    // cost.
    static unsigned ahead(int d) { return ~(bit_of(d + 3) | bit_of(d + 4) | bit_of(d + 5)); }
    // The direction of a step, from the difference of the numbers of its cells.
    int arrival(std::uint32_t difference) const {
        const int step = int(difference), stride = int(grid_.stride());
        const int down = (step > 1) - (step < -1);
        return direction_of[down + 1][step - down * stride + 1];
    }
    const maps::BitGrid& grid_;
    const std::array<std::uint8_t, 512>& allowed_;
    const PruningTable* pruning_ = nullptr;  // where ways of equal length need not all be looked at
    const Order& order_;
    Parents parents_;
    Nodes& nodes_;
    search::Effort* effort_ = nullptr;
    std::uint32_t goal_;
    NeighbourOffsets offset_;
    bool reopen_;
};

}  // namespace cspace::navigation
