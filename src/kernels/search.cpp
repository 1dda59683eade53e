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

}  // namespace cspace::search::inline CSPACE_ISA
