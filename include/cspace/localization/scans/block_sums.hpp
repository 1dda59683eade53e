// Sums of scores over the beams of a scan, for many poses at once. For whole blocks of cells these are upper
// bounds, of scores reduced to five bits, eight at a time in bytes; lanes are neighbouring blocks of a row.
// For the cells of one block lanes are its columns.
#pragma once

#include <cstdint>
#include <cstring>

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

inline constexpr int block_side = 8;         // cells of a block whose poses are scored at once
inline constexpr int most_cell_beams = 257;  // whose scores a sum of 16 bits holds

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

namespace block_sums {

#if CSPACE_VECTOR_EXTENSIONS
typedef std::uint8_t Bytes __attribute__((vector_size(block_side)));
typedef std::uint16_t Sums __attribute__((vector_size(2 * block_side)));

CSPACE_INLINE void add_bytes(Sums& sums, const std::uint8_t* from) {
    Bytes bytes;
    std::memcpy(&bytes, from, sizeof bytes);
    sums += __builtin_convertvector(bytes, Sums);
}
#else
struct Sums {
    std::uint16_t lanes[block_side];
};
CSPACE_INLINE void add_bytes(Sums& sums, const std::uint8_t* from) {
    for (int k = 0; k < block_side; ++k) sums.lanes[k] = std::uint16_t(sums.lanes[k] + from[k]);
}
#endif

}  // namespace block_sums

// sums[row · block_side + column] = Σ scores[at[beam] + row · stride + column] over the beams.
CSPACE_INLINE void sum_cells(const std::uint8_t* scores, const std::int64_t* at, int beams,
                             std::int64_t stride, std::uint16_t* sums) {
    block_sums::Sums total[block_side] = {};
    for (int k = 0; k < beams; ++k) {
        const std::uint8_t* from = scores + at[k];
        for (int row = 0; row < block_side; ++row, from += stride) block_sums::add_bytes(total[row], from);
    }
    std::memcpy(sums, total, sizeof total);
}

}  // namespace cspace::localization::inline CSPACE_ISA
