// How many corners the outlines of a grid's blocked cells have, in time of its words.
#pragma once

#include <bit>
#include <cstdint>

#include "cspace/maps/bit_grid.hpp"

namespace cspace::maps {

// Points between four cells where an outline turns or two meet; the border is blocked.
inline std::int64_t count_corners(const BitGrid& grid) {
    std::int64_t count = 0;
    for (int row = 0; row <= grid.rows(); ++row) {
        const std::uint64_t *below = grid.row(row - 1), *above = grid.row(row);
        std::uint64_t before_below = 1, before_above = 1;  // left of the border all is blocked
        for (std::size_t k = 0; k < grid.row_words(); ++k) {
            const std::uint64_t b = below[k] << 1 | before_below, a = above[k] << 1 | before_above;
            const std::uint64_t turns_across = (b ^ below[k]) | (a ^ above[k]);
            const std::uint64_t turns_along = (b ^ a) | (below[k] ^ above[k]);
            std::uint64_t corners = turns_across & turns_along;
            const std::size_t columns = std::size_t(grid.columns()) + 2;  // behind the border nothing counts
            if (64 * (k + 1) > columns) corners &= ~std::uint64_t(0) >> (64 * (k + 1) - columns);
            count += std::popcount(corners);
            before_below = below[k] >> 63, before_above = above[k] >> 63;
        }
    }
    return count;
}

}  // namespace cspace::maps
