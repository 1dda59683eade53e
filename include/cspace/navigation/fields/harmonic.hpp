// A harmonic potential over the cells of a grid (Connolly, Burns & Weiss 1990), 0 at the goal and 1 on walls,
// and the way down it. It is 1 − the chance that a random walk comes to the goal first, and that chance is
// what is kept.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/clearance.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/fields/factor_level.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "cspace/navigation/grid/moves.hpp"
#include "cspace/search/best_first.hpp"

namespace cspace::navigation {

// The probability that a random walk over the cells of a grid reaches the goal before a wall: it
// solves Laplace's equation with 1 at the goal and 0 on walls, so every other cell is the mean of the four
// beside it.
//
// Along a corridor it falls by a factor with every cell, soon below the range of a double: each number has
// a separate exponent, and the unknowns are factors near one. The solver is an aggregation of
// several levels (Horton & Leutenegger 1994) on the system scaled by its own iterate: squares of two by two
// cells share a factor, then four by four, and so on; relaxations go from the goal outwards and back.

class HittingSolver {
  public:
    HittingSolver(const maps::BitGrid& grid, const maps::Clearance& clearance, maps::Cell goal)
        : grid_(grid) {
        number_cells(clearance, goal);
        join_cells();
        make_levels();
    }

    // Until every cell is the mean of its neighbours up to a relative error, or so many cycles.
    void solve(double residual, int most_cycles) {
        for (int k = 0; k < 10; ++k) relax_level();
        for (cycles_ = 0; cycles_ < most_cycles; ++cycles_) {
            relax_level();
            residual_ = gather_level();
            if (residual_ <= residual || levels_.empty()) break;
            cycle(0);
            spread();
            relax_level();
            normalize();
        }
        if (levels_.empty()) normalize();
    }

    std::size_t size() const { return cells_.size(); }
    double residual() const { return residual_; }
    int cycles() const { return cycles_; }
    const maps::BitGrid& grid() const { return grid_; }
    maps::Cell cell(std::size_t i) const { return grid_.cell(cells_[i]); }
    // The number of a cell here, or size() if no path leads to the goal.
    std::size_t index(maps::Cell c) const { return std::size_t(index_[grid_.number(c)]); }
    bool is_less(std::size_t i, std::size_t j) const {
        return e_[i] != e_[j] ? e_[i] < e_[j] : m_[i] < m_[j];
    }
    // The logarithm of the chance of the i-th cell; the goal is the first.
    double log_chance(std::size_t i) const { return std::log(m_[i]) + std::numbers::ln2 * double(e_[i]); }

  private:
    maps::BitGrid grid_;
    std::vector<std::uint32_t> cells_;  // from the goal outwards
    std::vector<std::int32_t> index_;
    std::vector<std::array<std::int32_t, 4>> beside_;
    std::vector<double> m_;  // the chance is m · 2^e; the last is that of walls, nothing
    std::vector<std::int32_t> e_;
    std::vector<std::int32_t> aggregate_, slot_;
    std::vector<FactorLevel> levels_;
    double residual_ = 0;
    int cycles_ = 0;
    std::array<std::uint32_t, 4> around(std::uint32_t n) const {
        return {n - 1, n + 1, n - grid_.stride(), n + grid_.stride()};
    }
    bool is_blocked(std::uint32_t n) const { return grid_.blocked(grid_.cell(n)); }

    // Cells in the order of a first guess: half the decay along a corridor as wide as the clearance allows.
    void number_cells(const maps::Clearance& clearance, maps::Cell goal) {
        auto far = filled_vector(grid_.numbers(), std::numeric_limits<double>::infinity());
        InterruptPoll poll(512);
        search::Heap<std::pair<double, std::uint32_t>> queue;
        queue.push({far[grid_.number(goal)] = 0, grid_.number(goal)});
        while (!queue.empty()) {
            poll.step();
            const auto [d, n] = queue.pop();
            if (d > far[n]) continue;
            cells_.push_back(n);
            m_.push_back(std::exp2(-std::fmod(d, 1.0)));
            e_.push_back(-std::int32_t(d));
            for (const std::uint32_t to : around(n)) {
                if (is_blocked(to)) continue;
                const double rho = std::max(clearance.of(to), 0.5);
                const double way = d + 0.5 * std::min(2.0, std::numbers::pi / (2 * rho) / std::numbers::ln2);
                if (way < far[to]) queue.push({far[to] = way, to});
            }
        }
        m_.push_back(0), e_.push_back(0);
    }
    void join_cells() {
        index_ = filled_vector(grid_.numbers(), std::int32_t(cells_.size()));
        visit_range(0, cells_.size(), [&](std::size_t i) { index_[cells_[i]] = std::int32_t(i); });
        beside_ = filled_vector<std::array<std::int32_t, 4>>(cells_.size());
        visit_range(0, cells_.size(), [&](std::size_t i) {
            for (std::size_t k = 0; k < 4; ++k) beside_[i][k] = index_[around(cells_[i])[k]];
        });
    }

    // ---- levels

