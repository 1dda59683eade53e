#pragma once
#include <cstdint>

#include "dispatch.hpp"

// See cspace/localization/scans/window_sums.hpp.
CSPACE_NARROW_KERNEL(cspace::localization, int, sum_score_windows,
                     (const std::uint8_t* scores, const std::int32_t* at, int beams, int stride, int rows,
                      int columns, std::uint16_t* sums))
