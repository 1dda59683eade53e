// The nearest rows among leaves of rows: see row_leaves.hpp, which makes them.
#pragma once

#include <cstdint>

#include "cspace/search/nearest_row.hpp"

namespace cspace::search {

// blocks: of eight rows each, coordinate by coordinate; numbers: of the rows. boxes: per eight leaves and
// coordinate eight lower bounds, then eight upper ones. The leaves are a multiple of eight.
struct LeafView {
    static constexpr int leaf_rows = 64;
    const float* blocks;
    const std::int32_t* numbers;
    const float* boxes;
    int leaves;
};

}  // namespace cspace::search

namespace cspace::search::inline CSPACE_ISA {

// Numbers not above the squares of the distances of any row in eight leaves: every operation is monotonic, so
// this holds to the last bit.
template <bool any_wraps>
CSPACE_INLINE Floats bound_leaf_distances(const float* boxes, int width, const float* q,
                                          const unsigned char* wraps) {
    constexpr float turn = float(2 * pi);
    const Floats zero = fill_floats(0.0f);
    Floats sum = zero;
    for (int k = 0; k < width; ++k, boxes += 2 * float_lanes) {
        const Floats below = load_floats(boxes) - q[k], above = load_floats(boxes + float_lanes) - q[k];
        Floats d = max(max(below, zero - above), zero);
        if (any_wraps && wraps[k]) d = min(d, max(turn - max(abs(below), abs(above)), zero));
        sum = sum + d * d;
    }
    return sum;
}

// A list of the nearest rows, the nearest first; of equally near ones that with the least number.
struct NearList {
    NearRow* found;
    int count, most;

    float worst() const { return count < most ? 3e38f : found[most - 1].square; }
    void offer(int row, float square) {
        if (count == most && !is_before({row, square}, found[most - 1])) return;
        int at = count < most ? count++ : most - 1;
        for (; at > 0 && is_before({row, square}, found[at - 1]); --at) found[at] = found[at - 1];
        found[at] = {row, square};
    }
    static bool is_before(const NearRow& a, const NearRow& b) {
        return a.square < b.square || (a.square == b.square && a.row < b.row);
    }
};

template <bool any_wraps>
inline void search_leaf(const LeafView& view, int leaf, int width, const float* q, const unsigned char* wraps,
                        NearList& list) {
    const float* block = view.blocks + std::int64_t(leaf) * LeafView::leaf_rows * width;
    const std::int32_t* numbers = view.numbers + std::int64_t(leaf) * LeafView::leaf_rows;
    for (int first = 0; first < LeafView::leaf_rows; first += float_lanes, block += float_lanes * width) {
        const Floats sum = square_distances<any_wraps>(block, width, q, wraps);
        const unsigned beyond = bits_of(sum > fill_floats(list.worst()));
        if (beyond == (1u << float_lanes) - 1) continue;
        alignas(32) float squares[float_lanes];
        store_floats(squares, sum);
        for (int i = 0; i < float_lanes; ++i)
            if (!(beyond >> i & 1)) list.offer(numbers[first + i], squares[i]);
    }
}

// Adds to the `count` rows found elsewhere, the nearest first, until there are `most`; returns how many there
// are. bounds: room for a number per leaf.
template <bool any_wraps>
inline int find_nearest_in_leaves(const LeafView& view, int width, const float* q, const unsigned char* wraps,
                                  int most, float* bounds, NearRow* found, int count) {
    NearList list = {found, count, most};
    Floats least = fill_floats(3e38f), at = fill_floats(0.0f);
    const float* boxes = view.boxes;
    for (int leaf = 0; leaf < view.leaves; leaf += float_lanes, boxes += 2 * float_lanes * width) {
        const Floats bound = bound_leaf_distances<any_wraps>(boxes, width, q, wraps);
        store_floats(bounds + leaf, bound);
        const FloatMask is_less = bound < least;
        least = select_lanes(is_less, bound, least);
        at = select_lanes(is_less, fill_floats(float(leaf / float_lanes)), at);
    }
    if (view.leaves == 0) return count;
    const int first = least_of_lanes(least, at).row;
    search_leaf<any_wraps>(view, first, width, q, wraps, list);
    for (int leaf = 0; leaf < view.leaves; leaf += float_lanes) {
        const unsigned beyond = bits_of(load_floats(bounds + leaf) > fill_floats(list.worst()));
        if (beyond == (1u << float_lanes) - 1) continue;
        for (int i = leaf; i < leaf + float_lanes; ++i)
            if (i != first && !(bounds[i] > list.worst()))
                search_leaf<any_wraps>(view, i, width, q, wraps, list);
    }
    return list.count;
}

}  // namespace cspace::search::inline CSPACE_ISA
