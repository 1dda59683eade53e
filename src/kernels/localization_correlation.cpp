#include "localization_correlation.hpp"

#include "cspace/localization/scans/window_sums.hpp"

namespace cspace::localization::inline CSPACE_ISA {

int sum_score_windows(const std::uint8_t* scores, const std::int32_t* at, int beams, int stride, int rows,
                      int columns, std::uint16_t* sums) {
    return sum_windows(scores, at, beams, stride, rows, columns, sums);
}

}  // namespace cspace::localization::inline CSPACE_ISA
