// How well the ends of beams fit a map from each particle: the sum of the bytes of their cells.
#pragma once

#include <cstdint>

#include "cspace/localization/particles/heading.hpp"

namespace cspace::localization {

// Bytes by rows with one more cell all around, the score of everything outside.
struct ScoreCells {
    const std::uint8_t* scores;
    int rows, columns, stride;  // without the border; stride = columns + 2
    double x, y;                // the corner of least x and y, of the cells without the border [m]
    double per_metre;           // cells
};

}  // namespace cspace::localization

namespace cspace::localization::inline CSPACE_ISA {

// The cells, rows · stride + column, of points in the plane of the bordered map.
CSPACE_INLINE void store_cells(Floats column, Floats row, int stride, std::int32_t* cells) {
#if CSPACE_VECTOR_EXTENSIONS && defined(__AVX__)
    using Integers = MaskRegister<float_lanes>::Raw;
    const Integers c = __builtin_convertvector(column.v, Integers);
    const Integers found = __builtin_convertvector(row.v, Integers) * stride + c;
    std::memcpy(cells, &found, sizeof found);
#else
    float columns[float_lanes], rows[float_lanes];
    store_floats(columns, column), store_floats(rows, row);
    for (int i = 0; i < float_lanes; ++i)
        cells[i] = std::int32_t(rows[i]) * stride + std::int32_t(columns[i]);
#endif
}

// Of `count` particles, a multiple of eight. beam_x and beam_y: where the beams end, in base [cells].
CSPACE_INLINE void sum_beam_scores(const ScoreCells& map, const double* x, const double* y,
                                   const Heading* headings, int count, const float* beam_x,
                                   const float* beam_y, int beams, std::int32_t* sums) {
    const Floats zero = fill_floats(0.0f);
    const Floats last_column = fill_floats(float(map.columns + 1)),
                 last_row = fill_floats(float(map.rows + 1));
    for (int i = 0; i < count; i += float_lanes) {
        float column[float_lanes], row[float_lanes];
        for (int k = 0; k < float_lanes; ++k) {
            column[k] = float((x[i + k] - map.x) * map.per_metre + 1.0);
            row[k] = float((y[i + k] - map.y) * map.per_metre + 1.0);
        }
        const Floats u = load_floats(column), v = load_floats(row);
        Floats s, c;
        sin_cos_headings(headings + i, s, c);
        std::int32_t cells[float_lanes], sum[float_lanes] = {};
        for (int b = 0; b < beams; ++b) {
            const Floats p = u + (c * beam_x[b] - s * beam_y[b]), q = v + (s * beam_x[b] + c * beam_y[b]);
            store_cells(min(max(p, zero), last_column), min(max(q, zero), last_row), map.stride, cells);
            for (int k = 0; k < float_lanes; ++k) sum[k] += map.scores[cells[k]];
        }
        std::memcpy(sums + i, sum, sizeof sum);
    }
}

}  // namespace cspace::localization::inline CSPACE_ISA
