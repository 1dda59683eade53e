// Packs of lanes: one lane is one configuration, pose or particle.
//
// A kernel is a template over a scalar V. With V = double it serves one call; with V = Pack<native_width> it
// serves as many at once. Everything a kernel may do with V is in this file (arithmetic, comparison,
// selection), in rows.hpp (memory) or in trig.hpp (angles); each operation exists for both.
// How a pack is kept is the business of registers.hpp: read lanes with get_lane(), write them with
// set_lane().
#pragma once

#include <cmath>
#include <cstddef>

#include "cspace/math/registers.hpp"

namespace cspace {

// What a kernel needs to know of its scalar: how many lanes, of which numbers, and what a comparison yields.
template <class V>
struct Lanes;
template <>
struct Lanes<double> {
    static constexpr int count = 1;
    using scalar = double;
    using mask = bool;
};
template <int N>
struct Lanes<Pack<N>> {
    static constexpr int count = N;
    using scalar = double;
    using mask = Mask<N>;
};
template <class V>
using mask_of = typename Lanes<V>::mask;
template <class V>
using scalar_of = typename Lanes<V>::scalar;

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

// --- filling and reading lanes -------------------------------------------------------------------------
// GCC broadcasts a vector made of one number; of a loop over eight lanes it makes eight instructions.
template <class V, class S, int... lanes>
CSPACE_INLINE V repeat_scalar(S x, std::integer_sequence<int, lanes...>) {
#if CSPACE_VECTOR_EXTENSIONS
    return {typename V::Raw{((void)lanes, x)...}};
#else
    return {{((void)lanes, x)...}};
#endif
}
template <class V>
CSPACE_INLINE V fill_lanes(double x) {
    if constexpr (Lanes<V>::count == 1) {
        return x;
    } else if constexpr (std::is_same_v<V, Pack<Lanes<V>::count>> && is_split<Lanes<V>::count>) {
        const auto half = fill_lanes<Pack<Lanes<V>::count / 2>>(x);
        return {half, half};
    } else {
        return repeat_scalar<V>(scalar_of<V>(x), std::make_integer_sequence<int, Lanes<V>::count>());
    }
}
CSPACE_INLINE double get_lane(double x, int) { return x; }
CSPACE_INLINE bool get_lane(bool m, int) { return m; }
template <int N>
CSPACE_INLINE double get_lane(Pack<N> x, int i) {
    if constexpr (is_split<N>) {
        return i < N / 2 ? get_lane(x.low, i) : get_lane(x.high, i - N / 2);
    } else {
        return x.v[i];
    }
}
template <int N>
CSPACE_INLINE bool get_lane(Mask<N> m, int i) {
    if constexpr (is_split<N>) {
        return i < N / 2 ? get_lane(m.low, i) : get_lane(m.high, i - N / 2);
    } else {
        return m.m[i] != 0;
    }
}
CSPACE_INLINE void set_lane(double& x, int, double value) { x = value; }
template <int N>
CSPACE_INLINE void set_lane(Pack<N>& x, int i, double value) {
    if constexpr (is_split<N>) {
        i < N / 2 ? set_lane(x.low, i, value) : set_lane(x.high, i - N / 2, value);
    } else {
        x.v[i] = value;
    }
}

// --- packs wider than a register: every operation on both halves ----------------------------------------
#define CSPACE_ON_HALVES(Result, name, Operand)                \
    template <int N, when<is_split<N>> = 0>                    \
    CSPACE_INLINE Result<N> name(Operand<N> a, Operand<N> b) { \
        return {name(a.low, b.low), name(a.high, b.high)};     \
    }
CSPACE_ON_HALVES(Pack, operator+, Pack)
CSPACE_ON_HALVES(Pack, operator-, Pack)
CSPACE_ON_HALVES(Pack, operator*, Pack)
CSPACE_ON_HALVES(Pack, operator/, Pack)
CSPACE_ON_HALVES(Mask, operator<, Pack)
CSPACE_ON_HALVES(Mask, operator<=, Pack)
CSPACE_ON_HALVES(Mask, operator>, Pack)
CSPACE_ON_HALVES(Mask, operator>=, Pack)
CSPACE_ON_HALVES(Mask, operator==, Pack)
CSPACE_ON_HALVES(Mask, operator!=, Pack)
CSPACE_ON_HALVES(Mask, operator&&, Mask)
CSPACE_ON_HALVES(Mask, operator||, Mask)
CSPACE_ON_HALVES(Pack, bit_and, Pack)
CSPACE_ON_HALVES(Pack, bit_or, Pack)
CSPACE_ON_HALVES(Pack, bit_xor, Pack)
CSPACE_ON_HALVES(Pack, bit_and_not, Pack)
CSPACE_ON_HALVES(Pack, min, Pack)
CSPACE_ON_HALVES(Pack, max, Pack)
#undef CSPACE_ON_HALVES
#define CSPACE_ON_HALVES(Result, name, Operand)  \
    template <int N, when<is_split<N>> = 0>      \
    CSPACE_INLINE Result<N> name(Operand<N> a) { \
        return {name(a.low), name(a.high)};      \
    }
CSPACE_ON_HALVES(Pack, operator-, Pack)
CSPACE_ON_HALVES(Mask, operator!, Mask)
CSPACE_ON_HALVES(Pack, sqrt, Pack)
CSPACE_ON_HALVES(Mask, lowest_bit, Pack)
#if defined(CSPACE_X86_REGISTERS) && defined(__AVX__)
CSPACE_ON_HALVES(Pack, round, Pack)
#endif
#undef CSPACE_ON_HALVES
template <int N, when<is_split<N>> = 0>
CSPACE_INLINE Pack<N> mul_add(Pack<N> a, Pack<N> b, Pack<N> c) {
    return {mul_add(a.low, b.low, c.low), mul_add(a.high, b.high, c.high)};
}
template <int N, when<is_split<N>> = 0>
CSPACE_INLINE Pack<N> select_lanes(Mask<N> m, Pack<N> yes, Pack<N> no) {
    return {select_lanes(m.low, yes.low, no.low), select_lanes(m.high, yes.high, no.high)};
}
template <int count, int N, when<is_split<N>> = 0>
CSPACE_INLINE Pack<N> shift_bits_left(Pack<N> a) {
    return {shift_bits_left<count>(a.low), shift_bits_left<count>(a.high)};
}
template <int s, int N, when<is_split<N>> = 0>
CSPACE_INLINE Pack<N> swap_lanes(Pack<N> a) {
    const auto low = swap_lanes<s % (N / 2)>(a.low), high = swap_lanes<s % (N / 2)>(a.high);
    if constexpr (s >= N / 2) return {high, low};
    return {low, high};
}
// The lanes of a mask as the low bits of an integer.
template <int N, when<is_split<N>> = 0>
CSPACE_INLINE unsigned bits_of(Mask<N> m) {
    return bits_of(m.low) | bits_of(m.high) << N / 2;
}

// --- a pack and a number ---------------------------------------------------------------------------------
#define CSPACE_WITH_NUMBER(Result, op)                         \
    template <int N>                                           \
    CSPACE_INLINE Result<N> operator op(Pack<N> a, double b) { \
        return a op fill_lanes<Pack<N>>(b);                    \
    }                                                          \
    template <int N>                                           \
    CSPACE_INLINE Result<N> operator op(double a, Pack<N> b) { \
        return fill_lanes<Pack<N>>(a) op b;                    \
    }
#define CSPACE_ASSIGNMENT(op)                                         \
    CSPACE_WITH_NUMBER(Pack, op)                                      \
    template <int N>                                                  \
    CSPACE_INLINE Pack<N>& operator op## = (Pack<N> & a, Pack<N> b) { \
        return a = a op b;                                            \
    }                                                                 \
    template <int N>                                                  \
    CSPACE_INLINE Pack<N>& operator op## = (Pack<N> & a, double b) {  \
        return a = a op b;                                            \
    }
