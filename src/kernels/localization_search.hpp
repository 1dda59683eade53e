#pragma once
#include "cspace/localization/scans/block_sums.hpp"
#include "dispatch.hpp"

// See cspace/localization/scans/block_sums.hpp.
CSPACE_NARROW_KERNEL(cspace::localization, void, sum_block_scores,
                     (const cspace::localization::BeamRows* beams, int count,
                      const cspace::localization::PlaneRows& planes, int rows, int columns,
                      std::uint16_t* sums))
