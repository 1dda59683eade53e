#include "localization_particles.hpp"

namespace cspace::localization::inline CSPACE_ISA {

void move_particles(const MotionStep& step, std::uint64_t first, int count, double* x, double* y,
                    Heading* headings) {
    move_particles_by(step, first, count, x, y, headings);
}

void score_particles(const ScoreCells& map, const double* x, const double* y, const Heading* headings,
                     int count, const float* beam_x, const float* beam_y, int beams, std::int32_t* sums) {
    sum_beam_scores(map, x, y, headings, count, beam_x, beam_y, beams, sums);
}

}  // namespace cspace::localization::inline CSPACE_ISA
