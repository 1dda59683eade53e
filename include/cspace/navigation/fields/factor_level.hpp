// Factors that aggregates of cells share, on one level of an aggregation (Horton & Leutenegger 1994): its
// rows, how they are joined into the rows of the next, relaxed, gathered for it and corrected by it.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "cspace/math/interrupts.hpp"

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

namespace factors {

// Of one cycle on one level. A first guess that is too large is mended at once, as all weights are
// positive; one that is too small could have any value.
inline constexpr double least_factor = 1e-60, most_factor = 4;

inline double power_of_two(std::int32_t k) {
    if (k < -1022) return 0;
    return std::bit_cast<double>(std::uint64_t(std::min(k, 1023) + 1023) << 52);
}

template <class EachBeside>
void place_entries(FactorLevel& made, std::int32_t size, const EachBeside& each_beside,
                   const std::vector<std::int32_t>& aggregate, std::vector<std::int32_t>& slot) {
    std::vector<std::pair<std::uint64_t, std::size_t>> entries;
    visit_range(1, std::size_t(size), [&](std::size_t i) {
        each_beside(std::int32_t(i), [&](std::int32_t j, std::size_t p) {
            const std::uint64_t a = std::uint32_t(aggregate[i]), b = std::uint32_t(aggregate[std::size_t(j)]);
            if (a != b) entries.push_back({a << 32 | b, p});
        });
    });
    sort_polled(entries);
    std::fill(slot.begin(), slot.end(), -1);
    made.begin.assign(std::size_t(made.size()) + 1, 0);
    visit_range(0, entries.size(), [&](std::size_t k) {
        if (k == 0 || entries[k].first != entries[k - 1].first) {
            made.column.push_back(std::int32_t(entries[k].first & 0xffffffff));
            ++made.begin[std::size_t(entries[k].first >> 32) + 1];
        }
        slot[entries[k].second] = std::int32_t(made.column.size()) - 1;
    });
    for (std::size_t k = 1; k < made.begin.size(); ++k) made.begin[k] += made.begin[k - 1];
    made.weight.resize(made.column.size());
    made.excess.resize(std::size_t(made.size()));
    made.factor.resize(std::size_t(made.size()));
    made.exponent.resize(std::size_t(made.size()));
    made.slot.resize(made.column.size());
}

template <class EachBeside>
FactorLevel join_level(std::int32_t size, const std::vector<std::int32_t>& row,
                       const std::vector<std::int32_t>& column, const EachBeside& each_beside,
                       std::vector<std::int32_t>& aggregate, std::vector<std::int32_t>& slot) {
    FactorLevel made;
    auto root = filled_vector<std::int32_t>(std::size_t(size));
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](std::int32_t i) {
        while (root[std::size_t(i)] != i) i = root[std::size_t(i)] = root[std::size_t(root[std::size_t(i)])];
        return i;
    };
    visit_range(1, std::size_t(size), [&](std::size_t a) {
        each_beside(std::int32_t(a), [&](std::int32_t j, std::size_t) {
            const std::size_t b = std::size_t(j);
            if (j > 0 && row[a] >> 1 == row[b] >> 1 && column[a] >> 1 == column[b] >> 1) {
                const std::int32_t p = find(std::int32_t(a)), q = find(j);
                root[std::size_t(std::max(p, q))] = std::min(p, q);
            }
        });
    });
    aggregate = filled_vector<std::int32_t>(std::size_t(size));
    visit_range(0, std::size_t(size), [&](std::size_t i) {
        const std::size_t first = std::size_t(find(std::int32_t(i)));
        if (first == i) {
            aggregate[i] = made.size();
            made.block_row.push_back(row[i] >> 1);
            made.block_column.push_back(column[i] >> 1);
        } else {
            aggregate[i] = aggregate[first];
        }
    });
    place_entries(made, size, each_beside, aggregate, slot);
    return made;
}

// A factor that is the same for all of an aggregate corrects too little (Braess 1995); measured in rooms,
// corridors and scattered cells, twice as much needs the fewest cycles.
inline void correct_factor(double& value, double factor) {
    if (std::abs(factor - 1) < 0.3) factor = 1 + 1.9 * (factor - 1);
    value = std::max(value * factor, least_factor);
}
inline void clear_level(FactorLevel& level) {
    std::fill(level.weight.begin(), level.weight.end(), 0);
    std::fill(level.excess.begin(), level.excess.end(), 0);
    std::fill(level.factor.begin(), level.factor.end(), 1);
}
// The greatest exponent of each aggregate.
inline void raise_exponents(std::vector<std::int32_t>& to, const std::vector<std::int32_t>& from,
                            const std::vector<std::int32_t>& aggregate) {
    std::fill(to.begin(), to.end(), std::numeric_limits<std::int32_t>::min());
    for (std::size_t i = 0; i < aggregate.size(); ++i)
        to[std::size_t(aggregate[i])] = std::max(to[std::size_t(aggregate[i])], from[i]);
}
inline void relax_row(FactorLevel& level, std::size_t i) {
    double sum = 0, weights = 0;
    for (std::int32_t p = level.begin[i]; p < level.begin[i + 1]; ++p) {
        sum += level.weight[std::size_t(p)] * level.factor[std::size_t(level.column[std::size_t(p)])];
        weights += level.weight[std::size_t(p)];
    }
    if (weights > 0)
        level.factor[i] =
            std::clamp(sum / std::max(weights + level.excess[i], 0.1 * weights), least_factor, most_factor);
}
inline void relax_level(FactorLevel& level, int times) {
    for (int k = 0; k < times; ++k) {
        const std::size_t last = level.begin.size() - 1;
        visit_range(1, last, [&](std::size_t i) { relax_row(level, i); });
        visit_range(1, last, [&](std::size_t i) { relax_row(level, last - i); });
    }
}
inline void gather_level(const FactorLevel& from, FactorLevel& to) {
    clear_level(to);
    std::vector<std::int32_t> scale(from.exponent);
    visit_range(1, scale.size(), [&](std::size_t i) { scale[i] += std::ilogb(from.factor[i]); });
    raise_exponents(to.exponent, scale, from.aggregate);
    visit_range(1, from.begin.size() - 1, [&](std::size_t i) {
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
    });
}

}  // namespace factors
}  // namespace cspace::navigation