CSPACE_ASSIGNMENT(+)
CSPACE_ASSIGNMENT(-)
CSPACE_ASSIGNMENT(*)
CSPACE_ASSIGNMENT(/)
CSPACE_WITH_NUMBER(Mask, <)
CSPACE_WITH_NUMBER(Mask, <=)
CSPACE_WITH_NUMBER(Mask, >)
CSPACE_WITH_NUMBER(Mask, >=)
CSPACE_WITH_NUMBER(Mask, ==)
CSPACE_WITH_NUMBER(Mask, !=)
#undef CSPACE_ASSIGNMENT
#undef CSPACE_WITH_NUMBER
template <int N>
CSPACE_INLINE Pack<N> select_lanes(Mask<N> m, Pack<N> yes, double no) {
    return select_lanes(m, yes, fill_lanes<Pack<N>>(no));
}
template <int N>
CSPACE_INLINE Pack<N> select_lanes(Mask<N> m, double yes, Pack<N> no) {
    return select_lanes(m, fill_lanes<Pack<N>>(yes), no);
}

// --- the same for one double -----------------------------------------------------------------------------
CSPACE_INLINE double select_lanes(bool m, double yes, double no) { return m ? yes : no; }
CSPACE_INLINE unsigned bits_of(bool m) { return m; }
CSPACE_INLINE double sqrt(double x) { return std::sqrt(x); }
CSPACE_INLINE double min(double a, double b) { return a < b ? a : b; }
CSPACE_INLINE double max(double a, double b) { return a > b ? a : b; }
#define CSPACE_BITS(name, op)                                                         \
    CSPACE_INLINE double name(double a, double b) {                                   \
        return bits_as<double>(bits_as<std::int64_t>(a) op bits_as<std::int64_t>(b)); \
    }
