// The space of a search from cell to neighbouring cell; the parent rule says what a way costs and where it
// comes from.
#pragma once

#include <bit>
#include <cstdint>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/navigation/grid/moves.hpp"
#include "cspace/navigation/grid/nodes.hpp"
#include "cspace/navigation/grid/order.hpp"
#include "cspace/navigation/grid/parents.hpp"

namespace cspace::navigation {

template <class Parents>
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
          reopen_(reopen) {
        for (int d = 0; d < 8; ++d)
            offset_[d] = std::uint32_t(row_step[d]) * grid.stride() + std::uint32_t(column_step[d]);
        nodes_.begin(grid.numbers());
    }
    template <class Queue>
    void start(maps::Cell at, Queue& queue, Effort& effort) {
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
        for (unsigned open = allowed_[grid_.around(from.row, from.column)]; open; open &= open - 1) {
            const int d = std::countr_zero(open);
            auto& node = nodes_.at(number + offset_[d]);
            if (!reopen_ && nodes_.is_settled(node)) continue;
            const maps::Cell to = {from.row + row_step[d], from.column + column_step[d]};
            const auto way = parents_.way(*this, number, g, parent, from, to, d);
            if (nodes_.is_reached(node) && !(way.g < node.g)) continue;
            nodes_.reach(node, way.g, way.parent);
            queue.push(order_.rank(way.g, to, number + offset_[d]));
            ++effort_->pushed;
        }
    }

    const maps::BitGrid& grid() const { return grid_; }
    maps::Cell cell(std::uint32_t number) const { return grid_.cell(number); }
    auto& node(std::uint32_t number) { return nodes_.at(number); }
    Nodes& nodes() { return nodes_; }

  private:
    const maps::BitGrid& grid_;
    const std::array<std::uint8_t, 512>& allowed_;
    const Order& order_;
    Parents parents_;
    Nodes& nodes_;
    Effort* effort_ = nullptr;
    std::uint32_t goal_;
    std::uint32_t offset_[8];
    bool reopen_;
};

}  // namespace cspace::navigation
