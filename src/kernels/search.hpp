#pragma once
#include "cspace/search/nearest_row.hpp"
#include "dispatch.hpp"

// See cspace/search/nearest_row.hpp.
CSPACE_NARROW_KERNEL(cspace::search, cspace::search::NearRow, find_nearest,
                     (const float* blocks, int count, int width, const float* q, const unsigned char* wraps))
CSPACE_NARROW_KERNEL(cspace::search, cspace::search::NearRow, find_nearest_within,
                     (const float* blocks, const float* costs, int count, int width, const float* q,
                      const unsigned char* wraps, float bound))
CSPACE_NARROW_KERNEL(cspace::search, int, find_nearest_rows,
                     (const float* blocks, int count, int width, const float* q, const unsigned char* wraps,
                      int most, cspace::search::NearRow* found))
