// The exact Euclidean distance from the centre of every free cell of a grid to the nearest blocked cell, and
// which cell that is: columns first, then in each row the lower envelope of what the columns offer (Meijster,
// Roerdink & Hesselink 2000; Felzenszwalb & Huttenlocher 2012).
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/bit_scan.hpp"
#include "cspace/math/interrupts.hpp"

namespace cspace::maps {

struct Clearance {
    // By number of cell; of blocked cells 0 and the cell itself.
    std::vector<std::uint32_t> squared;  // of the distance to the side or corner that is nearest [half cells]
    std::vector<std::uint32_t> nearest;

    double of(std::uint32_t cell) const { return 0.5 * std::sqrt(double(squared[cell])); }  // [cells]
};

// How distances are measured: from the centre of a cell to what point of a blocked cell, and whether the
// border around the grid is blocked. gap: to a cell so many rows or columns away. [half cells]

// To the near side or corner of the cell.
struct ToSides {
    static constexpr bool border = true;
    static std::int64_t gap(std::int64_t away) { return away == 0 ? 0 : 2 * std::abs(away) - 1; }
};
// To its centre; the border is free.
struct ToCenters {
    static constexpr bool border = false;
    static std::int64_t gap(std::int64_t away) { return 2 * std::abs(away); }
};
// What `squared` is where a free cell has no blocked one within 32,767 cells, and `nearest` where it has
// none.
inline constexpr std::uint32_t no_cell = std::numeric_limits<std::uint32_t>::max();

namespace clearance {

template <class Gap>
std::int64_t squared_gap(std::int64_t away) {
    const std::int64_t gap = Gap::gap(away);
    return gap * gap;
}

// The nearest blocked row in the column of every free cell of a row, for one row after the other: the walls
// above and below a stretch of free cells in a column are looked up where it begins.
template <class Gap>
class NearestRows {
  public:
    explicit NearestRows(const BitGrid& grid)
        : grid_(grid), above_(grid.stride()), below_(grid.stride()), nearest_(grid.stride()) {}
    // The first row is 0.
    void next_row(int row) {
        const std::uint64_t *line = grid_.row(row), *before = grid_.row(row - 1);
        for (std::size_t k = 0; k < grid_.row_words(); ++k)
            for (std::uint64_t begin = ~line[k] & before[k]; begin; begin &= begin - 1) {
                const int column = int(64 * k) + std::countr_zero(begin) - 1;
                const std::uint64_t* down = grid_.column(column);
                above_[std::size_t(column + 1)] = row - 1;
                below_[std::size_t(column + 1)] =
                    first_set([&](std::size_t word) { return down[word]; }, row);
            }
    }
    // For cells first … last of the row, which are free; the cells before and after them are blocked.
    void look(int row, int first, int last) {
        nearest_[std::size_t(first)] = nearest_[std::size_t(last + 2)] = row;
        for (std::size_t k = std::size_t(first + 1); k <= std::size_t(last + 1); ++k)
            nearest_[k] = is_below_nearer(below_[k], above_[k], row) ? below_[k] : above_[k];
    }
    // Whether a site is a blocked cell and not the border, where that is free.
    bool is_wall(int site) const { return Gap::border || (site >= 0 && site < grid_.rows()); }
    int operator[](int column) const { return nearest_[std::size_t(column + 1)]; }

  private:
    bool is_below_nearer(int below, int above, int row) const {
        if (!is_wall(above)) return true;
        return is_wall(below) && below - row < row - above;
    }

    const BitGrid& grid_;
    std::vector<std::int32_t> above_, below_, nearest_;  // by column + 1
};

// The sites of a run of free cells, from which each of them gets its nearest one.
template <class Gap>
class Envelope {
  public:
    // Cells first … last of a row are free, those before and after it blocked or beyond the sites of columns
    // low … high; up(c) is how far down or up column c the next blocked cell is, squared, below zero for
    // none. Calls give(column, site, squared).
    template <class Up, class Give>
    void run(int first, int last, int low, int high, const Up& up_of, const Give& give) {
        sites_.clear();
        for (int j = low; j <= high; ++j) {
            const std::int64_t up = up_of(j);
            if (!Gap::border && up < 0) continue;
            int from = first;
            while (!sites_.empty()) {
                from = first_nearer(sites_.back(), {j, up, 0}, last + 1);
                if (from > sites_.back().from) break;
                from = first;
                sites_.pop_back();
            }
            if (from <= last) sites_.push_back({j, up, from});
        }
        for (std::size_t k = 0; k < sites_.size(); ++k) {
            const int end = k + 1 < sites_.size() ? sites_[k + 1].from - 1 : last;
            for (int c = sites_[k].from; c <= end; ++c) give(c, sites_[k].column, at(sites_[k], c));
        }
    }

  private:
    struct Site {
        int column;
        std::int64_t up;
        int from;  // the first cell that it is nearest to
    };
    static std::int64_t at(const Site& site, int column) {
        return squared_gap<Gap>(column - site.column) + site.up;
    }
    // The first column from which on b, to the right of a, is nearer; at most `end`.
    static int first_nearer(const Site& a, const Site& b, int end) {
        const double apart = b.column - a.column;
        const double guess = 0.5 * (a.column + b.column) + double(b.up - a.up) / (8 * apart);
        if (!(guess < end + 2.0)) return end;
        int x = guess > a.from ? int(guess) : a.from;
        while (x > a.from && at(b, x - 1) < at(a, x - 1)) --x;
        while (x < end && at(b, x) >= at(a, x)) ++x;
        return x;
    }
    std::vector<Site> sites_;
};

}  // namespace clearance

template <class Gap = ToSides>
Clearance make_clearance(const BitGrid& grid) {
    Clearance made{filled_vector<std::uint32_t>(grid.numbers()),
                   filled_vector<std::uint32_t>(grid.numbers())};
    clearance::NearestRows<Gap> rows(grid);
    clearance::Envelope<Gap> envelope;
    InterruptPoll poll(4);
    for (int row = 0; row < grid.rows(); ++row) {
        poll.step();
        rows.next_row(row);
        const std::uint64_t* line = grid.row(row);
        const auto free = [&](std::size_t k) { return ~line[k]; };
        const auto blocked = [&](std::size_t k) { return line[k]; };
        const std::uint32_t number = grid.number({row, 0});
        const auto up = [&](int column) -> std::int64_t {
            const int site = rows[column];
            if (!rows.is_wall(site)) return -1;
            return clearance::squared_gap<Gap>(site - row);
        };
        const auto give = [&](int c, int site, std::int64_t squared) {
            made.squared[number + std::uint32_t(c)] = std::uint32_t(std::min<std::int64_t>(squared, no_cell));
            made.nearest[number + std::uint32_t(c)] = grid.number({rows[site], site});
        };
        for (int column = first_set(free, 0); column < grid.columns();) {
            const int last = first_set(blocked, column) - 1;
            rows.look(row, column, last);
            if constexpr (!Gap::border) {
                const std::size_t begin = number + std::size_t(column),
                                  count = std::size_t(last - column + 1);
                std::fill_n(made.squared.begin() + std::ptrdiff_t(begin), count, no_cell);
                std::fill_n(made.nearest.begin() + std::ptrdiff_t(begin), count, no_cell);
            }
            const int low = Gap::border ? column - 1 : std::max(column - 1, 0);
            const int high = Gap::border ? last + 1 : std::min(last + 1, grid.columns() - 1);
            envelope.run(column, last, low, high, up, give);
            column = first_set(free, last + 1);
        }
    }
    return made;
}

}  // namespace cspace::maps
