#pragma once
#include "cspace/localization/particles/beam_scores.hpp"
#include "cspace/localization/particles/cell_rows.hpp"
#include "cspace/localization/particles/move.hpp"
#include "dispatch.hpp"

// See cspace/localization/particles/.
CSPACE_NARROW_KERNEL(cspace::localization, void, move_particles,
                     (const MotionStep& step, std::uint64_t first, int count, double* x, double* y,
                      Heading* headings))
CSPACE_NARROW_KERNEL(cspace::localization, void, score_particles,
                     (const ScoreCells& map, const double* x, const double* y, const Heading* headings,
                      int count, const float* beam_x, const float* beam_y, int beams, std::int32_t* sums))
CSPACE_NARROW_KERNEL(cspace::localization, void, add_bytes,
                     (const std::uint8_t* from, std::ptrdiff_t from_stride, std::uint16_t* to,
                      std::ptrdiff_t to_stride, int rows, int chunks, int outside))
CSPACE_NARROW_KERNEL(cspace::localization, void, mix_rows,
                     (const double* const* rows, const double* weights, int taps, double* to,
                      std::ptrdiff_t count))
CSPACE_NARROW_KERNEL(cspace::localization, double, weigh_cells,
                     (const CellWeights& weights, const double* from, const std::int32_t* sums, double* to,
                      std::ptrdiff_t count))
CSPACE_NARROW_KERNEL(cspace::localization, void, scale_cells,
                     (double factor, double least, double* numbers, std::ptrdiff_t count))
CSPACE_NARROW_KERNEL(cspace::localization, double, sum_cells, (const double* numbers, std::ptrdiff_t count))
