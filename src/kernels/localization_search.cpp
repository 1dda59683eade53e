#include "localization_search.hpp"

namespace cspace::localization::inline CSPACE_ISA {

void sum_block_scores(const BeamRows* beams, int count, const PlaneRows& planes, int rows, int columns,
                      std::uint16_t* sums) {
    sum_blocks(beams, count, planes, rows, columns, sums);
}

}  // namespace cspace::localization::inline CSPACE_ISA
