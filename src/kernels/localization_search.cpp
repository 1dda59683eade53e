#include "localization_search.hpp"

namespace cspace::localization::inline CSPACE_ISA {

void sum_block_scores(const BeamRows* beams, int count, const PlaneRows& planes, int rows, int columns,
                      std::uint16_t* sums) {
    sum_blocks(beams, count, planes, rows, columns, sums);
}

void sum_cell_scores(const std::uint8_t* scores, const std::int64_t* at, int beams, std::int64_t stride,
                     std::uint16_t* sums) {
    sum_cells(scores, at, beams, stride, sums);
}

}  // namespace cspace::localization::inline CSPACE_ISA
