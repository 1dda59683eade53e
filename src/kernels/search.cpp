#include "search.hpp"

namespace cspace::search::inline CSPACE_ISA {

NearRow find_nearest(const float* blocks, int count, int width, const float* q, const unsigned char* wraps) {
    return wraps ? find_nearest_row<true>(blocks, count, width, q, wraps)
                 : find_nearest_row<false>(blocks, count, width, q, wraps);
}

}  // namespace cspace::search::inline CSPACE_ISA
