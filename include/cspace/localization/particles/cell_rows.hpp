// Rows of cells of the histogram filter: sums of scores, and weighted sums of rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "cspace/math/lanes.hpp"

namespace cspace::localization {

inline constexpr int cell_chunk = 16;  // cells that are added at once

// What a cell has by its prior and by the sum of its scores.
struct CellWeights {
    const double* factors;  // by sum, from the least one on
    std::int32_t least;
    double kept;  // share of the prior that stays
    const double *added, *scale;
};

}  // namespace cspace::localization

namespace cspace::localization::inline CSPACE_ISA {

// Adds `rows` rows of `chunks` chunks of bytes to sums, each less `outside`. Sums wrap at 2¹⁶.
CSPACE_INLINE void add_byte_rows(const std::uint8_t* from, std::ptrdiff_t from_stride, std::uint16_t* to,
                                 std::ptrdiff_t to_stride, int rows, int chunks, int outside) {
    const auto less = std::uint16_t(outside);
    for (int row = 0; row < rows; ++row, from += from_stride, to += to_stride)
        for (int c = 0; c < chunks; ++c) {
            const std::uint8_t* bytes = from + c * cell_chunk;
            std::uint16_t* sums = to + c * cell_chunk;
            for (int k = 0; k < cell_chunk; ++k) sums[k] = std::uint16_t(sums[k] + bytes[k] - less);
        }
}

using FourNumbers = Pack<4>;
inline constexpr int number_chunk = 4;

CSPACE_INLINE FourNumbers load_four(const double* from) {
    FourNumbers x;
    std::memcpy(&x, from, sizeof x);
    return x;
}
CSPACE_INLINE void store_four(double* to, const FourNumbers& x) { std::memcpy(to, &x, sizeof x); }

// to = Σ weights[t] · rows[t], of `count` numbers, added in this order.
CSPACE_INLINE void mix_number_rows(const double* const* rows, const double* weights, int taps, double* to,
                                   std::ptrdiff_t count) {
    constexpr int n = number_chunk;
    std::ptrdiff_t i = 0;
    for (; i + 4 * n <= count; i += 4 * n) {
        const double *row = rows[0] + i, weight = weights[0];
        FourNumbers a = weight * load_four(row), b = weight * load_four(row + n),
                    c = weight * load_four(row + 2 * n), d = weight * load_four(row + 3 * n);
        for (int t = 1; t < taps; ++t) {
            const double *other = rows[t] + i, w = weights[t];
            a = a + w * load_four(other);
            b = b + w * load_four(other + n);
            c = c + w * load_four(other + 2 * n);
            d = d + w * load_four(other + 3 * n);
        }
        store_four(to + i, a), store_four(to + i + n, b);
        store_four(to + i + 2 * n, c), store_four(to + i + 3 * n, d);
    }
    for (; i + n <= count; i += n) {
        FourNumbers a = weights[0] * load_four(rows[0] + i);
        for (int t = 1; t < taps; ++t) a = a + weights[t] * load_four(rows[t] + i);
        store_four(to + i, a);
    }
    for (; i < count; ++i) {
        double sum = weights[0] * rows[0][i];
        for (int t = 1; t < taps; ++t) sum += weights[t] * rows[t][i];
        to[i] = sum;
    }
}

// to = (kept · from + added) · factors[sum] · scale, of `count` cells; returns its sum.
CSPACE_INLINE double weigh_number_row(const CellWeights& weights, const double* from,
                                      const std::int32_t* sums, double* to, std::ptrdiff_t count) {
    constexpr int n = number_chunk;
    FourNumbers total = fill_lanes<FourNumbers>(0.0);
    std::ptrdiff_t i = 0;
    for (; i + n <= count; i += n) {
        double factors[n];
        for (int k = 0; k < n; ++k) factors[k] = weights.factors[sums[i + k] - weights.least];
        const FourNumbers prior = weights.kept * load_four(from + i) + load_four(weights.added + i);
        const FourNumbers made = prior * load_four(factors) * load_four(weights.scale + i);
        store_four(to + i, made);
        total = total + made;
    }
    double parts[n];
    store_four(parts, total);
    double sum = (parts[0] + parts[1]) + (parts[2] + parts[3]);
    for (; i < count; ++i) {
        to[i] = (weights.kept * from[i] + weights.added[i]) * weights.factors[sums[i] - weights.least] *
                weights.scale[i];
        sum += to[i];
    }
    return sum;
}

CSPACE_INLINE double sum_number_row(const double* numbers, std::ptrdiff_t count) {
    FourNumbers total = fill_lanes<FourNumbers>(0.0);
    std::ptrdiff_t i = 0;
    for (; i + number_chunk <= count; i += number_chunk) total = total + load_four(numbers + i);
    double parts[number_chunk];
    store_four(parts, total);
    double sum = (parts[0] + parts[1]) + (parts[2] + parts[3]);
    for (; i < count; ++i) sum += numbers[i];
    return sum;
}

// Numbers times a factor; zero where that is less than `least`.
CSPACE_INLINE void scale_number_row(double factor, double least, double* numbers, std::ptrdiff_t count) {
    std::ptrdiff_t i = 0;
    for (; i + number_chunk <= count; i += number_chunk) {
        const FourNumbers x = factor * load_four(numbers + i);
        store_four(numbers + i, select_lanes(x < least, fill_lanes<FourNumbers>(0.0), x));
    }
    for (; i < count; ++i) {
        const double x = factor * numbers[i];
        numbers[i] = x < least ? 0.0 : x;
    }
}

}  // namespace cspace::localization::inline CSPACE_ISA
