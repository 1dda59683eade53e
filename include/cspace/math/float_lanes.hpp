// Eight floats at once, on every machine: one register of AVX, two of SSE2 and NEON, an array elsewhere.
//
// Every operation rounds as IEEE 754 prescribes and none is fused, so the same source gives the same bits on
// every instruction set (files that use it are compiled without contraction of products and sums).
#pragma once

#include <cmath>
#include <cstdint>

#include "cspace/math/registers.hpp"

namespace cspace {

inline constexpr int float_lanes = 8;

#if CSPACE_VECTOR_EXTENSIONS
template <int N>
struct FloatRegister {
    typedef float Raw __attribute__((vector_size(N * 4)));
    Raw v;
};
template <int N>
struct MaskRegister {
    typedef std::int32_t Raw __attribute__((vector_size(N * 4)));
    Raw m;
};
#else
template <int N>
struct alignas(N * 4) FloatRegister {
    float v[N];
};
template <int N>
struct alignas(N * 4) MaskRegister {
    std::int32_t m[N];
};
#endif

#if CSPACE_VECTOR_EXTENSIONS && !defined(__AVX__)
struct Floats {
    FloatRegister<4> low, high;
};
struct FloatMask {
    MaskRegister<4> low, high;
};
#else
using Floats = FloatRegister<8>;
using FloatMask = MaskRegister<8>;
#endif

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

// --- one register
// -------------------------------------------------------------------------------------------
#if CSPACE_VECTOR_EXTENSIONS
#define CSPACE_EACH_FLOAT(Result, field, on_vectors, on_lanes) \
    return Result<N> { (typename Result<N>::Raw)(on_vectors) }
#else
#define CSPACE_EACH_FLOAT(Result, field, on_vectors, on_lanes) \
    Result<N> r;                                               \
    for (int i = 0; i < N; ++i) r.field[i] = on_lanes;         \
    return r
#endif
#define CSPACE_FLOAT_ARITHMETIC(op)                                                      \
    template <int N>                                                                     \
    CSPACE_INLINE FloatRegister<N> operator op(FloatRegister<N> a, FloatRegister<N> b) { \
        CSPACE_EACH_FLOAT(FloatRegister, v, a.v op b.v, a.v[i] op b.v[i]);               \
    }
#define CSPACE_FLOAT_COMPARISON(op)                                                      \
    template <int N>                                                                     \
    CSPACE_INLINE MaskRegister<N> operator op(FloatRegister<N> a, FloatRegister<N> b) {  \
        CSPACE_EACH_FLOAT(MaskRegister, m, a.v op b.v, -std::int32_t(a.v[i] op b.v[i])); \
    }
#define CSPACE_MASK_LOGIC(op)                                                         \
    template <int N>                                                                  \
    CSPACE_INLINE MaskRegister<N> operator op(MaskRegister<N> a, MaskRegister<N> b) { \
        CSPACE_EACH_FLOAT(MaskRegister, m, a.m op b.m, a.m[i] op b.m[i]);             \
    }
CSPACE_FLOAT_ARITHMETIC(+)
CSPACE_FLOAT_ARITHMETIC(-)
CSPACE_FLOAT_ARITHMETIC(*)
CSPACE_FLOAT_ARITHMETIC(/)
CSPACE_FLOAT_COMPARISON(<)
CSPACE_FLOAT_COMPARISON(>)
CSPACE_MASK_LOGIC(&)
CSPACE_MASK_LOGIC(|)
#undef CSPACE_FLOAT_ARITHMETIC
#undef CSPACE_FLOAT_COMPARISON
#undef CSPACE_MASK_LOGIC

// Logic of the representation.
template <int N>
CSPACE_INLINE FloatRegister<N> and_bits(FloatRegister<N> a, std::uint32_t bits) {
    CSPACE_EACH_FLOAT(FloatRegister, v, (typename MaskRegister<N>::Raw)a.v & std::int32_t(bits),
                      bits_as<float>(bits_as<std::uint32_t>(a.v[i]) & bits));
}
template <int N>
CSPACE_INLINE FloatRegister<N> xor_bits(FloatRegister<N> a, FloatRegister<N> b) {
    CSPACE_EACH_FLOAT(FloatRegister, v,
                      (typename MaskRegister<N>::Raw)a.v ^ (typename MaskRegister<N>::Raw)b.v,
                      bits_as<float>(bits_as<std::uint32_t>(a.v[i]) ^ bits_as<std::uint32_t>(b.v[i])));
}
template <int count, int N>
CSPACE_INLINE FloatRegister<N> shift_bits_left(FloatRegister<N> a) {
    CSPACE_EACH_FLOAT(FloatRegister, v, (typename MaskRegister<N>::Raw)a.v << count,
                      bits_as<float>(bits_as<std::uint32_t>(a.v[i]) << count));
}
template <int N>
CSPACE_INLINE FloatRegister<N> select_lanes(MaskRegister<N> m, FloatRegister<N> yes, FloatRegister<N> no) {
#if defined(CSPACE_X86_REGISTERS) && defined(__AVX__)
    if constexpr (N == 8) return {_mm256_blendv_ps(no.v, yes.v, (__m256)m.m)};
#endif
    using Bits [[maybe_unused]] = decltype(m.m);
    CSPACE_EACH_FLOAT(FloatRegister, v, (m.m & (Bits)yes.v) | (~m.m & (Bits)no.v),
                      m.m[i] ? yes.v[i] : no.v[i]);
}
// min and max return b where either is NaN.
#if defined(CSPACE_X86_REGISTERS) && defined(__AVX__)
CSPACE_INLINE Floats min(Floats a, Floats b) { return {_mm256_min_ps(a.v, b.v)}; }
CSPACE_INLINE Floats max(Floats a, Floats b) { return {_mm256_max_ps(a.v, b.v)}; }
CSPACE_INLINE Floats sqrt(Floats a) { return {_mm256_sqrt_ps(a.v)}; }
CSPACE_INLINE unsigned bits_of(FloatMask m) { return unsigned(_mm256_movemask_ps((__m256)m.m)); }
#elif defined(CSPACE_X86_REGISTERS)
CSPACE_INLINE FloatRegister<4> min(FloatRegister<4> a, FloatRegister<4> b) { return {_mm_min_ps(a.v, b.v)}; }
CSPACE_INLINE FloatRegister<4> max(FloatRegister<4> a, FloatRegister<4> b) { return {_mm_max_ps(a.v, b.v)}; }
CSPACE_INLINE FloatRegister<4> sqrt(FloatRegister<4> a) { return {_mm_sqrt_ps(a.v)}; }
CSPACE_INLINE unsigned bits_of(MaskRegister<4> m) { return unsigned(_mm_movemask_ps((__m128)m.m)); }
#else
template <int N>
CSPACE_INLINE FloatRegister<N> min(FloatRegister<N> a, FloatRegister<N> b) {
    return select_lanes(a < b, a, b);
}
template <int N>
CSPACE_INLINE FloatRegister<N> max(FloatRegister<N> a, FloatRegister<N> b) {
    return select_lanes(a > b, a, b);
}
template <int N>
CSPACE_INLINE FloatRegister<N> sqrt(FloatRegister<N> a) {
#if CSPACE_VECTOR_EXTENSIONS && defined(__ARM_NEON)
    return {(typename FloatRegister<N>::Raw)vsqrtq_f32(a.v)};
#else
    for (int i = 0; i < N; ++i) a.v[i] = std::sqrt(a.v[i]);
    return a;
#endif
}
template <int N>
CSPACE_INLINE unsigned bits_of(MaskRegister<N> m) {
    unsigned bits = 0;
    for (int i = 0; i < N; ++i) bits |= unsigned(m.m[i] & 1) << i;
    return bits;
}
#endif
#undef CSPACE_EACH_FLOAT

// --- two registers
// ------------------------------------------------------------------------------------------
#if CSPACE_VECTOR_EXTENSIONS && !defined(__AVX__)
#define CSPACE_ON_HALVES(Result, name, Operand) \
    CSPACE_INLINE Result name(Operand a, Operand b) { return {name(a.low, b.low), name(a.high, b.high)}; }
CSPACE_ON_HALVES(Floats, operator+, Floats)
CSPACE_ON_HALVES(Floats, operator-, Floats)
CSPACE_ON_HALVES(Floats, operator*, Floats)
CSPACE_ON_HALVES(Floats, operator/, Floats)
CSPACE_ON_HALVES(FloatMask, operator<, Floats)
CSPACE_ON_HALVES(FloatMask, operator>, Floats)
CSPACE_ON_HALVES(FloatMask, operator&, FloatMask)
CSPACE_ON_HALVES(FloatMask, operator|, FloatMask)
CSPACE_ON_HALVES(Floats, xor_bits, Floats)
CSPACE_ON_HALVES(Floats, min, Floats)
CSPACE_ON_HALVES(Floats, max, Floats)
#undef CSPACE_ON_HALVES
CSPACE_INLINE Floats and_bits(Floats a, std::uint32_t bits) {
    return {and_bits(a.low, bits), and_bits(a.high, bits)};
}
template <int count>
CSPACE_INLINE Floats shift_bits_left(Floats a) {
    return {shift_bits_left<count>(a.low), shift_bits_left<count>(a.high)};
}
CSPACE_INLINE Floats select_lanes(FloatMask m, Floats yes, Floats no) {
    return {select_lanes(m.low, yes.low, no.low), select_lanes(m.high, yes.high, no.high)};
}
CSPACE_INLINE Floats sqrt(Floats a) { return {sqrt(a.low), sqrt(a.high)}; }
CSPACE_INLINE unsigned bits_of(FloatMask m) { return bits_of(m.low) | bits_of(m.high) << 4; }
#endif

// --- memory: eight floats at an address that is a multiple of 32, or anywhere
// ----------------------------------
CSPACE_INLINE Floats load_floats(const float* values) {
    Floats r;
    std::memcpy(&r, values, sizeof r);
    return r;
}
CSPACE_INLINE void store_floats(float* values, Floats x) { std::memcpy(values, &x, sizeof x); }
CSPACE_INLINE Floats fill_floats(float x) {
#if CSPACE_VECTOR_EXTENSIONS && defined(__AVX__)
    const Floats r = {Floats::Raw{x, x, x, x, x, x, x, x}};
#elif CSPACE_VECTOR_EXTENSIONS
    const FloatRegister<4> half = {FloatRegister<4>::Raw{x, x, x, x}};
    const Floats r = {half, half};
#else
    const Floats r = {{x, x, x, x, x, x, x, x}};
#endif
    return r;
}

// The same for a register of any width.
template <class F>
CSPACE_INLINE F fill_floats(float x) {
    if constexpr (std::is_same_v<F, Floats>) {
        return fill_floats(x);
    } else {
        F r;
        for (std::size_t i = 0; i < sizeof(F) / sizeof(float); ++i) r.v[i] = x;
        return r;
    }
}

// --- what follows
// ---------------------------------------------------------------------------------------------
#define CSPACE_WITH_FLOAT(op)                                                         \
    CSPACE_INLINE auto operator op(Floats a, float b) { return a op fill_floats(b); } \
    CSPACE_INLINE auto operator op(float a, Floats b) { return fill_floats(a) op b; }
CSPACE_WITH_FLOAT(+)
CSPACE_WITH_FLOAT(-)
CSPACE_WITH_FLOAT(*)
CSPACE_WITH_FLOAT(/)
CSPACE_WITH_FLOAT(<)
CSPACE_WITH_FLOAT(>)
#undef CSPACE_WITH_FLOAT
CSPACE_INLINE Floats operator-(Floats a) { return xor_bits(a, fill_floats(-0.0f)); }
CSPACE_INLINE Floats abs(Floats a) { return and_bits(a, 0x7fffffffu); }
CSPACE_INLINE Floats square(Floats a) { return a * a; }

// The number of the lowest bit that is set; there is one.
CSPACE_INLINE int lowest_lane(unsigned bits) {
#if defined(__GNUC__) || defined(__clang__)
    return __builtin_ctz(bits);
#else
    int i = 0;
    while (!(bits >> i & 1)) ++i;
    return i;
#endif
}

// Lane i of `low` and `high` receives the least and the greatest lane of rows[i].
CSPACE_INLINE void bound_rows(const Floats (&rows)[float_lanes], Floats& low, Floats& high) {
#if defined(CSPACE_X86_REGISTERS) && defined(__AVX__)
    Floats a[4], b[4], c[2], d[2];
    for (int i = 0; i < 4; ++i) {
        const Floats even = {_mm256_unpacklo_ps(rows[2 * i].v, rows[2 * i + 1].v)};
        const Floats odd = {_mm256_unpackhi_ps(rows[2 * i].v, rows[2 * i + 1].v)};
        a[i] = min(even, odd), b[i] = max(even, odd);
    }
    const auto fold = [](Floats x, Floats y, Floats& first, Floats& second) {
        first = {_mm256_shuffle_ps(x.v, y.v, 0x44)}, second = {_mm256_shuffle_ps(x.v, y.v, 0xee)};
    };
    for (int i = 0; i < 2; ++i) {
        Floats first, second;
        fold(a[2 * i], a[2 * i + 1], first, second);
        c[i] = min(first, second);
        fold(b[2 * i], b[2 * i + 1], first, second);
        d[i] = max(first, second);
    }
    const auto halves = [](Floats x, Floats y, Floats& first, Floats& second) {
        first = {_mm256_permute2f128_ps(x.v, y.v, 0x20)}, second = {_mm256_permute2f128_ps(x.v, y.v, 0x31)};
    };
    Floats first, second;
    halves(c[0], c[1], first, second);
    low = min(first, second);
    halves(d[0], d[1], first, second);
    high = max(first, second);
#else
    float least[float_lanes], greatest[float_lanes];
    for (int i = 0; i < float_lanes; ++i) {
        float lanes[float_lanes];
        store_floats(lanes, rows[i]);
        least[i] = greatest[i] = lanes[0];
        for (const float x : lanes) {
            least[i] = x < least[i] ? x : least[i];
            greatest[i] = x > greatest[i] ? x : greatest[i];
        }
    }
    low = load_floats(least), high = load_floats(greatest);
#endif
}

}  // namespace cspace::inline CSPACE_ISA
