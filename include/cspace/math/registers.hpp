// What one register of lanes can do: the part of lanes.hpp that differs between instruction sets.
//
// A pack that fits a register is a vector of GCC and Clang (or an array, on other compilers); a wider one is
// two packs of half the width, and lanes.hpp carries every operation over to the halves. The intrinsics below
// stand where the vector extensions compile to more than the one instruction there is.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "cspace/math/isa.hpp"

#if CSPACE_VECTOR_EXTENSIONS && defined(__SSE2__)
#define CSPACE_X86_REGISTERS 1
#include <immintrin.h>
#elif CSPACE_VECTOR_EXTENSIONS && defined(__ARM_NEON)
#include <arm_neon.h>
#endif

namespace cspace::inline CSPACE_ISA {
// The lanes of one register, and the width of pack that serves a batch best.
#if !CSPACE_VECTOR_EXTENSIONS
inline constexpr int register_lanes = 8, native_width = 4;
#elif defined(__AVX512F__)
inline constexpr int register_lanes = 8, native_width = 8;
#elif defined(__AVX__)
inline constexpr int register_lanes = 4, native_width = 4;
#else
inline constexpr int register_lanes = 2, native_width = 4;
#endif
template <int N>
inline constexpr bool is_split = N > register_lanes;
// A template parameter that removes a function where the condition fails.
template <bool condition>
using when = std::enable_if_t<condition, int>;
}  // namespace cspace::inline CSPACE_ISA

namespace cspace {
#if CSPACE_VECTOR_EXTENSIONS
template <int N, bool split = is_split<N>>
struct Pack {
    typedef double Raw __attribute__((vector_size(N * 8)));
    Raw v;
};
template <int N, bool split = is_split<N>>
struct Mask {
    typedef std::int64_t Raw __attribute__((vector_size(N * 8)));
    Raw m;
};
#else
template <int N, bool split = is_split<N>>
struct alignas(N * 8) Pack {
    double v[N];
};
template <int N, bool split = is_split<N>>
struct alignas(N * 8) Mask {
    std::int64_t m[N];
};
#endif
template <int N>
struct Pack<N, true> {
    Pack<N / 2> low, high;
};
template <int N>
struct Mask<N, true> {
    Mask<N / 2> low, high;
};
}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

// The bits of a value as one of another type.
template <class To, class From>
CSPACE_INLINE To bits_as(From from) {
    static_assert(sizeof(To) == sizeof(From));
    To to;
    std::memcpy(&to, &from, sizeof to);
    return to;
}

// a b + c; rounded once where the instruction set multiplies and adds in one instruction.
CSPACE_INLINE double mul_add(double a, double b, double c) {
#if (defined(__GNUC__) || defined(__clang__)) && (defined(__FMA__) || defined(__ARM_NEON))
    return __builtin_fma(a, b, c);
#else
    return a * b + c;
#endif
}

#define CSPACE_REGISTER_OPERATION(Result, name, Operand) \
    template <int N, when<!is_split<N>> = 0>             \
    CSPACE_INLINE Result<N> name(Operand<N> a, Operand<N> b)

// --- arithmetic, comparison, logic ---------------------------------------------------------------------
#if CSPACE_VECTOR_EXTENSIONS
#define CSPACE_EACH_LANE(Result, field, on_vectors, on_lanes) \
    return Result<N>{(typename Result<N>::Raw)(on_vectors)};
#else
#define CSPACE_EACH_LANE(Result, field, on_vectors, on_lanes) \
    Result<N> r;                                              \
    for (int i = 0; i < N; ++i) r.field[i] = on_lanes;        \
    return r;
#endif
#define CSPACE_ARITHMETIC(op)                                   \
    CSPACE_REGISTER_OPERATION(Pack, operator op, Pack) {        \
        CSPACE_EACH_LANE(Pack, v, a.v op b.v, a.v[i] op b.v[i]) \
    }
