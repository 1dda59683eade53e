// A grid whose blocked cells have grown by the radius of a robot, decided in integers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::maps {

namespace inflation {

// Sets every bit within `more` places of a set one, in a line whose bits have grown by `grown` already.
inline void widen_line(std::vector<std::uint64_t>& line, std::vector<std::uint64_t>& spare, int grown,
                       int more) {
    const std::size_t n = line.size();
    while (more > 0) {
        const int shift = std::min({more, grown + 1, 63});  // a longer one would leave gaps
        for (std::size_t k = 0; k < n; ++k) {
            const std::uint64_t up = line[k] << shift | (k > 0 ? line[k - 1] >> (64 - shift) : 0);
            const std::uint64_t down = line[k] >> shift | (k + 1 < n ? line[k + 1] << (64 - shift) : 0);
            spare[k] = line[k] | up | down;
        }
        line.swap(spare);
        grown += shift;
        more -= shift;
    }
}

// How many half cells lie between two cells that are d rows apart, or between a centre and a cell.
inline std::int64_t half_cell_gap(int d, bool from_centers) {
    return std::max(2 * std::int64_t(d) - (from_centers ? 1 : 2), std::int64_t(0));
}

// Half widths by row: how many columns apart two cells may be that lie `row` rows apart and nearer than
// sqrt(limit) half cells; -1 where none is.
inline std::vector<int> list_widths(double limit, bool from_centers, int rows, int columns) {
    std::vector<int> found;
    int width = columns + 1;
    for (int row = 0; row <= rows + 1; ++row) {
        const std::int64_t up = half_cell_gap(row, from_centers);
        const auto is_near = [&](int w) {
            const std::int64_t across = half_cell_gap(w, from_centers);
            return double(up * up + across * across) < limit;
        };
        while (width >= 0 && !is_near(width)) --width;
        if (width < 0) break;
        found.push_back(width);
    }
    return found;
}

}  // namespace inflation

// Blocked are the cells of which some point, or, from_centers, the centre, lies nearer than the radius to a
// blocked cell or to the outside; and those that were blocked before. radius: in cells.
inline BitGrid inflate_grid(const BitGrid& grid, double radius, bool from_centers) {
    BitGrid grown = grid;
    const double square = 4 * radius * radius, whole = std::round(square);
    const double limit = std::abs(square - whole) <= tolerance::cell_border * whole ? whole : square;
    const std::vector<int> widths = inflation::list_widths(limit, from_centers, grid.rows(), grid.columns());
    if (widths.empty()) return grown;
    const std::size_t words = grid.row_words();
    std::vector<std::uint64_t> line(words), spare(words);
    const std::uint64_t within =
        ~std::uint64_t(0) >> (63 - unsigned(grid.columns() + 1) % 64);  // of the last word
    InterruptPoll poll(1);
    for (int row = -1; row <= grid.rows(); ++row) {
        poll.step();
        std::copy_n(grid.row(row), words, line.begin());
        int width = 0;
        for (int apart = int(widths.size()) - 1; apart >= 0; --apart) {
            inflation::widen_line(line, spare, width, widths[std::size_t(apart)] - width);
            width = widths[std::size_t(apart)];
            for (const int target : {row - apart, row + apart}) {
                if (target < 0 || target >= grid.rows()) continue;
                std::uint64_t* into = grown.writable_row(target);
                for (std::size_t k = 0; k < words; ++k) into[k] |= line[k];
                into[words - 1] &= within;
            }
        }
    }
    grown.turn();
    return grown;
}

}  // namespace cspace::maps
