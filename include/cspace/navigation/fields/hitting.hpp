// The chance that a random walk over the cells of a grid comes to the goal before it comes to a wall: it
// solves Laplace's equation with 1 at the goal and 0 on walls, so every other cell is the mean of the four
// beside it.
//
// Along a corridor it falls by a factor with every cell, soon below what a double can hold: each number has
// an exponent of its own, and what is solved for are factors near one. The solver is an aggregation of
// several levels (Horton & Leutenegger 1994) on the system scaled by its own iterate: squares of two by two
// cells share a factor, then four by four, and so on; relaxations go from the goal outwards and back.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/navigation/fields/clearance.hpp"

namespace cspace::navigation {

// Rows D_i f_i = Σ N_ij f_j in factors f, with D_i = Σ N_ij + excess_i; row 0 is the goal, whose factor is
// one.
struct FactorLevel {
    std::vector<std::int32_t> begin, column;
    std::vector<double> weight, excess, factor;
    std::vector<std::int32_t> exponent;  // rows are divided by 4^exponent, the square of their scale
    // To the next level: the aggregate of each row, and where the weight of each entry is added (−1:
    // nowhere).
    std::vector<std::int32_t> aggregate, slot;
    std::vector<std::int32_t> block_row, block_column;

    std::int32_t size() const { return std::int32_t(block_row.size()); }
};

class HittingSolver {
  public:
    HittingSolver(const maps::BitGrid& grid, const Clearance& clearance, maps::Cell goal) : grid_(grid) {
        number_cells(clearance, goal);
        join_cells();
        make_levels();
    }

    // Until every cell is the mean of those beside it, but for a share of it, or so many cycles. look() is
    // called now and then, and may throw.
    template <class Look>
    void solve(double residual, int most_cycles, const Look& look) {
        for (int k = 0; k < 10; ++k) relax(), look();
        for (cycles_ = 0; cycles_ < most_cycles; ++cycles_) {
            look();
            relax();
            residual_ = gather();
            if (residual_ <= residual || levels_.empty()) break;
            cycle(0);
            spread();
            relax();
            normalize();
        }
        if (levels_.empty()) normalize();
    }

    std::size_t size() const { return cells_.size(); }
    double residual() const { return residual_; }
    int cycles() const { return cycles_; }
    maps::Cell cell(std::size_t i) const { return grid_.cell(cells_[i]); }
    // The number of a cell here, or size() where no way leads to the goal.
    std::size_t index(maps::Cell c) const { return std::size_t(index_[grid_.number(c)]); }
    bool is_less(std::size_t i, std::size_t j) const {
        return e_[i] != e_[j] ? e_[i] < e_[j] : m_[i] < m_[j];
    }
    // The logarithm of the chance of the i-th cell; the goal is the first.
    double log_chance(std::size_t i) const { return std::log(m_[i]) + std::numbers::ln2 * double(e_[i]); }

  private:
    const maps::BitGrid& grid_;
    std::vector<std::uint32_t> cells_;  // from the goal outwards
    std::vector<std::int32_t> index_;
    std::vector<std::array<std::int32_t, 4>> beside_;
    std::vector<double> m_;  // the chance is m · 2^e; the last is that of walls, nothing
    std::vector<std::int32_t> e_;
    std::vector<std::int32_t> aggregate_, slot_;
    std::vector<FactorLevel> levels_;
    double residual_ = 0;
    int cycles_ = 0;
    // Of one cycle on one level. A first guess that is too large is mended at once, as all weights are
    // positive; one that is too small could ask for anything.
    static constexpr double least_factor = 1e-60, most_factor = 4;

    static double power_of_two(std::int32_t k) {
        if (k < -1022) return 0;
        return std::bit_cast<double>(std::uint64_t(std::min(k, 1023) + 1023) << 52);
    }
    std::array<std::uint32_t, 4> around(std::uint32_t n) const {
        return {n - 1, n + 1, n - grid_.stride(), n + grid_.stride()};
    }
    bool is_blocked(std::uint32_t n) const { return grid_.blocked(grid_.cell(n)); }

