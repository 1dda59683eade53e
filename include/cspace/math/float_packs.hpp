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

#define CSPACE_WITH_SCALAR(Result, op)                                  \
    template <int N>                                                    \
    CSPACE_INLINE Result<N> operator op(FloatRegister<N> a, float b) {  \
        return a op fill<FloatRegister<N>>(b);                          \
    }                                                                   \
    template <int N>                                                    \
    CSPACE_INLINE Result<N> operator op(float a, FloatRegister<N> b) {  \
        return fill<FloatRegister<N>>(a) op b;                          \
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
    r.m = typename MaskRegister<N>::Raw(a.v == fill<FloatRegister<N>>(b).v);
#else
    for (int i = 0; i < N; ++i) r.m[i] = -std::int32_t(a.v[i] == b);
#endif
    return r;
}
template <int N>
CSPACE_INLINE bool all(MaskRegister<N> m) {
    std::int32_t both = -1;
    for (int i = 0; i < N; ++i) both &= m.m[i];
    return both != 0;
}
template <int N>
CSPACE_INLINE void sincos(FloatRegister<N> x, FloatRegister<N>& s, FloatRegister<N>& c) {
    sin_cos(x, s, c);
}

// --- rows: see rows.hpp ------------------------------------------------------------------------------------
template <int N>
CSPACE_INLINE void load_rows(const float* rows, std::size_t stride, int count, int width,
                             FloatRegister<N>* values) {
    for (int j = 0; j < width; ++j) {
        float column[N];
        for (int k = 0; k < N; ++k)
            column[k] = rows[std::size_t(k < count ? k : count - 1) * stride + std::size_t(j)];
        std::memcpy(&values[j], column, sizeof column);
    }
}
template <int N>
CSPACE_INLINE void store_rows(const FloatRegister<N>* values, int width, float* rows, std::size_t stride,
                              int count) {
    for (int k = 0; k < count; ++k) {
        for (int j = 0; j < width; ++j) {
            float value;
            std::memcpy(&value, reinterpret_cast<const char*>(values + j) + sizeof(float) * std::size_t(k),
                        sizeof value);
            rows[std::size_t(k) * stride + std::size_t(j)] = value;
        }
    }
}

}  // namespace cspace::inline CSPACE_ISA
