// Packs of floats for kernels over V: as many as a register takes, with the operations of lanes.hpp, rows.hpp
// and trig.hpp that dynamics needs. Unlike in float_lanes.hpp products and sums may be fused.
#pragma once

#include <cstddef>

#include "cspace/math/float_trig.hpp"
#include "cspace/math/lanes.hpp"

namespace cspace {

template <int N>
struct Lanes<FloatRegister<N>> {
    static constexpr int count = N;
    using scalar = float;
    using mask = MaskRegister<N>;
};

// The largest angle of which floats have a sine [rad]; see float_trig.hpp.
inline constexpr float largest_float_angle = 1e4f;

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

inline constexpr int float_register_lanes = CSPACE_VECTOR_EXTENSIONS ? 2 * register_lanes : 4;
using FloatPack = FloatRegister<float_register_lanes>;

#define CSPACE_WITH_SCALAR(Result, op)                                 \
    template <int N>                                                   \
    CSPACE_INLINE Result<N> operator op(FloatRegister<N> a, float b) { \
        return a op fill_lanes<FloatRegister<N>>(b);                   \
    }                                                                  \
    template <int N>                                                   \
    CSPACE_INLINE Result<N> operator op(float a, FloatRegister<N> b) { \
        return fill_lanes<FloatRegister<N>>(a) op b;                   \
    }
CSPACE_WITH_SCALAR(FloatRegister, +)
CSPACE_WITH_SCALAR(FloatRegister, -)
CSPACE_WITH_SCALAR(FloatRegister, *)
CSPACE_WITH_SCALAR(FloatRegister, /)
CSPACE_WITH_SCALAR(MaskRegister, <)
CSPACE_WITH_SCALAR(MaskRegister, >)
#undef CSPACE_WITH_SCALAR

template <int N>
CSPACE_INLINE FloatRegister<N> operator-(FloatRegister<N> a) {
#if CSPACE_VECTOR_EXTENSIONS
    return {-a.v};
#else
    for (int i = 0; i < N; ++i) a.v[i] = -a.v[i];
    return a;
#endif
}
template <int N>
CSPACE_INLINE FloatRegister<N> mul_add(FloatRegister<N> a, FloatRegister<N> b, FloatRegister<N> c) {
    return a * b + c;
}
template <int N>
CSPACE_INLINE MaskRegister<N> operator&&(MaskRegister<N> a, MaskRegister<N> b) {
    return a & b;
}
template <int N>
CSPACE_INLINE MaskRegister<N> operator==(FloatRegister<N> a, float b) {
    MaskRegister<N> r;
#if CSPACE_VECTOR_EXTENSIONS
    r.m = typename MaskRegister<N>::Raw(a.v == fill_lanes<FloatRegister<N>>(b).v);
#else
    for (int i = 0; i < N; ++i) r.m[i] = -std::int32_t(a.v[i] == b);
#endif
    return r;
}
template <int N>
CSPACE_INLINE bool all(MaskRegister<N> m) {
#if defined(CSPACE_X86_REGISTERS) && defined(__AVX512F__)
    if constexpr (N == 16) return _mm512_movepi32_mask((__m512i)m.m) == 0xffff;
#endif
    std::int32_t both = -1;
    for (int i = 0; i < N; ++i) both &= m.m[i];
    return both != 0;
}
template <int N>
CSPACE_INLINE void sincos(FloatRegister<N> x, FloatRegister<N>& s, FloatRegister<N>& c) {
    sin_cos(x, s, c);
}

// --- rows: see rows.hpp ------------------------------------------------------------------------------------
#if defined(CSPACE_X86_REGISTERS)
#if defined(__AVX512F__)
#define CSPACE_FLOATS(name) _mm512_##name##_ps
#elif defined(__AVX__)
#define CSPACE_FLOATS(name) _mm256_##name##_ps
#else
#define CSPACE_FLOATS(name) _mm_##name##_ps
#endif
// Four neighbouring numbers of a row, of every fourth row.
CSPACE_INLINE FloatPack load_every_fourth(const float* row, std::size_t step) {
#if defined(__AVX512F__)
    __m512 r = _mm512_castps128_ps512(_mm_loadu_ps(row));
    r = _mm512_insertf32x4(r, _mm_loadu_ps(row + step), 1);
    r = _mm512_insertf32x4(r, _mm_loadu_ps(row + 2 * step), 2);
    return {_mm512_insertf32x4(r, _mm_loadu_ps(row + 3 * step), 3)};
#elif defined(__AVX__)
    return {_mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(row)), _mm_loadu_ps(row + step), 1)};
