// Packs of lanes: one lane is one configuration, pose or particle.
//
// A kernel is a template over a scalar V. With V = double it serves one call; with V = Pack<4> it serves
// four at once. Everything a kernel may do with V is in this file (arithmetic, comparison, selection) or in
// trig.hpp (angles); each operation exists for both.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cspace/math/isa.hpp"

namespace cspace {

template <int N>
struct Pack;
template <int N>
struct Mask;

#if CSPACE_VECTOR_EXTENSIONS
template <int N>
struct Pack {
    typedef double Raw __attribute__((vector_size(N * 8)));
    Raw v;
};
template <int N>
struct Mask {
    typedef std::int64_t Raw __attribute__((vector_size(N * 8)));
    Raw m;
};
#else
template <int N>
struct alignas(N * 8) Pack {
    double v[N];
};
template <int N>
struct alignas(N * 8) Mask {
    std::int64_t m[N];
};
#endif

// What a kernel needs to know of its scalar: how many lanes, and what a comparison yields.
template <class V>
struct Lanes;
template <>
struct Lanes<double> {
    static constexpr int count = 1;
    using mask = bool;
};
template <int N>
struct Lanes<Pack<N>> {
    static constexpr int count = N;
    using mask = Mask<N>;
};
template <class V>
using mask_of = typename Lanes<V>::mask;

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

// --- filling and reading lanes -------------------------------------------------------------------------
template <class V>
CSPACE_INLINE V fill(double x) {
    if constexpr (Lanes<V>::count == 1) {
        return x;
    } else {
        V r;
        for (int i = 0; i < Lanes<V>::count; ++i) r.v[i] = x;
        return r;
    }
}
CSPACE_INLINE double lane(double x, int) { return x; }
template <int N>
CSPACE_INLINE double lane(Pack<N> x, int i) {
    return x.v[i];
}
CSPACE_INLINE bool lane(bool m, int) { return m; }
template <int N>
CSPACE_INLINE bool lane(Mask<N> m, int i) {
    return m.m[i] != 0;
}
CSPACE_INLINE void set_lane(double& x, int, double value) { x = value; }
template <int N>
CSPACE_INLINE void set_lane(Pack<N>& x, int i, double value) {
    x.v[i] = value;
}

// --- arithmetic ----------------------------------------------------------------------------------------
#if CSPACE_VECTOR_EXTENSIONS
#define CSPACE_ARITHMETIC(op)                                 \
    template <int N>                                          \
    CSPACE_INLINE Pack<N> operator op(Pack<N> a, Pack<N> b) { \
        return {a.v op b.v};                                  \
    }                                                         \
    template <int N>                                          \
    CSPACE_INLINE Pack<N> operator op(Pack<N> a, double b) {  \
        return {a.v op b};                                    \
    }                                                         \
    template <int N>                                          \
    CSPACE_INLINE Pack<N> operator op(double a, Pack<N> b) {  \
        return {a op b.v};                                    \
    }
#define CSPACE_COMPARISON(op)                                        \
    template <int N>                                                 \
    CSPACE_INLINE Mask<N> operator op(Pack<N> a, Pack<N> b) {        \
        return {(typename Mask<N>::Raw)(a.v op b.v)};                \
    }                                                                \
    template <int N>                                                 \
    CSPACE_INLINE Mask<N> operator op(Pack<N> a, double b) {         \
        return {(typename Mask<N>::Raw)(a.v op fill<Pack<N>>(b).v)}; \
    }
#define CSPACE_LOGIC(op, bitop)                               \
    template <int N>                                          \
    CSPACE_INLINE Mask<N> operator op(Mask<N> a, Mask<N> b) { \
        return {a.m bitop b.m};                               \
    }
#else
#define CSPACE_ARITHMETIC(op)                                  \
    template <int N>                                           \
    CSPACE_INLINE Pack<N> operator op(Pack<N> a, Pack<N> b) {  \
        Pack<N> r;                                             \
        for (int i = 0; i < N; ++i) r.v[i] = a.v[i] op b.v[i]; \
        return r;                                              \
    }                                                          \
    template <int N>                                           \
    CSPACE_INLINE Pack<N> operator op(Pack<N> a, double b) {   \
        return a op fill<Pack<N>>(b);                          \
    }                                                          \
    template <int N>                                           \
    CSPACE_INLINE Pack<N> operator op(double a, Pack<N> b) {   \
        return fill<Pack<N>>(a) op b;                          \
    }
#define CSPACE_COMPARISON(op)                                             \
    template <int N>                                                      \
    CSPACE_INLINE Mask<N> operator op(Pack<N> a, Pack<N> b) {             \
        Mask<N> r;                                                        \
        for (int i = 0; i < N; ++i) r.m[i] = (a.v[i] op b.v[i]) ? -1 : 0; \
        return r;                                                         \
    }                                                                     \
    template <int N>                                                      \
    CSPACE_INLINE Mask<N> operator op(Pack<N> a, double b) {              \
        return a op fill<Pack<N>>(b);                                     \
    }
#define CSPACE_LOGIC(op, bitop)                                   \
    template <int N>                                              \
    CSPACE_INLINE Mask<N> operator op(Mask<N> a, Mask<N> b) {     \
        Mask<N> r;                                                \
        for (int i = 0; i < N; ++i) r.m[i] = a.m[i] bitop b.m[i]; \
        return r;                                                 \
    }
#endif
CSPACE_ARITHMETIC(+)
CSPACE_ARITHMETIC(-)
CSPACE_ARITHMETIC(*)
CSPACE_ARITHMETIC(/)
CSPACE_COMPARISON(<)
CSPACE_COMPARISON(<=)
CSPACE_COMPARISON(>)
CSPACE_COMPARISON(>=)
CSPACE_COMPARISON(==)
CSPACE_LOGIC(&&, &)
CSPACE_LOGIC(||, |)
#undef CSPACE_ARITHMETIC
#undef CSPACE_COMPARISON
#undef CSPACE_LOGIC

template <int N>
CSPACE_INLINE Pack<N> operator-(Pack<N> a) {
#if CSPACE_VECTOR_EXTENSIONS
    return {-a.v};
#else
    for (int i = 0; i < N; ++i) a.v[i] = -a.v[i];
    return a;
#endif
}
template <int N>
CSPACE_INLINE Mask<N> operator!(Mask<N> a) {
    for (int i = 0; i < N; ++i) a.m[i] = ~a.m[i];
    return a;
}
template <int N>
CSPACE_INLINE Pack<N>& operator+=(Pack<N>& a, Pack<N> b) {
    return a = a + b;
}
template <int N>
CSPACE_INLINE Pack<N>& operator-=(Pack<N>& a, Pack<N> b) {
    return a = a - b;
}
template <int N>
CSPACE_INLINE Pack<N>& operator*=(Pack<N>& a, Pack<N> b) {
    return a = a * b;
}

// --- choice --------------------------------------------------------------------------------------------
CSPACE_INLINE double select(bool m, double yes, double no) { return m ? yes : no; }
template <int N>
CSPACE_INLINE Pack<N> select(Mask<N> m, Pack<N> yes, Pack<N> no) {
#if CSPACE_VECTOR_EXTENSIONS
    return {m.m ? yes.v : no.v};
#else
    for (int i = 0; i < N; ++i) no.v[i] = m.m[i] ? yes.v[i] : no.v[i];
    return no;
#endif
}
template <int N>
CSPACE_INLINE Pack<N> select(Mask<N> m, Pack<N> yes, double no) {
    return select(m, yes, fill<Pack<N>>(no));
}
template <int N>
CSPACE_INLINE Pack<N> select(Mask<N> m, double yes, Pack<N> no) {
    return select(m, fill<Pack<N>>(yes), no);
}
CSPACE_INLINE bool any(bool m) { return m; }
CSPACE_INLINE bool all(bool m) { return m; }
template <int N>
CSPACE_INLINE bool any(Mask<N> m) {
    std::int64_t r = 0;
    for (int i = 0; i < N; ++i) r |= m.m[i];
    return r != 0;
}
template <int N>
CSPACE_INLINE bool all(Mask<N> m) {
    std::int64_t r = -1;
    for (int i = 0; i < N; ++i) r &= m.m[i];
    return r != 0;
}

// --- elementary functions ------------------------------------------------------------------------------
CSPACE_INLINE double sqrt(double x) { return std::sqrt(x); }
CSPACE_INLINE double abs(double x) { return std::fabs(x); }
CSPACE_INLINE double copysign(double magnitude, double sign) { return std::copysign(magnitude, sign); }
template <int N>
CSPACE_INLINE Pack<N> sqrt(Pack<N> x) {
    for (int i = 0; i < N; ++i) x.v[i] = std::sqrt(x.v[i]);
    return x;
}
template <int N>
CSPACE_INLINE Pack<N> abs(Pack<N> x) {
    for (int i = 0; i < N; ++i) x.v[i] = std::fabs(x.v[i]);
    return x;
}
template <int N>
CSPACE_INLINE Pack<N> copysign(Pack<N> magnitude, Pack<N> sign) {
    for (int i = 0; i < N; ++i) magnitude.v[i] = std::copysign(magnitude.v[i], sign.v[i]);
    return magnitude;
}
template <class V>
CSPACE_INLINE V min(V a, V b) {
    return select(a < b, a, b);
}
template <class V>
CSPACE_INLINE V max(V a, V b) {
    return select(a > b, a, b);
}

}  // namespace cspace::inline CSPACE_ISA
