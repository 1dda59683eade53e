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

// The squares of the distances of eight rows.
template <bool any_wraps>
CSPACE_INLINE Floats square_distances(const float* block, int width, const float* q,
                                      const unsigned char* wraps) {
    constexpr float turn = float(2 * pi);
    Floats sum = fill_floats(0.0f);
    for (int k = 0; k < width; ++k) {
        Floats d = load_floats(block + float_lanes * k) - q[k];
        if (any_wraps && wraps[k]) d = abs(d), d = min(d, turn - d);
        sum = sum + d * d;
    }
    return sum;
}

// Of the least square per lane and the block where it is: the row, of equally near ones the first.
inline NearRow least_of_lanes(Floats least, Floats at) {
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

// blocks: of eight rows each, coordinate by coordinate, the last one filled up with copies of one of its
// rows. wraps: per coordinate whether it has the period 2π (all values within one period), or null. Of
// equally near rows the first.
template <bool any_wraps>
inline NearRow find_nearest_row(const float* blocks, int count, int width, const float* q,
                                const unsigned char* wraps) {
    Floats least = fill_floats(3e38f), at = fill_floats(0.0f);
    for (int first = 0; first < count; first += float_lanes, blocks += float_lanes * width) {
        const Floats sum = square_distances<any_wraps>(blocks, width, q, wraps);
        const FloatMask is_less = sum < least;
        least = select_lanes(is_less, sum, least);
        at = select_lanes(is_less, fill_floats(float(first / float_lanes)), at);
    }
    return least_of_lanes(least, at);
}

// The same among rows for which cost + distance is below `bound`; row −1 if there is none. costs: per row,
// filled up beyond any bound.
template <bool any_wraps>
inline NearRow find_nearest_row_within(const float* blocks, const float* costs, int count, int width,
                                       const float* q, const unsigned char* wraps, float bound) {
    constexpr float none = 3e38f;
    Floats least = fill_floats(none), at = fill_floats(0.0f);
    for (int first = 0; first < count; first += float_lanes, blocks += float_lanes * width) {
        const Floats sum = square_distances<any_wraps>(blocks, width, q, wraps);
        const Floats total = sqrt(sum) + load_floats(costs + first);
        const FloatMask is_less = (sum < least) & (total < bound);
        least = select_lanes(is_less, sum, least);
        at = select_lanes(is_less, fill_floats(float(first / float_lanes)), at);
    }
    const NearRow found = least_of_lanes(least, at);
    return found.square < none ? found : NearRow{-1, none};
}

// The `most` nearest rows, the nearest first, of equally near ones the first; returns how many there are.
template <bool any_wraps>
inline int find_nearest_rows(const float* blocks, int count, int width, const float* q,
                             const unsigned char* wraps, int most, NearRow* found) {
    int n = 0;
    float bound = most > 0 ? 3e38f : 0.0f;  // a row must be nearer
    for (int first = 0; first < count; first += float_lanes, blocks += float_lanes * width) {
        const Floats sum = square_distances<any_wraps>(blocks, width, q, wraps);
        if (bits_of(sum < fill_floats(bound)) == 0) continue;
        alignas(32) float squares[float_lanes];
        store_floats(squares, sum);
        for (int i = 0; i < float_lanes && first + i < count; ++i) {
            if (!(squares[i] < bound)) continue;
            int at = n < most ? n++ : most - 1;
            for (; at > 0 && squares[i] < found[at - 1].square; --at) found[at] = found[at - 1];
            found[at] = {first + i, squares[i]};
            if (n == most) bound = found[most - 1].square;
        }
    }
    return n;
}

}  // namespace cspace::search::inline CSPACE_ISA
