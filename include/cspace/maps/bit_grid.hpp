// Which cells of a grid are blocked, one bit per cell, once by rows and once by columns, so that a scan along
// either looks at 64 cells at a time. Around the grid lies a border of blocked cells: no scan leaves it.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cspace/math/interrupts.hpp"

namespace cspace::maps {

// Words of 64 cells: packing bytes into them and turning a block of 64 × 64 bits.

// The bits of up to 64 bytes, bit k set where byte k is not zero.
inline std::uint64_t pack_bytes(const std::uint8_t* bytes, std::size_t count) {
    std::uint64_t word = 0;
    std::size_t k = 0;
    for (; k + 8 <= count; k += 8) {
        std::uint64_t eight = 0;
        for (int i = 0; i < 8; ++i) eight |= std::uint64_t(bytes[k + std::size_t(i)]) << (8 * i);
        constexpr std::uint64_t low = 0x7f7f7f7f7f7f7f7full;
        const std::uint64_t ones = ((((eight & low) + low) | eight) & ~low) >> 7;
        word |= (ones * 0x0102040810204080ull >> 56) << k;
    }
    for (; k < count; ++k) word |= std::uint64_t(bytes[k] != 0) << k;
    return word;
}

// Turns a block about its diagonal: bit j of word i becomes bit i of word j (Warren, Hacker's Delight, 7–3).
inline void transpose_block(std::uint64_t (&block)[64]) {
    std::uint64_t mask = 0x00000000ffffffffull;
    for (unsigned width = 32; width; width >>= 1, mask ^= mask << width)
        for (unsigned k = 0; k < 64; k = ((k | width) + 1) & ~width) {
            const std::uint64_t swapped = ((block[k] >> width) ^ block[k | width]) & mask;
            block[k] ^= swapped << width;
            block[k | width] ^= swapped;
        }
}

struct Cell {
    int row, column;
    friend bool operator==(Cell, Cell) = default;
};

// Lines of bits, all zero, with an unused word before the first and after the last.
class BitLines {
  public:
    BitLines() = default;
    BitLines(int lines, int length)
        : words_((std::size_t(length) + 63) / 64), bits_(words_ * std::size_t(lines) + 2) {}
    std::size_t words() const { return words_; }
    std::uint64_t* line(int k) { return bits_.data() + 1 + words_ * std::size_t(k); }
    const std::uint64_t* line(int k) const { return bits_.data() + 1 + words_ * std::size_t(k); }
    std::size_t bytes() const { return bits_.size() * sizeof(std::uint64_t); }

  private:
    std::size_t words_ = 0;
    std::vector<std::uint64_t> bits_;
};

class BitGrid {
  public:
    // A grid with every cell free.
    BitGrid(int rows, int columns)
        : rows_(rows), columns_(columns), by_row_(rows + 2, columns + 2), by_column_(columns + 2, rows + 2) {
        for (int k : {-1, rows})
            for (int column = -1; column <= columns; ++column) set_bit(by_row_.line(k + 1), column, true);
        for (int row = 0; row < rows; ++row)
            for (int k : {-1, columns}) set_bit(by_row_.line(row + 1), k, true);
        turn();
    }
    // From a byte per cell, row by row; not zero: blocked.
    BitGrid(const std::uint8_t* blocked, int rows, int columns) : BitGrid(rows, columns) {
        InterruptPoll poll(64);
        for (int row = 0; row < rows; ++row) {
            poll.step();
            const std::uint8_t* from = blocked + std::size_t(row) * std::size_t(columns);
            std::uint64_t* line = by_row_.line(row + 1);
            for (int column = 0; column < columns; column += 64) {
                const std::uint64_t word =
                    pack_bytes(from + column, std::size_t(std::min(64, columns - column)));
                line[column / 64] |= word << 1;
                if (word >> 63) line[column / 64 + 1] |= 1;
            }
        }
        turn();
    }

