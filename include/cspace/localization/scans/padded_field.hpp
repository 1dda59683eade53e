// The part of a field that a scan can reach, with margins, so that no window leaves it; and the same pooled: the
// greatest score of each block of 4 × 4 cells, for bounds of whole blocks of translations.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cspace/maps/byte_field.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/plane.hpp"

namespace cspace::localization {

struct PaddedField {
    static constexpr int block = 4;  // cells of a side that are pooled

    double resolution = 1;
    Point origin;  // of cell (0, 0) of the padded bytes
    int rows = 0, stride = 0;
    int last_row = 0, last_column = 0;  // of windows
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint8_t> pooled;  // by place in the block, then by block

    // The cells within `reach` of a center. Windows of so many rows and columns, multiples of a block, may begin at any cell up
    // to the last ones.
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
        last_row = top - bottom + window_rows, last_column = right - left + window_columns;
        rows = round_up(last_row + window_rows), stride = round_up(last_column + window_columns);
        origin = {field.frame.origin.x + (left - window_columns) * resolution,
                  field.frame.origin.y + (bottom - window_rows) * resolution};
        bytes.assign(std::size_t(rows) * std::size_t(stride), field.outside);
        for (int row = bottom; row < top; ++row) {
            const std::uint8_t* from = field.scores.data() +
                                       std::size_t(row) * std::size_t(field.columns) + std::size_t(left);
            std::copy_n(from, right - left,
                        bytes.data() + std::size_t(row - bottom + window_rows) * std::size_t(stride) +
                            std::size_t(window_columns));
        }
        poll_interrupts();
    }

    int pooled_stride() const { return stride / block; }
    // Where the pooled scores of a window that begins at a cell begin.
    std::int32_t pooled_at(int row, int column) const {
        const int place = row % block * block + column % block;
        return (place * (rows / block) + row / block) * pooled_stride() + column / block;
    }
    void pool_blocks() {
        const auto width = std::size_t(stride), height = std::size_t(rows);
        across_.resize(bytes.size()), pooled.resize(bytes.size());
        InterruptPoll poll(1 << 6);
        for (std::size_t row = 0; row < height; ++row) {
            pool_row(bytes.data() + row * width, 1, across_.data() + row * width, width);
            poll.step();
        }
        row_.resize(width);
        for (std::size_t row = 0; row < height; ++row) {
            const std::uint8_t* const from = across_.data() + row * width;
            if (row + block <= height)
                for (std::size_t k = 0; k < width; ++k)
                    row_[k] = std::max(std::max(from[k], from[k + width]),
                                       std::max(from[k + 2 * width], from[k + 3 * width]));
            else
                std::copy_n(from, width, row_.data());
            for (int place = 0; place < block; ++place) {
                std::uint8_t* const to = pooled.data() + pooled_at(int(row), place);
                for (std::size_t k = 0; k < width / block; ++k) to[k] = row_[k * block + std::size_t(place)];
            }
            poll.step();
        }
    }

  private:
    static int round_up(int count) { return (count + block - 1) / block * block; }
    static void pool_row(const std::uint8_t* from, std::size_t step, std::uint8_t* to, std::size_t count) {
        const std::size_t whole = count >= block ? count - block + 1 : 0;
        for (std::size_t k = 0; k < whole; ++k)
            to[k] = std::max(std::max(from[k], from[k + step]),
                             std::max(from[k + 2 * step], from[k + 3 * step]));
        for (std::size_t k = whole; k < count; ++k) to[k] = from[k];
    }

    std::vector<std::uint8_t> across_, row_;
};

}  // namespace cspace::localization