#else
    return {_mm_loadu_ps(row + 0 * step)};
#endif
}
CSPACE_INLINE void store_every_fourth(FloatPack x, float* row, std::size_t step) {
#if defined(__AVX512F__)
    _mm_storeu_ps(row, _mm512_castps512_ps128(x.v));
    _mm_storeu_ps(row + step, _mm512_extractf32x4_ps(x.v, 1));
    _mm_storeu_ps(row + 2 * step, _mm512_extractf32x4_ps(x.v, 2));
    _mm_storeu_ps(row + 3 * step, _mm512_extractf32x4_ps(x.v, 3));
#elif defined(__AVX__)
    _mm_storeu_ps(row, _mm256_castps256_ps128(x.v));
    _mm_storeu_ps(row + step, _mm256_extractf128_ps(x.v, 1));
#else
    _mm_storeu_ps(row + 0 * step, x.v);
#endif
}
// Four by four numbers of each 128 bits: rows become columns.
CSPACE_INLINE void exchange_rows_and_columns(FloatPack (&a)[4]) {
    const auto low = CSPACE_FLOATS(unpacklo)(a[0].v, a[1].v), high = CSPACE_FLOATS(unpackhi)(a[0].v, a[1].v);
    const auto low_2 = CSPACE_FLOATS(unpacklo)(a[2].v, a[3].v),
               high_2 = CSPACE_FLOATS(unpackhi)(a[2].v, a[3].v);
    a[0] = {CSPACE_FLOATS(shuffle)(low, low_2, 0x44)};
    a[1] = {CSPACE_FLOATS(shuffle)(low, low_2, 0xee)};
    a[2] = {CSPACE_FLOATS(shuffle)(high, high_2, 0x44)};
    a[3] = {CSPACE_FLOATS(shuffle)(high, high_2, 0xee)};
}
#undef CSPACE_FLOATS
CSPACE_INLINE void load_four_columns(const float* rows, std::size_t stride, FloatPack* values) {
    FloatPack a[4];
    for (std::size_t i = 0; i < 4; ++i) a[i] = load_every_fourth(rows + i * stride, 4 * stride);
    exchange_rows_and_columns(a);
    for (int i = 0; i < 4; ++i) values[i] = a[i];
}
CSPACE_INLINE void store_four_columns(const FloatPack* values, float* rows, std::size_t stride) {
    FloatPack a[4] = {values[0], values[1], values[2], values[3]};
    exchange_rows_and_columns(a);
    for (std::size_t i = 0; i < 4; ++i) store_every_fourth(a[i], rows + i * stride, 4 * stride);
}
inline constexpr bool has_four_columns = true;
#else
CSPACE_INLINE void load_four_columns(const float*, std::size_t, FloatPack*) {}
CSPACE_INLINE void store_four_columns(const FloatPack*, float*, std::size_t) {}
inline constexpr bool has_four_columns = false;
#endif

// Calls four(j) for the columns j to j + 3 of `width`; the last ones may overlap those before.
template <class Four>
CSPACE_INLINE void over_four_columns(int width, const Four& four) {
    for (int j = 0; j < width; j += 4) four(j + 4 <= width ? j : width - 4);
}
CSPACE_INLINE void load_rows(const float* rows, std::size_t stride, int count, int width, FloatPack* values) {
    if (has_four_columns && width >= 4 && count >= float_register_lanes)
        return over_four_columns(width, [&](int j) { load_four_columns(rows + j, stride, values + j); });
    for (int j = 0; j < width; ++j) {
        float column[float_register_lanes];
        for (int k = 0; k < float_register_lanes; ++k)
            column[k] = rows[std::size_t(k < count ? k : count - 1) * stride + std::size_t(j)];
        std::memcpy(&values[j], column, sizeof column);
    }
}
CSPACE_INLINE void store_rows(const FloatPack* values, int width, float* rows, std::size_t stride,
                              int count) {
    if (has_four_columns && width >= 4 && count >= float_register_lanes)
        return over_four_columns(width, [&](int j) { store_four_columns(values + j, rows + j, stride); });
    for (int j = 0; j < width; ++j) {
        float column[float_register_lanes];
        std::memcpy(column, &values[j], sizeof column);
        for (int k = 0; k < count; ++k) rows[std::size_t(k) * stride + std::size_t(j)] = column[k];
    }
}

}  // namespace cspace::inline CSPACE_ISA
