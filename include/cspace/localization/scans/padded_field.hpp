// The part of a field that a scan can reach, with margins, so that no window leaves it; and the same pooled:
// the greatest score that any translation of a block of 4 × 4 meets, for bounds of whole blocks.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "cspace/maps/byte_field.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/plane.hpp"

namespace cspace::localization {

struct PaddedField {
    static constexpr int block = 4;  // cells of a side that are pooled
    static constexpr int grain = 2;  // cells: pooled scores serve all windows that begin within it
    static constexpr std::size_t pooled_side = block + grain - 1;
    static constexpr std::size_t beyond = 64;  // bytes that lanes may read behind the last window

    double resolution = 1;
    Point origin;  // of cell (0, 0) of the padded bytes
    int rows = 0, stride = 0;
    int last_row = 0, last_column = 0;  // of windows
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint8_t> pooled;  // by place in the block, then by block

    // The cells within `reach` of a center. Windows of so many rows and columns, multiples of a block, may
    // begin at any cell up to the last ones.
    void copy_part(const maps::ByteField& field, Point center, double reach, int window_rows,
                   int window_columns) {
        resolution = field.frame.resolution;
        const auto first = [&](double at, int count) {
            return int(std::clamp(std::floor(at / resolution), 0.0, double(count)));
        };
        const Point low = center - field.frame.origin - Point{reach, reach};
        const Point high = center - field.frame.origin + Point{reach + resolution, reach + resolution};
        const int left = first(low.x, field.columns), right = first(high.x, field.columns);
        const int bottom = first(low.y, field.rows), top = first(high.y, field.rows);
        const double most = double(std::numeric_limits<std::int32_t>::max());  // places are 32 bits wide
        if (!((top - bottom + 2.0 * window_rows + block) * (right - left + 2.0 * window_columns + block) <
              most))
            throw std::length_error("the part of the field is too large");
        last_row = top - bottom + window_rows, last_column = right - left + window_columns;
        rows = round_up(last_row + window_rows), stride = round_up(last_column + window_columns);
        origin = {field.frame.origin.x + (left - window_columns) * resolution,
                  field.frame.origin.y + (bottom - window_rows) * resolution};
        bytes.assign(std::size_t(rows) * std::size_t(stride) + beyond, field.outside);
        for (int row = bottom; row < top; ++row) {
            const std::uint8_t* from =
                field.scores.data() + std::size_t(row) * std::size_t(field.columns) + std::size_t(left);
            std::copy_n(from, right - left,
                        bytes.data() + std::size_t(row - bottom + window_rows) * std::size_t(stride) +
                            std::size_t(window_columns));
        }
        poll_interrupts();
    }

    int pooled_stride() const { return stride / block; }
    // Where the pooled scores of a window that begins at a cell begin.
    std::int32_t pooled_at(int row, int column) const {
        const int place = row % block / grain * (block / grain) + column % block / grain;
        return (place * (rows / block) + row / block) * pooled_stride() + column / block;
    }
    void pool_blocks() {
        const auto width = std::size_t(stride), height = std::size_t(rows);
        pooled.resize(width * height / (grain * grain) + beyond);
        column_.resize(width), row_.resize(width);
        InterruptPoll poll(1 << 6);
        for (std::size_t row = 0; row < height; row += grain) {
            pool_rows(row, column_.data());
            pool_columns(column_.data(), row_.data());
            for (int first = 0; first < block; first += grain) {
                std::uint8_t* const to = pooled.data() + pooled_at(int(row), first);
                const std::uint8_t* const from = row_.data() + first;
                for (std::size_t k = 0; k < width / block; ++k) to[k] = from[k * block];
            }
            poll.step();
        }
    }

  private:
    static int round_up(int count) { return (count + block - 1) / block * block; }
    // The greatest of the cells that windows of a block reach which begin at a row, or at the next one of the
    // grain.
    void pool_rows(std::size_t row, std::uint8_t* to) const {
        const auto width = std::size_t(stride);
        const std::size_t last = std::min(row + pooled_side, std::size_t(rows));
        std::copy_n(bytes.data() + row * width, width, to);
        for (++row; row < last; ++row) {
            const std::uint8_t* const from = bytes.data() + row * width;
            for (std::size_t k = 0; k < width; ++k) to[k] = std::max(to[k], from[k]);
        }
    }
    void pool_columns(const std::uint8_t* from, std::uint8_t* to) const {
        static_assert(pooled_side == 5);
        const std::size_t width = std::size_t(stride), whole = width - pooled_side + 1;
        for (std::size_t k = 0; k < whole; ++k)
            to[k] = std::max(std::max(std::max(from[k], from[k + 1]), std::max(from[k + 2], from[k + 3])),
                             from[k + 4]);
        for (std::size_t k = whole; k < width; ++k) to[k] = *std::max_element(from + k, from + width);
    }

    std::vector<std::uint8_t> column_, row_;
};

}  // namespace cspace::localization
