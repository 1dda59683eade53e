// The connected parts of a grid's free cells, for the proof that no path leads from one cell to another:
// which of the three largest parts a cell lies in, two bits per cell.
//
// Rows are swept once to join the runs of free cells that touch in neighbouring rows (Rosenfeld & Pfaltz
// 1966; runs by sets: Wu, Otoo & Suzuki 2009), and once more to write down what the joined parts are; only
// the runs of two rows and the sets are in memory meanwhile.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/bit_scan.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/made_once.hpp"

namespace cspace::maps {

class GridParts {
  public:
    // diagonal: whether cells that touch in a corner are connected.
    GridParts(const BitGrid& grid, bool diagonal)
        : low_(grid.rows(), grid.columns() + 1), high_(grid.rows(), grid.columns() + 1) {
        sweep(
            grid, diagonal, [&](Label a, Label b) { join(a, b); },
            [&](int, const Run& run) {
                if (run.label == sets_.size()) sets_.push_back({run.label, 0});
                sets_[run.label].cells += std::uint32_t(run.end - run.begin);
            });
        rank();
        sweep(
            grid, diagonal, [](Label, Label) {},
            [&](int row, const Run& run) {
                const std::uint32_t number = sets_[run.label].cells;
                if (number & 1) fill(low_.line(row), run.begin, run.end);
                if (number & 2) fill(high_.line(row), run.begin, run.end);
            });
        std::vector<Set>().swap(sets_);
    }
    std::int64_t count() const { return count_; }

    // Whether two free cells certainly lie in different parts; false for two outside the largest parts.
    bool divide(Cell a, Cell b) const { return number_of(a) != number_of(b); }
    std::size_t bytes() const { return low_.bytes() + high_.bytes(); }

  private:
    using Label = std::uint32_t;
    static constexpr int numbered = 3;
    struct Run {
        int begin, end;
        Label label;
    };
    struct Set {
        Label parent;
        std::uint32_t cells;  // in the end: the number of the part, 0 for all but the largest
    };

    BitLines low_, high_;  // the bits of the number of each cell's part
    std::vector<Set> sets_;
    std::int64_t count_ = 0;

    // Visits the runs of free cells row by row. Each is given the label of the first it touches in the row
    // before, or a new one, the same in every sweep; meet(a, b) for the others that it touches.
    template <class Meet, class Visit>
    static void sweep(const BitGrid& grid, bool diagonal, Meet meet, Visit visit) {
        constexpr Label unlabelled = std::numeric_limits<Label>::max();
        std::vector<Run> before, here;
        Label next = 0;
        const int reach = diagonal;
        InterruptPoll poll(16);
        for (int row = 0; row < grid.rows(); ++row) {
            poll.step();
            const auto word = [line = grid.row(row)](std::size_t w) { return line[w]; };
            std::size_t k = 0;
            here.clear();
            for (int begin = first_clear(word, 0, grid.columns()); begin < grid.columns();) {
                Run run{begin, first_set(word, begin), unlabelled};
                while (k < before.size() && before[k].end + reach <= run.begin) ++k;
                for (std::size_t j = k; j < before.size() && before[j].begin < run.end + reach; ++j)
                    if (run.label == unlabelled)
                        run.label = before[j].label;
                    else if (run.label != before[j].label)
                        meet(run.label, before[j].label);
                if (run.label == unlabelled) run.label = next++;
                visit(row, run);
                here.push_back(run);
                begin = first_clear(word, run.end, grid.columns());
            }
            std::swap(before, here);
        }
    }
    static void fill(std::uint64_t* line, int begin, int end) {
        for (int at = begin; at < end;) {
            const int word = at >> 6, stop = std::min(end, 64 * (word + 1));
            line[word] |= (~std::uint64_t(0) >> (64 - (stop - at))) << (at & 63);
            at = stop;
        }
    }
    unsigned number_of(Cell c) const {
        const auto bit = [&](const BitLines& lines) {
            return unsigned(lines.line(c.row)[c.column >> 6] >> (c.column & 63) & 1);
        };
        return bit(low_) | bit(high_) << 1;
    }

    Label root_of(Label a) {
        while (sets_[a].parent != a) a = sets_[a].parent = sets_[sets_[a].parent].parent;
        return a;
    }
    void join(Label a, Label b) {
        a = root_of(a), b = root_of(b);
        sets_[std::max(a, b)].parent = std::min(a, b);
    }
    // Numbers the largest parts, the largest 1.
    void rank() {
        for (Label a = 0; a < sets_.size(); ++a) {
            const Label root = root_of(a);
            if (root == a)
                ++count_;
            else
                sets_[root].cells += sets_[a].cells;
        }
        std::array<std::pair<std::uint32_t, Label>, numbered> largest{};
        for (Label a = 0; a < sets_.size(); ++a)
            if (sets_[a].parent == a && sets_[a].cells > largest.back().first) {
                largest.back() = {sets_[a].cells, a};
                std::sort(largest.begin(), largest.end(), [](auto x, auto y) { return x.first > y.first; });
            }
        for (Set& set : sets_) set.cells = 0;
        for (std::uint32_t k = 0; k < numbered; ++k)
            if (largest[k].first) sets_[largest[k].second].cells = k + 1;
        for (Label a = 0; a < sets_.size(); ++a) sets_[a].cells = sets_[root_of(a)].cells;
    }
};

// The parts of a grid under either rule, computed on first use, by any thread.
class LazyParts {
  public:
    // How many cells a search may settle before it takes longer than making the parts; on small grids it
    // never does.
    static std::uint64_t patience(const BitGrid& grid) {
        constexpr std::uint32_t small = 1 << 16;
        return grid.numbers() < small ? std::numeric_limits<std::uint64_t>::max() : grid.numbers() / 64;
    }
    bool is_made(bool diagonal) const { return parts_[diagonal].find(); }
    const GridParts& of(const BitGrid& grid, bool diagonal) {
        return parts_[diagonal].get([&] { return std::make_unique<GridParts>(grid, diagonal); });
    }
    std::size_t bytes() const {
        std::size_t sum = 0;
        for (const auto& parts : parts_)
            if (const GridParts* made = parts.find()) sum += made->bytes();
        return sum;
    }

  private:
    MadeOnce<GridParts> parts_[2];
};

}  // namespace cspace::maps
