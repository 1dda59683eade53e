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

void add_bytes(const std::uint8_t* from, std::ptrdiff_t from_stride, std::uint16_t* to,
               std::ptrdiff_t to_stride, int rows, int chunks, int outside) {
    add_byte_rows(from, from_stride, to, to_stride, rows, chunks, outside);
}

void mix_rows(const double* const* rows, const double* weights, int taps, double* to, std::ptrdiff_t count) {
    mix_number_rows(rows, weights, taps, to, count);
}

double weigh_cells(const CellWeights& weights, const double* from, const std::int32_t* sums, double* to,
                   std::ptrdiff_t count) {
    return weigh_number_row(weights, from, sums, to, count);
}

void scale_cells(double factor, double least, double* numbers, std::ptrdiff_t count) {
    scale_number_row(factor, least, numbers, count);
}

double sum_cells(const double* numbers, std::ptrdiff_t count) { return sum_number_row(numbers, count); }

}  // namespace cspace::localization::inline CSPACE_ISA