CSPACE_BITS(bit_and, &)
CSPACE_BITS(bit_or, |)
CSPACE_BITS(bit_xor, ^)
CSPACE_BITS(bit_and_not, &~)
#undef CSPACE_BITS
template <int count>
CSPACE_INLINE double shift_bits_left(double a) {
    return bits_as<double>(bits_as<std::uint64_t>(a) << count);
}
CSPACE_INLINE bool lowest_bit(double a) { return bits_as<std::uint64_t>(a) & 1; }

// --- what follows from the above, for both ---------------------------------------------------------------
template <class M>
CSPACE_INLINE bool any(M m) {
    return bits_of(m) != 0;
}
CSPACE_INLINE bool all(bool m) { return m; }
template <int N>
CSPACE_INLINE bool all(Mask<N> m) {
    return bits_of(m) == (1u << N) - 1;
}
// x where the mask is set, else +0.
template <class V>
CSPACE_INLINE V keep_lanes(mask_of<V> m, V x) {
    return select_lanes(m, x, fill_lanes<V>(0.0));
}
// The sign bit alone, +0 or −0; bit_xor with it multiplies by the sign.
template <class V>
CSPACE_INLINE V sign_bit(V x) {
    return bit_and(x, fill_lanes<V>(-0.0));
}
template <class V>
CSPACE_INLINE V abs(V x) {
    return bit_and_not(x, fill_lanes<V>(-0.0));
}
template <class V>
CSPACE_INLINE V copysign(V magnitude, V sign) {
    return bit_or(abs(magnitude), sign_bit(sign));
}
#if !defined(CSPACE_X86_REGISTERS) || !defined(__AVX__)
// The nearest integer, ties to even. Adding 2⁵² removes the fraction; larger numbers have none.
template <class V>
CSPACE_INLINE V round(V x) {
    const V big = fill_lanes<V>(4503599627370496.0), magnitude = abs(x);
    return bit_or(select_lanes(magnitude < big, (magnitude + big) - big, magnitude), sign_bit(x));
}
#endif

}  // namespace cspace::inline CSPACE_ISA
