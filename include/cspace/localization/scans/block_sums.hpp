// Upper bounds for whole blocks of cells: sums over the beams of a scan of scores that were reduced to five
// bits, eight at a time in bytes. Lanes are neighbouring blocks of a row.
#pragma once

#include <cstdint>

#include "cspace/math/isa.hpp"

namespace cspace::localization {

inline constexpr int block_lanes = 32;  // columns that are summed at once
inline constexpr int most_block_score = 31;
inline constexpr int beams_at_once = 8;  // whose scores a byte can sum

// The scores that one beam finds for the blocks of a heading: row r of blocks reads row r + shift of a plane,
// or one in which all are outside where the plane has none.
struct BeamRows {
    const std::uint8_t* plane;
    std::int32_t shift;
};
// The rows of the planes that beams read: how many bytes lie between them, and how many there are.
struct PlaneRows {
    std::int64_t stride;
    std::int32_t count;
    const std::uint8_t* outside;
};

}  // namespace cspace::localization

namespace cspace::localization::inline CSPACE_ISA {

// sums[row · columns + column] = Σ over the beams. columns is a multiple of block_lanes, beams one of
// beams_at_once.
CSPACE_INLINE void sum_blocks(const BeamRows* beams, int count, const PlaneRows& planes, int rows,
                              int columns, std::uint16_t* sums) {
    for (int row = 0; row < rows; ++row, sums += columns) {
        for (int k = 0; k < columns; ++k) sums[k] = 0;
        for (int first = 0; first < count; first += beams_at_once) {
            const std::uint8_t* from[beams_at_once];
            for (int k = 0; k < beams_at_once; ++k) {
                const std::int32_t at = row + beams[first + k].shift;
                const bool is_inside = std::uint32_t(at) < std::uint32_t(planes.count);
                from[k] = is_inside ? beams[first + k].plane + at * planes.stride : planes.outside;
            }
            const std::uint8_t *a = from[0], *b = from[1], *c = from[2], *d = from[3];
            const std::uint8_t *e = from[4], *f = from[5], *g = from[6], *h = from[7];
            for (int k = 0; k < columns; k += block_lanes) {
                std::uint8_t part[block_lanes];
                for (int i = 0; i < block_lanes; ++i)
                    part[i] = std::uint8_t(a[k + i] + b[k + i] + c[k + i] + d[k + i] + e[k + i] + f[k + i] +
                                           g[k + i] + h[k + i]);
                for (int i = 0; i < block_lanes; ++i) sums[k + i] = std::uint16_t(sums[k + i] + part[i]);
            }
        }
    }
}

}  // namespace cspace::localization::inline CSPACE_ISA
