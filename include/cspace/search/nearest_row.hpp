// The nearest of many rows of floats, by comparing eight at a time.
#pragma once

#include "cspace/math/float_lanes.hpp"
#include "cspace/math/trig.hpp"

namespace cspace::search {

// The number of a row, and the square of its distance.
struct NearRow {
    int row;
    float square;
};

}  // namespace cspace::search

namespace cspace::search::inline CSPACE_ISA {

// blocks: of eight rows each, coordinate by coordinate, the last one filled up with copies of one of its
// rows. wraps: per coordinate whether it has the period 2π (all values within one period), or null. Of
// equally near rows the first.
template <bool any_wraps>
inline NearRow find_nearest_row(const float* blocks, int count, int width, const float* q,
                                const unsigned char* wraps) {
    constexpr float turn = float(2 * pi);
    Floats least = fill_floats(3e38f), at = fill_floats(0.0f);
    for (int first = 0; first < count; first += float_lanes, blocks += float_lanes * width) {
        Floats sum = fill_floats(0.0f);
        for (int k = 0; k < width; ++k) {
            Floats d = load_floats(blocks + float_lanes * k) - q[k];
            if (any_wraps && wraps[k]) d = abs(d), d = min(d, turn - d);
            sum = sum + d * d;
        }
        const FloatMask is_less = sum < least;
        least = select(is_less, sum, least);
        at = select(is_less, fill_floats(float(first / float_lanes)), at);
    }
    // Squares are not negative: their order is that of their bits.
    alignas(32) float squares[float_lanes], places[float_lanes];
    store_floats(squares, least), store_floats(places, at);
    std::uint64_t best = ~std::uint64_t(0);
    for (int i = 0; i < float_lanes; ++i) {
        const std::uint32_t row = std::uint32_t(int(places[i]) * float_lanes + i);
        const std::uint64_t key = std::uint64_t(bits_as<std::uint32_t>(squares[i])) << 32 | row;
        best = key < best ? key : best;
    }
    return {int(best & 0xffffffffu), bits_as<float>(std::uint32_t(best >> 32))};
}

}  // namespace cspace::search::inline CSPACE_ISA