#define CSPACE_COMPARISON(op)                                                  \
    CSPACE_REGISTER_OPERATION(Mask, operator op, Pack) {                       \
        CSPACE_EACH_LANE(Mask, m, a.v op b.v, -std::int64_t(a.v[i] op b.v[i])) \
    }
#define CSPACE_LOGIC(op, bitop)                                       \
    CSPACE_REGISTER_OPERATION(Mask, operator op, Mask) {              \
        CSPACE_EACH_LANE(Mask, m, a.m bitop b.m, a.m[i] bitop b.m[i]) \
    }
CSPACE_ARITHMETIC(+)
CSPACE_ARITHMETIC(-)
CSPACE_ARITHMETIC(*)
CSPACE_ARITHMETIC(/)
#if defined(CSPACE_X86_REGISTERS) && !defined(__AVX__)
// GCC takes comparisons of SSE2 vectors apart into lanes where their masks meet; it leaves the intrinsics
// whole.
#define CSPACE_SSE2_COMPARISON(op, name)                      \
    CSPACE_INLINE Mask<2> operator op(Pack<2> a, Pack<2> b) { \
        return {(Mask<2>::Raw)_mm_##name##_pd(a.v, b.v)};     \
    }
CSPACE_SSE2_COMPARISON(<, cmplt)
CSPACE_SSE2_COMPARISON(<=, cmple)
CSPACE_SSE2_COMPARISON(>, cmpgt)
CSPACE_SSE2_COMPARISON(>=, cmpge)
CSPACE_SSE2_COMPARISON(==, cmpeq)
CSPACE_SSE2_COMPARISON(!=, cmpneq)
#undef CSPACE_SSE2_COMPARISON
#else
CSPACE_COMPARISON(<)
CSPACE_COMPARISON(<=)
CSPACE_COMPARISON(>)
CSPACE_COMPARISON(>=)
CSPACE_COMPARISON(==)
CSPACE_COMPARISON(!=)
#endif
CSPACE_LOGIC(&&, &)
CSPACE_LOGIC(||, |)
#undef CSPACE_ARITHMETIC
#undef CSPACE_COMPARISON
#undef CSPACE_LOGIC

template <int N, when<!is_split<N>> = 0>
CSPACE_INLINE Pack<N> operator-(Pack<N> a) {
    CSPACE_EACH_LANE(Pack, v, -a.v, -a.v[i])
}
template <int N, when<!is_split<N>> = 0>
CSPACE_INLINE Mask<N> operator!(Mask<N> a) {
    CSPACE_EACH_LANE(Mask, m, ~a.m, ~a.m[i])
}

// Lane i of the result is lane i ^ s. GCC shuffles without a loop from version 12 on.
#if CSPACE_VECTOR_EXTENSIONS && (defined(__clang__) || __GNUC__ >= 12)
template <int s, int N, int... lanes>
CSPACE_INLINE Pack<N> swap_listed(Pack<N> a, std::integer_sequence<int, lanes...>) {
    return {__builtin_shufflevector(a.v, a.v, (lanes ^ s)...)};
}
template <int s, int N, when<!is_split<N>> = 0>
CSPACE_INLINE Pack<N> swap_lanes(Pack<N> a) {
    return swap_listed<s>(a, std::make_integer_sequence<int, N>());
}
#else
template <int s, int N, when<!is_split<N>> = 0>
CSPACE_INLINE Pack<N> swap_lanes(Pack<N> a) {
    Pack<N> r;
    for (int i = 0; i < N; ++i) r.v[i] = a.v[i ^ s];
    return r;
}
#endif

// --- bits ------------------------------------------------------------------------------------------------
// The representation shifted left, zeros coming in.
template <int count, int N, when<!is_split<N>> = 0>
CSPACE_INLINE Pack<N> shift_bits_left(Pack<N> a) {
    using Bits [[maybe_unused]] = decltype(Mask<N>::m);
    CSPACE_EACH_LANE(Pack, v, (Bits)a.v << count, bits_as<double>(bits_as<std::uint64_t>(a.v[i]) << count))
}
// Whether the lowest bit of the representation is set.
template <int N, when<!is_split<N>> = 0>
CSPACE_INLINE Mask<N> lowest_bit(Pack<N> a) {
    using Bits [[maybe_unused]] = decltype(Mask<N>::m);
#if defined(CSPACE_X86_REGISTERS) && !defined(__AVX__)  // SSE2 does not compare 64-bit integers
    return {-((Bits)a.v & 1)};
#else
    CSPACE_EACH_LANE(Mask, m, ((Bits)a.v & 1) == 1, -(bits_as<std::int64_t>(a.v[i]) & 1))
#endif
}

// --- choice, logic of bits, square root: x86
// -------------------------------------------------------------------- min and max return b where either is
// NaN, as the instructions do.
#if defined(CSPACE_X86_REGISTERS)
#define CSPACE_X86_WIDTH(N, prefix, D)                                                                 \
    CSPACE_INLINE Pack<N> bit_and(Pack<N> a, Pack<N> b) { return {prefix##_and_pd(a.v, b.v)}; }        \
    CSPACE_INLINE Pack<N> bit_or(Pack<N> a, Pack<N> b) { return {prefix##_or_pd(a.v, b.v)}; }          \
    CSPACE_INLINE Pack<N> bit_xor(Pack<N> a, Pack<N> b) { return {prefix##_xor_pd(a.v, b.v)}; }        \
    CSPACE_INLINE Pack<N> bit_and_not(Pack<N> a, Pack<N> b) { return {prefix##_andnot_pd(b.v, a.v)}; } \
    CSPACE_INLINE Pack<N> min(Pack<N> a, Pack<N> b) { return {prefix##_min_pd(a.v, b.v)}; }            \
    CSPACE_INLINE Pack<N> max(Pack<N> a, Pack<N> b) { return {prefix##_max_pd(a.v, b.v)}; }            \
    CSPACE_INLINE Pack<N> sqrt(Pack<N> a) { return {prefix##_sqrt_pd(a.v)}; }                          \
    CSPACE_INLINE Pack<N> mul_add(Pack<N> a, Pack<N> b, Pack<N> c) {                                   \
        return {CSPACE_X86_FMA(prefix, a, b, c)};                                                      \
    }                                                                                                  \
    CSPACE_INLINE Pack<N> select_lanes(Mask<N> m, Pack<N> yes, Pack<N> no) {                           \
        return {CSPACE_X86_SELECT(prefix, D, m, yes, no)};                                             \
    }
#if defined(__FMA__)
#define CSPACE_X86_FMA(prefix, a, b, c) prefix##_fmadd_pd(a.v, b.v, c.v)
#else
#define CSPACE_X86_FMA(prefix, a, b, c) a.v* b.v + c.v
#endif
#if defined(__AVX512VL__)
#define CSPACE_X86_SELECT(prefix, D, m, yes, no) m.m ? yes.v : no.v
#elif defined(__AVX__)
#define CSPACE_X86_SELECT(prefix, D, m, yes, no) prefix##_blendv_pd(no.v, yes.v, (D)m.m)
#else
#define CSPACE_X86_SELECT(prefix, D, m, yes, no) \
    prefix##_or_pd(prefix##_and_pd((D)m.m, yes.v), prefix##_andnot_pd((D)m.m, no.v))
#endif
CSPACE_X86_WIDTH(2, _mm, __m128d)
CSPACE_INLINE unsigned bits_of(Mask<2> m) { return unsigned(_mm_movemask_pd((__m128d)m.m)); }
#if defined(__AVX__)
CSPACE_X86_WIDTH(4, _mm256, __m256d)
CSPACE_INLINE unsigned bits_of(Mask<4> m) { return unsigned(_mm256_movemask_pd((__m256d)m.m)); }
#endif
#if defined(__AVX512F__)
CSPACE_X86_WIDTH(8, _mm512, __m512d)
CSPACE_INLINE unsigned bits_of(Mask<8> m) { return unsigned(_mm512_movepi64_mask((__m512i)m.m)); }
#endif
#if defined(__AVX__)
// The nearest integer, ties to even; lanes.hpp has it for other registers.
CSPACE_INLINE double round(double x) { return __builtin_rint(x); }
CSPACE_INLINE Pack<2> round(Pack<2> a) { return {_mm_round_pd(a.v, _MM_FROUND_TO_NEAREST_INT)}; }
CSPACE_INLINE Pack<4> round(Pack<4> a) { return {_mm256_round_pd(a.v, _MM_FROUND_TO_NEAREST_INT)}; }
#endif
#if defined(__AVX512F__)
CSPACE_INLINE Pack<8> round(Pack<8> a) { return {_mm512_roundscale_pd(a.v, _MM_FROUND_TO_NEAREST_INT)}; }
#endif
#undef CSPACE_X86_WIDTH
#undef CSPACE_X86_FMA
#undef CSPACE_X86_SELECT

#else
// --- choice, logic of bits, square root: NEON and arrays
// ----------------------------------------------------------
#define CSPACE_BITS(name, op)                                                                      \
    CSPACE_REGISTER_OPERATION(Pack, name, Pack) {                                                  \
        [[maybe_unused]] const auto lane_bits = [](double x) { return bits_as<std::int64_t>(x); }; \
        using Bits [[maybe_unused]] = decltype(Mask<N>::m);                                        \
        CSPACE_EACH_LANE(Pack, v, (Bits)a.v op(Bits) b.v,                                          \
                         bits_as<double>(lane_bits(a.v[i]) op lane_bits(b.v[i])))                  \
    }
CSPACE_BITS(bit_and, &)
CSPACE_BITS(bit_or, |)
CSPACE_BITS(bit_xor, ^)
CSPACE_BITS(bit_and_not, &~)
#undef CSPACE_BITS

template <int N, when<!is_split<N>> = 0>
CSPACE_INLINE Pack<N> select_lanes(Mask<N> m, Pack<N> yes, Pack<N> no) {
    using Bits [[maybe_unused]] = decltype(Mask<N>::m);
    CSPACE_EACH_LANE(Pack, v, (m.m & (Bits)yes.v) | (~m.m & (Bits)no.v), m.m[i] ? yes.v[i] : no.v[i])
}
CSPACE_REGISTER_OPERATION(Pack, min, Pack) { return select_lanes(a < b, a, b); }
CSPACE_REGISTER_OPERATION(Pack, max, Pack) { return select_lanes(a > b, a, b); }
template <int N, when<!is_split<N>> = 0>
CSPACE_INLINE Pack<N> sqrt(Pack<N> a) {
#if CSPACE_VECTOR_EXTENSIONS && defined(__ARM_NEON)
    return {(typename Pack<N>::Raw)vsqrtq_f64(a.v)};
#else
    for (int i = 0; i < N; ++i) a.v[i] = std::sqrt(a.v[i]);
    return a;
#endif
}
template <int N, when<!is_split<N>> = 0>
CSPACE_INLINE Pack<N> mul_add(Pack<N> a, Pack<N> b, Pack<N> c) {
#if CSPACE_VECTOR_EXTENSIONS && defined(__ARM_NEON)
    return {(typename Pack<N>::Raw)vfmaq_f64(c.v, a.v, b.v)};
#else
    for (int i = 0; i < N; ++i) c.v[i] = mul_add(a.v[i], b.v[i], c.v[i]);
    return c;
#endif
}
template <int N, when<!is_split<N>> = 0>
CSPACE_INLINE unsigned bits_of(Mask<N> m) {
    unsigned bits = 0;
    for (int i = 0; i < N; ++i) bits |= unsigned(m.m[i] & 1) << i;
    return bits;
}
#endif
#undef CSPACE_EACH_LANE
#undef CSPACE_REGISTER_OPERATION

}  // namespace cspace::inline CSPACE_ISA
