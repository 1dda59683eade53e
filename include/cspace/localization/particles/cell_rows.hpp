// Rows of cells of the histogram filter: sums of scores, and weighted sums of rows.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cspace/math/isa.hpp"

namespace cspace::localization {

inline constexpr int cell_chunk = 16;  // cells that are added at once

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

// to = Σ weights[t] · rows[t], of `count` numbers, added in this order.
CSPACE_INLINE void mix_number_rows(const double* const* rows, const double* weights, int taps, double* to,
                                   std::ptrdiff_t count) {
    std::ptrdiff_t i = 0;
    for (; i + cell_chunk <= count; i += cell_chunk) {
        double sum[cell_chunk];
        for (int k = 0; k < cell_chunk; ++k) sum[k] = weights[0] * rows[0][i + k];
        for (int t = 1; t < taps; ++t)
            for (int k = 0; k < cell_chunk; ++k) sum[k] += weights[t] * rows[t][i + k];
        for (int k = 0; k < cell_chunk; ++k) to[i + k] = sum[k];
    }
    for (; i < count; ++i) {
        double sum = weights[0] * rows[0][i];
        for (int t = 1; t < taps; ++t) sum += weights[t] * rows[t][i];
        to[i] = sum;
    }
}

}  // namespace cspace::localization::inline CSPACE_ISA
