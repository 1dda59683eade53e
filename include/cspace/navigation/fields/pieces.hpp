// The sides between free and blocked cells of a grid, ring after ring with free cells on their left, and cut
// into straight pieces between corners. Where two blocked cells meet in a corner a ring turns back on its own
// side: free cells join along sides alone.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/math/interrupts.hpp"

namespace cspace::navigation {

class Pieces {
  public:
    // A side from a corner of cells on: corner (row, column) is that of least row and column of the cell.
    struct Side {
        std::int32_t row, column, ring, piece;
        std::int8_t heading;  // 0 along columns, 1 up the rows, 2 and 3 back
    };
    // A place on the boundary: 2 k is where side k begins, 2 k + 1 its middle.
    using Mark = std::int32_t;
    struct HalfCells {
        std::int64_t row, column;
    };

    explicit Pieces(const maps::BitGrid& grid)
        : grid_(grid),
          below_(filled_vector<std::int32_t>(grid.numbers(), -1)),
          before_(filled_vector<std::int32_t>(grid.numbers(), -1)) {
        InterruptPoll poll(16);
        for (int row = 0; row < grid.rows(); ++row) {
            poll.step();
            for (std::size_t k = 0; k < grid.row_words(); ++k)
                for (std::uint64_t begin = ~grid.row(row)[k] & grid.row(row - 1)[k]; begin;
                     begin &= begin - 1) {
                    const int column = int(64 * k) + std::countr_zero(begin) - 1;
                    if (below_[grid.number({row, column})] < 0) follow(row, column);
                }
        }
        ring_begin_.push_back(std::int32_t(sides_.size()));
    }

    const std::vector<Side>& sides() const { return sides_; }
    std::int32_t piece(Mark mark) const { return sides_[std::size_t(mark >> 1)].piece; }
    HalfCells at(Mark mark) const {
        const Side& side = sides_[std::size_t(mark >> 1)];
        const int half = mark & 1;
        return {2 * std::int64_t(side.row) + half * up[side.heading],
                2 * std::int64_t(side.column) + half * along[side.heading]};
    }

    // The place of a blocked cell that is nearest to the centre of a free one, where no blocked cell is
    // nearer.
    Mark nearest(maps::Cell free, maps::Cell blocked) const {
        const int above = free.row - blocked.row, beyond = free.column - blocked.column;
        if (above == 0) return 2 * before_[grid_.number(blocked) + (beyond > 0)] + 1;
        const std::int32_t level = below_[grid_.number(blocked) + (above > 0 ? grid_.stride() : 0)];
        if (beyond == 0) return 2 * level + 1;
        // At a corner the side that leaves it.
        if ((above > 0) == (beyond < 0)) return 2 * level;
        return 2 * before_[grid_.number(blocked) + (beyond > 0)];
    }

    // Gives the memory of the sides of cells, a number for each cell, to another use: nearest() needed them.
    std::vector<std::int32_t> give_sides() {
        before_ = {};
        return std::move(below_);
    }

    // Whether two places belong to different stretches of boundary: to different rings, or farther apart
    // along their ring than twice the distance between them. Around one corner it is at most √2 times that
    // distance, and so along stairs.
    bool are_apart(Mark a, Mark b) const {
        if (a == b) return false;
        const std::int32_t ring = sides_[std::size_t(a >> 1)].ring;
        if (ring != sides_[std::size_t(b >> 1)].ring) return true;
        const std::int64_t round =
            2 * std::int64_t(ring_begin_[std::size_t(ring) + 1] - ring_begin_[std::size_t(ring)]);
        const std::int64_t one = a > b ? a - b : b - a, walk = std::min(one, round - one);
        const HalfCells p = at(a), q = at(b);
        const std::int64_t dr = p.row - q.row, dc = p.column - q.column;
        return walk * walk > 4 * (dr * dr + dc * dc);
    }

  private:
    static constexpr int up[4] = {0, 1, 0, -1}, along[4] = {1, 0, -1, 0};
    static constexpr int left_row[4] = {0, 0, -1, -1}, left_column[4] = {0, -1, -1, 0};

    const maps::BitGrid& grid_;
    std::vector<std::int32_t> below_, before_;  // the side of a cell towards less rows, and less columns
    std::vector<Side> sides_;
    std::vector<std::int32_t> ring_begin_;
    std::int32_t pieces_ = 0;

    std::int32_t& slot(int row, int column, int heading) {
        auto& sides = heading % 2 ? before_ : below_;
        return sides[grid_.number({row - (heading == 3), column - (heading == 2)})];
    }
    bool is_blocked_left(int row, int column, int heading) const {
        return grid_.blocked(row + left_row[heading], column + left_column[heading]);
    }

    void follow(int row, int column) {
        const std::int32_t ring = std::int32_t(ring_begin_.size()), first = std::int32_t(sides_.size());
        ring_begin_.push_back(first);
        const std::int32_t first_piece = pieces_;
        int heading = 0;
        InterruptPoll poll(1024);
        while (slot(row, column, heading) < 0) {
            slot(row, column, heading) = std::int32_t(sides_.size());
            poll.step();
            sides_.push_back({row, column, ring, pieces_, std::int8_t(heading)});
            row += up[heading];
            column += along[heading];
            const int before = heading;
            // The right of a heading is the left of the one before it.
            if (is_blocked_left(row, column, heading))
                heading = (heading + 1) & 3;
            else if (!is_blocked_left(row, column, (heading + 3) & 3))
                heading = (heading + 3) & 3;
            if (heading != before) ++pieces_;
        }
        if (sides_.back().heading != sides_[std::size_t(first)].heading) return;
        // The ring began within a piece.
        for (std::size_t k = sides_.size(); sides_[k - 1].piece == pieces_;) sides_[--k].piece = first_piece;
    }
};

}  // namespace cspace::navigation
