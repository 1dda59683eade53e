// Scans along a line of bits as BitGrid keeps them (bit column + 1 is a column's), 64 at a time. `word(k)`
// gives the words that are looked at: a line, or what two lines have in common. Somewhere ahead a bit must be
// set; the border of a grid is.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace cspace::maps {

// The first column from one on whose bit is set.
template <class Word>
int first_set(const Word& word, int from) {
    const unsigned at = unsigned(from + 1);
    std::size_t k = at >> 6;
    std::uint64_t set = word(k) & (~std::uint64_t(0) << (at & 63));
    while (!set) set = word(++k);
    return int(64 * k) + std::countr_zero(set) - 1;
}
// The last column up to one whose bit is set.
template <class Word>
int last_set(const Word& word, int from) {
    const unsigned at = unsigned(from + 1);
    std::size_t k = at >> 6;
    std::uint64_t set = word(k) & (~std::uint64_t(0) >> (63 - (at & 63)));
    while (!set) set = word(--k);
    return int(64 * k) + 63 - std::countl_zero(set) - 1;
}

// The first column from one on, in a row of so many, whose bit is clear; their number if there is none.
template <class Word>
int first_clear(const Word& word, int from, int columns) {
    if (from >= columns) return columns;
    const std::size_t last = std::size_t(columns + 1) >> 6;  // the border's word
    const unsigned at = unsigned(from + 1);
    std::size_t k = at >> 6;
    std::uint64_t clear = ~word(k) & (~std::uint64_t(0) << (at & 63));
    while (!clear && k < last) clear = ~word(++k);
    return clear ? std::min(int(64 * k) + std::countr_zero(clear) - 1, columns) : columns;
}

}  // namespace cspace::maps
