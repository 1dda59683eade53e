// Thinning from the walls inwards: cells are taken away in the order of their clearance (Pudney 1998) as long
// as what is left stays joined, at every level of clearance, along sides of cells. So between cells that are
// left the widest way over them is as wide as the widest over all, and from every cell that was taken a way
// leads to one that was left on which the clearance never falls.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/grid/moves.hpp"

namespace cspace::navigation {

namespace thinning {

// Of sets of the eight cells around one, a bit each by direction: how many parts, joined along sides, have a
// cell beside the middle.
constexpr std::array<std::uint8_t, 256> count_parts() {
    std::array<std::uint8_t, 256> count{};
    for (unsigned set = 0; set < 256; ++set)
        for (int d = 0; d < 8; d += 2) {
            if (!(set & bit_of(d))) continue;
            const bool joins_next = (set & bit_of(d + 1)) && (set & bit_of(d + 2));
            if (!joins_next) ++count[set];
        }
    count[255] = 1;  // the ring that never ends
    return count;
}
inline constexpr std::array<std::uint8_t, 256> parts = count_parts();

// The numbers in the order of their keys; equal ones stay as they are.
inline void sort_by_key(std::vector<std::uint32_t>& numbers, const std::vector<std::uint32_t>& keys) {
    constexpr int bits = 11;
    InterruptPoll poll(1 << 13);
    std::uint32_t largest = 0;
    for (const std::uint32_t n : numbers) largest = std::max(largest, keys[n]);
    auto sorted = filled_vector<std::uint32_t>(numbers.size());
    for (int shift = 0; shift == 0 || (shift < 32 && largest >> shift != 0); shift += bits) {
        std::array<std::uint32_t, (1u << bits) + 1> begin{};
        const auto digit = [&](std::uint32_t n) { return keys[n] >> shift & ((1u << bits) - 1); };
        for (const std::uint32_t n : numbers) poll.step(), ++begin[digit(n) + 1];
        for (std::size_t k = 1; k < begin.size(); ++k) begin[k] += begin[k - 1];
        for (const std::uint32_t n : numbers) poll.step(), sorted[begin[digit(n)]++] = n;
        numbers.swap(sorted);
    }
}

}  // namespace thinning

// What became of a cell.
enum class Fate : std::uint8_t { blocked, taken, left, kept };  // kept: not to be taken

class Thinning {
  public:
    // fate: blocked, left or kept, by number of cell; height: the clearance in any unit.
    Thinning(const maps::BitGrid& grid, const std::vector<std::uint32_t>& height, std::vector<Fate>& fate)
        : height_(height),
          fate_(fate),
          up_(filled_vector<std::int8_t>(grid.numbers())),
          offset_(grid.stride()) {}
    // The cell beside one that was taken which is not lower.
    std::uint32_t above(std::uint32_t cell) const { return cell + offset_[up_[cell]]; }

    void run() {
        std::vector<std::uint32_t> waiting;
        InterruptPoll poll(1 << 12);
        for (std::uint32_t n = 0; n < fate_.size(); ++n) {
            poll.step();
            if (fate_[n] == Fate::left) waiting.push_back(n);
        }
        thinning::sort_by_key(waiting, height_);
        for (std::size_t before = waiting.size() + 1; waiting.size() < before;) {
            before = waiting.size();
            std::size_t stay = 0;
            for (const std::uint32_t n : waiting) {
                poll.step();
                if (!take(n)) waiting[stay++] = n;
            }
            waiting.resize(stay);
        }
    }

  private:
    const std::vector<std::uint32_t>& height_;
    std::vector<Fate>& fate_;
    std::vector<std::int8_t> up_;  // the direction to the cell above
    NeighbourOffsets offset_;

    bool take(std::uint32_t cell) {
        unsigned around = 0;
        for (int d = 0; d < 8; ++d)
            if (fate_[cell + offset_[d]] > Fate::taken) around |= bit_of(d);
        if (thinning::parts[around] != 1 || around == 255) return false;
        const std::uint32_t level = height_[cell];
        int best = -1;
        for (unsigned beside = around & 0x55; beside; beside &= beside - 1) {
            const int d = std::countr_zero(beside);
            const std::uint32_t height = height_[cell + offset_[d]];
            if (height >= level) {
                if (best < 0 || height > height_[cell + offset_[best]]) best = d;
            } else if (thinning::parts[not_below(cell, around, height)] > 1)
                return false;
        }
        if (best < 0 || thinning::parts[not_below(cell, around, level)] > 1) return false;
        fate_[cell] = Fate::taken;
        up_[cell] = std::int8_t(best);
        return true;
    }
    unsigned not_below(std::uint32_t cell, unsigned around, std::uint32_t level) const {
        unsigned set = 0;
        for (unsigned rest = around; rest; rest &= rest - 1) {
            const int d = std::countr_zero(rest);
            if (height_[cell + offset_[d]] >= level) set |= bit_of(d);
        }
        return set;
    }
};

}  // namespace cspace::navigation
