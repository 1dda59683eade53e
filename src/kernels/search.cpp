#include "search.hpp"

namespace cspace::search::inline CSPACE_ISA {

NearRow find_nearest(const float* blocks, int count, int width, const float* q, const unsigned char* wraps) {
    return wraps ? find_nearest_row<true>(blocks, count, width, q, wraps)
                 : find_nearest_row<false>(blocks, count, width, q, wraps);
}

NearRow find_nearest_within(const float* blocks, const float* costs, int count, int width, const float* q,
                            const unsigned char* wraps, float bound) {
    return wraps ? find_nearest_row_within<true>(blocks, costs, count, width, q, wraps, bound)
                 : find_nearest_row_within<false>(blocks, costs, count, width, q, wraps, bound);
}

int find_nearest_rows(const float* blocks, int count, int width, const float* q, const unsigned char* wraps,
                      int most, NearRow* found) {
    return wraps ? find_nearest_rows<true>(blocks, count, width, q, wraps, most, found)
                 : find_nearest_rows<false>(blocks, count, width, q, wraps, most, found);
}

int find_nearest_in_leaves(const LeafView& view, int width, const float* q, const unsigned char* wraps,
                           int most, float* bounds, NearRow* found, int count) {
    return wraps ? find_nearest_in_leaves<true>(view, width, q, wraps, most, bounds, found, count)
                 : find_nearest_in_leaves<false>(view, width, q, wraps, most, bounds, found, count);
}

}  // namespace cspace::search::inline CSPACE_ISA