    void make_levels() {
        const std::int32_t size = std::int32_t(cells_.size());
        if (size < 2) return;
        std::vector<std::int32_t> row, column;
        visit_range(0, cells_.size(),
                    [&](std::size_t i) { row.push_back(cell(i).row), column.push_back(cell(i).column); });
        slot_ = filled_vector<std::int32_t>(4 * cells_.size());
        levels_.push_back(factors::join_level(
            size, row, column,
            [&](std::int32_t i, const auto& give) {
                for (std::size_t k = 0; k < 4; ++k)
                    if (const std::int32_t j = beside_[std::size_t(i)][k]; j < size)
                        give(j, 4 * std::size_t(i) + k);
            },
            aggregate_, slot_));
        while (levels_.back().size() > 40) {
            FactorLevel& last = levels_.back();
            FactorLevel next = factors::join_level(
                last.size(), last.block_row, last.block_column,
                [&](std::int32_t i, const auto& give) {
                    for (std::int32_t p = last.begin[std::size_t(i)]; p < last.begin[std::size_t(i) + 1]; ++p)
                        give(last.column[std::size_t(p)], std::size_t(p));
                },
                last.aggregate, last.slot);
            levels_.push_back(std::move(next));
        }
    }

    // ---- cells

    double beside_over(std::size_t i, std::size_t k) const {
        const std::size_t j = std::size_t(beside_[i][k]);
        return m_[j] * factors::power_of_two(e_[j] - e_[i]);
    }
    void relax_cell(std::size_t i) {
        m_[i] = 0.25 * (beside_over(i, 0) + beside_over(i, 1) + beside_over(i, 2) + beside_over(i, 3));
    }
    void relax_level() {
        visit_range(1, cells_.size(), [&](std::size_t i) { relax_cell(i); });
        visit_range(1, cells_.size(), [&](std::size_t i) { relax_cell(cells_.size() - i); });
    }
    void normalize() {
        visit_range(1, cells_.size(), [&](std::size_t i) {
            int k;
            m_[i] = std::frexp(m_[i], &k);
            e_[i] += k;
        });
    }
    // The first level's weights from the cells; returns the greatest share that a cell is off its mean by.
    double gather_level() {
        double worst = 0;
        if (levels_.empty()) return worst;
        FactorLevel& to = levels_[0];
        factors::clear_level(to);
        factors::raise_exponents(to.exponent, e_, aggregate_);
        visit_range(1, cells_.size(), [&](std::size_t i) {
            const std::size_t one = std::size_t(aggregate_[i]);
            const double share = m_[i] * m_[i] * factors::power_of_two(2 * (e_[i] - to.exponent[one]));
            const double inverse = 1 / m_[i];
            double excess = 4;
            for (std::size_t k = 0; k < 4; ++k) {
                const double weight = beside_over(i, k) * inverse;
                excess -= weight;
                if (slot_[4 * i + k] >= 0) to.weight[std::size_t(slot_[4 * i + k])] += share * weight;
            }
            to.excess[one] += share * excess;
            worst = std::max(worst, 0.25 * std::abs(excess));
        });
        return worst;
    }
    void spread() {
        visit_range(1, cells_.size(), [&](std::size_t i) {
            factors::correct_factor(m_[i], levels_[0].factor[std::size_t(aggregate_[i])]);
        });
    }

    // ---- one cycle

    void cycle(std::size_t k) {
        FactorLevel& level = levels_[k];
        if (k + 1 == levels_.size()) return factors::relax_level(level, 40);
        factors::relax_level(level, 1);
        for (int turn = 0; turn < 2; ++turn) {
            factors::gather_level(level, levels_[k + 1]);
            cycle(k + 1);
            visit_range(1, level.begin.size() - 1, [&](std::size_t i) {
                factors::correct_factor(level.factor[i],
                                        levels_[k + 1].factor[std::size_t(level.aggregate[i])]);
            });
            factors::relax_level(level, 1);
        }
    }
};

class HarmonicField : public HittingSolver {
  public:
    HarmonicField(const maps::BitGrid& grid, const maps::Clearance& clearance, maps::Cell goal,
                  double residual, int most_cycles)
        : HittingSolver(grid, clearance, goal) {
        solve(residual, most_cycles);
        visit_range(1, size(), [&](std::size_t i) { rests_ += uphill(cell(i)) == cell(i); });
    }

    // Cells but the goal from which no step leads down: none, where the equation is solved well enough.
    std::int64_t rests() const { return rests_; }
    // Minus the logarithm of the chance: 0 at the goal, infinite on walls and where no path leads to the
    // goal.
    double height(maps::Cell cell) const {
        const std::size_t i = index(cell);
        return i == size() ? std::numeric_limits<double>::infinity() : 0.0 - log_chance(i);
    }
    // From a cell to the goal, or as far as a step leads down.
    GridAnswer descend(maps::Cell start) const {
        GridAnswer answer;
        answer.effort.settled = size();
        answer.effort.pushed = 4 * size() * std::size_t(cycles());
        if (index(start) == size()) return answer;
        answer.cells = {start};
        for (maps::Cell next; !((next = uphill(answer.cells.back())) == answer.cells.back());)
            answer.cells.push_back(next);
        answer.found = index(answer.cells.back()) == 0;
        return answer;
    }

  private:
    std::int64_t rests_ = 0;

    // The neighbour towards which the chance grows most, past no blocked corner; the cell itself where none
    // has more.
    maps::Cell uphill(maps::Cell from) const {
        const std::size_t i = index(from);
        const double here = log_chance(i);
        maps::Cell best = from;
        double most = 0;
        for (int d = 0; d < 8; ++d) {
            const maps::Cell to{from.row + row_step[d], from.column + column_step[d]};
            if (grid().blocked(to) || grid().blocked(from.row, to.column) ||
                grid().blocked(to.row, from.column))
                continue;
            const std::size_t j = index(to);
            if (!is_less(i, j)) continue;
            const double rise = (log_chance(j) - here) / (is_diagonal(d) ? std::numbers::sqrt2 : 1.0);
            if (best == from || rise > most) best = to, most = rise;
        }
        return best;
    }
};

}  // namespace cspace::navigation