    int rows() const { return rows_; }
    int columns() const { return columns_; }
    bool contains(Cell c) const {
        return c.row >= 0 && c.row < rows_ && c.column >= 0 && c.column < columns_;
    }
    // The border counts: row in [-1, rows], column in [-1, columns].
    bool blocked(int row, int column) const { return bit(by_row_.line(row + 1), column); }
    bool blocked(Cell c) const { return blocked(c.row, c.column); }
    void set(int row, int column, bool blocked) {
        set_bit(by_row_.line(row + 1), column, blocked);
        set_bit(by_column_.line(column + 1), row, blocked);
    }

    // The words of a row, border and all: bit column + 1 is a column's. Of a column likewise.
    const std::uint64_t* row(int k) const { return by_row_.line(k + 1); }
    const std::uint64_t* column(int k) const { return by_column_.line(k + 1); }
    std::size_t row_words() const { return by_row_.words(); }

    // The cell and the eight around it: bit 3 · (1 + rows above it) + 1 + columns right of it, set where
    // blocked.
    unsigned around(int row, int column) const {
        const unsigned at = unsigned(column);
        return three(by_row_.line(row), at) | three(by_row_.line(row + 1), at) << 3 |
               three(by_row_.line(row + 2), at) << 6;
    }
    // A number for each cell, the border's included; those of neighbours in a column differ by stride().
    std::uint32_t number(Cell c) const {
        return std::uint32_t(c.row + 1) * stride() + std::uint32_t(c.column + 1);
    }
    Cell cell(std::uint32_t number) const { return {int(number / stride()) - 1, int(number % stride()) - 1}; }
    std::uint32_t stride() const { return std::uint32_t(columns_) + 2; }
    std::uint32_t numbers() const { return std::uint32_t(rows_ + 2) * stride(); }

    std::size_t count_blocked() const {
        std::size_t count = 0;
        for (int row = 0; row < rows_; ++row)
            for (std::size_t k = 0; k < by_row_.words(); ++k)
                count += std::size_t(std::popcount(by_row_.line(row + 1)[k]));
        return count - 2 * std::size_t(rows_);
    }
    // A byte per cell, row by row: 1 where blocked.
    void unpack(std::uint8_t* into) const {
        InterruptPoll poll(16);
        for (int row = 0; row < rows_; ++row) {
            poll.step();
            for (int column = 0; column < columns_; ++column) *into++ = blocked(row, column);
        }
    }
    std::size_t bytes() const { return by_row_.bytes() + by_column_.bytes(); }

    // Sets the words of a row, border and all, for whoever calls turn() when all are set.
    std::uint64_t* writable_row(int k) { return by_row_.line(k + 1); }
    // Makes the columns from the rows.
    void turn() {
        std::uint64_t block[64];
        InterruptPoll poll(64);
        for (int row = 0; row < rows_ + 2; row += 64)
            for (std::size_t word = 0; word < by_row_.words(); ++word) {
                poll.step();
                const int down = std::min(64, rows_ + 2 - row);
                const int across = std::min(64, columns_ + 2 - int(64 * word));
                for (int k = 0; k < 64; ++k) block[k] = k < down ? by_row_.line(row + k)[word] : 0;
                transpose_block(block);
                for (int k = 0; k < across; ++k) by_column_.line(int(64 * word) + k)[row / 64] = block[k];
            }
    }

  private:
    static bool bit(const std::uint64_t* line, int at) { return line[(at + 1) >> 6] >> ((at + 1) & 63) & 1; }
    static void set_bit(std::uint64_t* line, int at, bool on) {
        const std::uint64_t one = std::uint64_t(1) << ((at + 1) & 63);
        std::uint64_t& word = line[(at + 1) >> 6];
        word = on ? word | one : word & ~one;
    }
    static unsigned three(const std::uint64_t* line, unsigned at) {
        const std::uint64_t* word = line + (at >> 6);
        const unsigned shift = at & 63;
        return unsigned(word[0] >> shift | (word[1] << 1) << (63 - shift)) & 7;
    }

    int rows_, columns_;
    BitLines by_row_, by_column_;
};

}  // namespace cspace::maps
