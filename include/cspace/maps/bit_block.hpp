// Words of 64 cells: packing bytes into them and turning a block of 64 × 64 bits.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cspace::maps {

// The bits of up to 64 bytes, bit k set where byte k is not zero.
inline std::uint64_t packed(const std::uint8_t* bytes, std::size_t count) {
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
inline void transpose(std::uint64_t (&block)[64]) {
    std::uint64_t mask = 0x00000000ffffffffull;
    for (unsigned width = 32; width; width >>= 1, mask ^= mask << width)
        for (unsigned k = 0; k < 64; k = ((k | width) + 1) & ~width) {
            const std::uint64_t swapped = ((block[k] >> width) ^ block[k | width]) & mask;
            block[k] ^= swapped << width;
            block[k | width] ^= swapped;
        }
}

}  // namespace cspace::maps