    // Cells in the order of a first guess: half the decay along a corridor as wide as the clearance allows.
    void number_cells(const Clearance& clearance, maps::Cell goal) {
        std::vector<double> far(grid_.numbers(), std::numeric_limits<double>::infinity());
        using Entry = std::pair<double, std::uint32_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        queue.push({far[grid_.number(goal)] = 0, grid_.number(goal)});
        while (!queue.empty()) {
            const auto [d, n] = queue.top();
            queue.pop();
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
        index_.assign(grid_.numbers(), std::int32_t(cells_.size()));
        for (std::size_t i = 0; i < cells_.size(); ++i) index_[cells_[i]] = std::int32_t(i);
        beside_.resize(cells_.size());
        for (std::size_t i = 0; i < cells_.size(); ++i)
            for (std::size_t k = 0; k < 4; ++k) beside_[i][k] = index_[around(cells_[i])[k]];
    }

    // ---- levels

    template <class EachBeside>
    static FactorLevel joined(std::int32_t size, const std::vector<std::int32_t>& row,
                              const std::vector<std::int32_t>& column, const EachBeside& each_beside,
                              std::vector<std::int32_t>& aggregate, std::vector<std::int32_t>& slot) {
        FactorLevel made;
        std::vector<std::int32_t> root(std::size_t(size), 0);
        std::iota(root.begin(), root.end(), 0);
        const auto find = [&](std::int32_t i) {
            while (root[std::size_t(i)] != i)
                i = root[std::size_t(i)] = root[std::size_t(root[std::size_t(i)])];
            return i;
        };
        for (std::int32_t i = 1; i < size; ++i)
            each_beside(i, [&](std::int32_t j, std::size_t) {
                const std::size_t a = std::size_t(i), b = std::size_t(j);
                if (j > 0 && row[a] >> 1 == row[b] >> 1 && column[a] >> 1 == column[b] >> 1) {
                    const std::int32_t p = find(i), q = find(j);
                    root[std::size_t(std::max(p, q))] = std::min(p, q);
                }
            });
        aggregate.assign(std::size_t(size), 0);
        for (std::int32_t i = 0; i < size; ++i) {
            const std::int32_t first = find(i);
            if (first == i) {
                aggregate[std::size_t(i)] = made.size();
                made.block_row.push_back(row[std::size_t(i)] >> 1);
                made.block_column.push_back(column[std::size_t(i)] >> 1);
            } else {
                aggregate[std::size_t(i)] = aggregate[std::size_t(first)];
            }
        }
        place_entries(made, size, each_beside, aggregate, slot);
        return made;
    }
    template <class EachBeside>
    static void place_entries(FactorLevel& made, std::int32_t size, const EachBeside& each_beside,
                              const std::vector<std::int32_t>& aggregate, std::vector<std::int32_t>& slot) {
        std::vector<std::pair<std::uint64_t, std::size_t>> entries;
        for (std::int32_t i = 1; i < size; ++i)
            each_beside(i, [&](std::int32_t j, std::size_t p) {
                const std::uint64_t a = std::uint32_t(aggregate[std::size_t(i)]),
                                    b = std::uint32_t(aggregate[std::size_t(j)]);
                if (a != b) entries.push_back({a << 32 | b, p});
            });
        std::sort(entries.begin(), entries.end());
        std::fill(slot.begin(), slot.end(), -1);
        made.begin.assign(std::size_t(made.size()) + 1, 0);
        for (std::size_t k = 0; k < entries.size(); ++k) {
            if (k == 0 || entries[k].first != entries[k - 1].first) {
                made.column.push_back(std::int32_t(entries[k].first & 0xffffffff));
                ++made.begin[std::size_t(entries[k].first >> 32) + 1];
            }
            slot[entries[k].second] = std::int32_t(made.column.size()) - 1;
        }
        for (std::size_t k = 1; k < made.begin.size(); ++k) made.begin[k] += made.begin[k - 1];
        made.weight.resize(made.column.size());
        made.excess.resize(std::size_t(made.size()));
        made.factor.resize(std::size_t(made.size()));
        made.exponent.resize(std::size_t(made.size()));
        made.slot.resize(made.column.size());
    }
    void make_levels() {
        const std::int32_t size = std::int32_t(cells_.size());
        if (size < 2) return;
        std::vector<std::int32_t> row, column;
        for (const std::uint32_t n : cells_)
            row.push_back(grid_.cell(n).row), column.push_back(grid_.cell(n).column);
        slot_.resize(4 * cells_.size());
        levels_.push_back(joined(
            size, row, column,
            [&](std::int32_t i, const auto& give) {
                for (std::size_t k = 0; k < 4; ++k)
                    if (const std::int32_t j = beside_[std::size_t(i)][k]; j < size)
                        give(j, 4 * std::size_t(i) + k);
            },
            aggregate_, slot_));
        while (levels_.back().size() > 40) {
            FactorLevel& last = levels_.back();
            FactorLevel next = joined(
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
        return m_[j] * power_of_two(e_[j] - e_[i]);
    }
    void relax_cell(std::size_t i) {
        m_[i] = 0.25 * (beside_over(i, 0) + beside_over(i, 1) + beside_over(i, 2) + beside_over(i, 3));
    }
    void relax() {
        for (std::size_t i = 1; i < cells_.size(); ++i) relax_cell(i);
        for (std::size_t i = cells_.size(); --i > 0;) relax_cell(i);
    }
    void normalize() {
        for (std::size_t i = 1; i < cells_.size(); ++i) {
            int k;
            m_[i] = std::frexp(m_[i], &k);
            e_[i] += k;
        }
    }
    // The first level's weights from the cells; returns the greatest share that a cell is off its mean by.
    double gather() {
        double worst = 0;
        if (levels_.empty()) return worst;
        FactorLevel& to = levels_[0];
        clear(to);
        raise(to.exponent, e_, aggregate_);
        for (std::size_t i = 1; i < cells_.size(); ++i) {
            const std::size_t one = std::size_t(aggregate_[i]);
            const double share = m_[i] * m_[i] * power_of_two(2 * (e_[i] - to.exponent[one]));
            const double inverse = 1 / m_[i];
            double excess = 4;
            for (std::size_t k = 0; k < 4; ++k) {
                const double weight = beside_over(i, k) * inverse;
                excess -= weight;
                if (slot_[4 * i + k] >= 0) to.weight[std::size_t(slot_[4 * i + k])] += share * weight;
            }
            to.excess[one] += share * excess;
            worst = std::max(worst, 0.25 * std::abs(excess));
        }
        return worst;
    }
    void spread() {
        for (std::size_t i = 1; i < cells_.size(); ++i)
            correct(m_[i], levels_[0].factor[std::size_t(aggregate_[i])]);
    }

    // ---- factors

    // A factor that is the same for all of an aggregate corrects too little (Braess 1995); measured in rooms,
    // corridors and scattered cells, twice as much asks for the fewest cycles.
    static void correct(double& value, double factor) {
        if (std::abs(factor - 1) < 0.3) factor = 1 + 1.9 * (factor - 1);
        value = std::max(value * factor, least_factor);
    }
    static void clear(FactorLevel& level) {
        std::fill(level.weight.begin(), level.weight.end(), 0);
        std::fill(level.excess.begin(), level.excess.end(), 0);
        std::fill(level.factor.begin(), level.factor.end(), 1);
    }
    // The greatest exponent of each aggregate.
    static void raise(std::vector<std::int32_t>& to, const std::vector<std::int32_t>& from,
                      const std::vector<std::int32_t>& aggregate) {
        std::fill(to.begin(), to.end(), std::numeric_limits<std::int32_t>::min());
        for (std::size_t i = 0; i < aggregate.size(); ++i)
            to[std::size_t(aggregate[i])] = std::max(to[std::size_t(aggregate[i])], from[i]);
    }
    static void relax_row(FactorLevel& level, std::size_t i) {
        double sum = 0, weights = 0;
        for (std::int32_t p = level.begin[i]; p < level.begin[i + 1]; ++p) {
            sum += level.weight[std::size_t(p)] * level.factor[std::size_t(level.column[std::size_t(p)])];
            weights += level.weight[std::size_t(p)];
        }
        if (weights > 0)
            level.factor[i] = std::clamp(sum / std::max(weights + level.excess[i], 0.1 * weights),
                                         least_factor, most_factor);
    }
    static void relax(FactorLevel& level, int times) {
        for (int k = 0; k < times; ++k) {
            for (std::size_t i = 1; i < level.begin.size() - 1; ++i) relax_row(level, i);
            for (std::size_t i = level.begin.size() - 1; --i > 0;) relax_row(level, i);
        }
    }
    static void gather(const FactorLevel& from, FactorLevel& to) {
        clear(to);
        std::vector<std::int32_t> scale(from.exponent);
        for (std::size_t i = 1; i < scale.size(); ++i) scale[i] += std::ilogb(from.factor[i]);
        raise(to.exponent, scale, from.aggregate);
        for (std::size_t i = 1; i < from.begin.size() - 1; ++i) {
            const std::size_t one = std::size_t(from.aggregate[i]);
            const double near = from.factor[i] * power_of_two(from.exponent[i] - scale[i]);
            const double share = near * near * power_of_two(2 * (scale[i] - to.exponent[one]));
            double excess = from.excess[i];
            for (std::int32_t p = from.begin[i]; p < from.begin[i + 1]; ++p) {
                const double raw = from.weight[std::size_t(p)];
                const double weight =
                    raw * from.factor[std::size_t(from.column[std::size_t(p)])] / from.factor[i];
                excess += raw - weight;
                if (from.slot[std::size_t(p)] >= 0)
                    to.weight[std::size_t(from.slot[std::size_t(p)])] += share * weight;
            }
            to.excess[one] += share * excess;
        }
    }
    void cycle(std::size_t k) {
        FactorLevel& level = levels_[k];
        if (k + 1 == levels_.size()) return relax(level, 40);
        relax(level, 1);
        for (int turn = 0; turn < 2; ++turn) {
            gather(level, levels_[k + 1]);
            cycle(k + 1);
            for (std::size_t i = 1; i < level.begin.size() - 1; ++i)
                correct(level.factor[i], levels_[k + 1].factor[std::size_t(level.aggregate[i])]);
            relax(level, 1);
        }
    }
};

}  // namespace cspace::navigation
