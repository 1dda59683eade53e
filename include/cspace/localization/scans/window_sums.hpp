// Sums of bytes over many windows of a grid at once: lanes are neighbouring columns.
//
// The heart of correlative scan matching (Olson 2009): a beam adds one byte to the score of each translation.
// All beams of one angle are summed in registers, four rows at a time.
#pragma once

#include <cstdint>
#include <cstring>

#include "cspace/math/isa.hpp"

namespace cspace::localization {

inline constexpr int window_lanes = 16;
// Beams whose bytes a sum of 16 bits holds.
inline constexpr int most_window_beams = 257;

inline constexpr int padded_columns(int columns) {
    return (columns + window_lanes - 1) / window_lanes * window_lanes;
}

}  // namespace cspace::localization

namespace cspace::localization::inline CSPACE_ISA {

namespace window_sums {

#if CSPACE_VECTOR_EXTENSIONS
typedef std::uint8_t Bytes __attribute__((vector_size(window_lanes)));
typedef std::uint16_t Sums __attribute__((vector_size(2 * window_lanes)));

CSPACE_INLINE void add_bytes(Sums& sums, const std::uint8_t* from) {
    Bytes bytes;
    std::memcpy(&bytes, from, sizeof bytes);
    sums += __builtin_convertvector(bytes, Sums);
}
#else
struct Sums {
    std::uint16_t lanes[window_lanes];
};
CSPACE_INLINE void add_bytes(Sums& sums, const std::uint8_t* from) {
    for (int k = 0; k < window_lanes; ++k) sums.lanes[k] = std::uint16_t(sums.lanes[k] + from[k]);
}
#endif

template <int rows>
CSPACE_INLINE void sum_rows(const std::uint8_t* scores, const std::int32_t* at, int beams, int stride,
                            int width, std::uint16_t* sums) {
    Sums total[rows] = {};
    for (int k = 0; k < beams; ++k) {
        const std::uint8_t* from = scores + at[k];
        for (int row = 0; row < rows; ++row, from += stride) add_bytes(total[row], from);
    }
    for (int row = 0; row < rows; ++row) std::memcpy(sums + row * width, &total[row], sizeof(Sums));
}

}  // namespace window_sums

// sums[row · padded_columns(columns) + column] = Σ scores[at[beam] + row · stride + column] over the beams.
// Columns are summed up to the next multiple of the lanes. Returns the greatest sum of the first columns.
CSPACE_INLINE int sum_windows(const std::uint8_t* scores, const std::int32_t* at, int beams, int stride,
                              int rows, int columns, std::uint16_t* sums) {
    constexpr int block = 4;
    const int width = padded_columns(columns);
    for (int column = 0; column < width; column += window_lanes) {
        int row = 0;
        for (; row + block <= rows; row += block)
            window_sums::sum_rows<block>(scores + row * stride + column, at, beams, stride, width,
                                         sums + row * width + column);
        for (; row < rows; ++row)
            window_sums::sum_rows<1>(scores + row * stride + column, at, beams, stride, width,
                                     sums + row * width + column);
    }
    int greatest = 0;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const int sum = sums[row * width + column];
            greatest = sum > greatest ? sum : greatest;
        }
    }
    return greatest;
}

}  // namespace cspace::localization::inline CSPACE_ISA
