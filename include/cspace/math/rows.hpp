// Memory and lanes: runs of values, and rows of row-major arrays (lane k contains row k).
#pragma once

#include <cstddef>
#include <cstring>

#include "cspace/math/lanes.hpp"

namespace cspace::inline CSPACE_ISA {

// --- runs: lane k contains values[k]; no alignment is needed
// ------------------------------------------------
template <class V>
CSPACE_INLINE V load_lanes(const double* values) {
    V v;
    std::memcpy(&v, values, sizeof v);
    return v;
}
template <class V>
CSPACE_INLINE void store_lanes(double* values, V v) {
    std::memcpy(values, &v, sizeof v);
}
// The first `count` lanes alone; when loading, the others repeat the last.
template <class V>
CSPACE_INLINE V load_lanes(const double* values, int count) {
    if (count >= Lanes<V>::count) return load_lanes<V>(values);
    V v{};
    for (int k = 0; k < Lanes<V>::count; ++k) set_lane(v, k, values[k < count ? k : count - 1]);
    return v;
}
template <class V>
CSPACE_INLINE void store_lanes(double* values, V v, int count) {
    if (count >= Lanes<V>::count) return store_lanes(values, v);
    for (int k = 0; k < count; ++k) values[k] = get_lane(v, k);
}

// body(pack, i) for the values from i on, in packs as wide as the registers while more than four are left,
// then in packs of four; the last ones may have fewer values than lanes. `pack` says the type alone.
template <class Body>
CSPACE_INLINE void for_each_pack(int count, const Body& body) {
    int i = 0;
    if constexpr (native_width > 4)
        for (; count - i > 4; i += native_width) body(Pack<native_width>{}, i);
    for (; i < count; i += 4) body(Pack<4>{}, i);
}

// --- rows: two neighbouring columns at a time, which suits every register ----------------------------------
// a and b take the values at 0 and 1 of N rows, `stride` values apart.
template <int N>
CSPACE_INLINE void load_column_pair(const double* rows, std::size_t stride, Pack<N>& a, Pack<N>& b) {
    if constexpr (is_split<N>) {
        load_column_pair(rows, stride, a.low, b.low);
        load_column_pair(rows + N / 2 * stride, stride, a.high, b.high);
        return;
    }
#if defined(CSPACE_X86_REGISTERS) && defined(__AVX__)
    if constexpr (N == 4) {
        const auto two_rows = [=](std::size_t i, std::size_t k) {
            return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(rows + i * stride)),
                                        _mm_loadu_pd(rows + k * stride), 1);
        };
        const __m256d even = two_rows(0, 2), odd = two_rows(1, 3);
        a = {_mm256_unpacklo_pd(even, odd)};
        b = {_mm256_unpackhi_pd(even, odd)};
        return;
    }
#endif
#if defined(CSPACE_X86_REGISTERS) && defined(__AVX512F__)
    if constexpr (N == 8) {
        Pack<4> a_low, b_low, a_high, b_high;
        load_column_pair(rows, stride, a_low, b_low);
        load_column_pair(rows + 4 * stride, stride, a_high, b_high);
        a = {_mm512_insertf64x4(_mm512_castpd256_pd512(a_low.v), a_high.v, 1)};
        b = {_mm512_insertf64x4(_mm512_castpd256_pd512(b_low.v), b_high.v, 1)};
        return;
    }
#endif
    for (int k = 0; k < N; ++k) {
        set_lane(a, k, rows[std::size_t(k) * stride]);
        set_lane(b, k, rows[std::size_t(k) * stride + 1]);
    }
}
template <int N>
CSPACE_INLINE void store_column_pair(Pack<N> a, Pack<N> b, double* rows, std::size_t stride) {
    if constexpr (is_split<N>) {
        store_column_pair(a.low, b.low, rows, stride);
        store_column_pair(a.high, b.high, rows + N / 2 * stride, stride);
        return;
    }
#if defined(CSPACE_X86_REGISTERS)
    if constexpr (N == 2) {
        _mm_storeu_pd(rows, _mm_unpacklo_pd(a.v, b.v));
        _mm_storeu_pd(rows + stride, _mm_unpackhi_pd(a.v, b.v));
        return;
    }
#if defined(__AVX__)
    if constexpr (N == 4) {
        const __m256d even = _mm256_unpacklo_pd(a.v, b.v), odd = _mm256_unpackhi_pd(a.v, b.v);
        _mm_storeu_pd(rows, _mm256_castpd256_pd128(even));
        _mm_storeu_pd(rows + stride, _mm256_castpd256_pd128(odd));
        _mm_storeu_pd(rows + 2 * stride, _mm256_extractf128_pd(even, 1));
        _mm_storeu_pd(rows + 3 * stride, _mm256_extractf128_pd(odd, 1));
        return;
    }
#endif
#if defined(__AVX512F__)
    if constexpr (N == 8) {
        store_column_pair(Pack<4>{_mm512_castpd512_pd256(a.v)}, Pack<4>{_mm512_castpd512_pd256(b.v)}, rows,
                          stride);
        store_column_pair(Pack<4>{_mm512_extractf64x4_pd(a.v, 1)}, Pack<4>{_mm512_extractf64x4_pd(b.v, 1)},
                          rows + 4 * stride, stride);
        return;
    }
#endif
#endif
    for (int k = 0; k < N; ++k) {
        rows[std::size_t(k) * stride] = get_lane(a, k);
        rows[std::size_t(k) * stride + 1] = get_lane(b, k);
    }
}

#if defined(CSPACE_X86_REGISTERS) && defined(__AVX__)
// Four neighbouring columns of four rows: half as many stores as by pairs.
CSPACE_INLINE void store_column_quad(const Pack<4>* v, double* rows, std::size_t stride) {
    const __m256d a = _mm256_unpacklo_pd(v[0].v, v[1].v), b = _mm256_unpackhi_pd(v[0].v, v[1].v);
    const __m256d c = _mm256_unpacklo_pd(v[2].v, v[3].v), d = _mm256_unpackhi_pd(v[2].v, v[3].v);
    _mm256_storeu_pd(rows, _mm256_permute2f128_pd(a, c, 0x20));
    _mm256_storeu_pd(rows + stride, _mm256_permute2f128_pd(b, d, 0x20));
    _mm256_storeu_pd(rows + 2 * stride, _mm256_permute2f128_pd(a, c, 0x31));
    _mm256_storeu_pd(rows + 3 * stride, _mm256_permute2f128_pd(b, d, 0x31));
}
#endif

// Reads `width` values of `count` rows, `stride` values apart; lanes beyond them repeat the last row.
template <class V>
CSPACE_INLINE void load_rows(const double* rows, std::size_t stride, int count, int width, V* values) {
    int j = 0;
    if constexpr (Lanes<V>::count > 1) {
        if (count >= Lanes<V>::count) {
            for (; j + 2 <= width; j += 2) load_column_pair(rows + j, stride, values[j], values[j + 1]);
        }
    }
    for (; j < width; ++j) {
        values[j] = fill_lanes<V>(rows[j]);
        for (int k = 1; k < Lanes<V>::count; ++k) {
            set_lane(values[j], k, rows[std::size_t(k < count ? k : count - 1) * stride + std::size_t(j)]);
        }
    }
}
// Writes the first `count` lanes of `width` values as rows, `stride` values apart.
template <class V>
CSPACE_INLINE void store_rows(const V* values, int width, double* rows, std::size_t stride, int count) {
    int j = 0;
    if constexpr (Lanes<V>::count > 1) {
        if (count >= Lanes<V>::count) {
#if defined(CSPACE_X86_REGISTERS) && defined(__AVX__)
            if constexpr (Lanes<V>::count == 4) {
                for (; j + 4 <= width; j += 4) store_column_quad(values + j, rows + j, stride);
            }
#endif
            for (; j + 2 <= width; j += 2) store_column_pair(values[j], values[j + 1], rows + j, stride);
        }
    }
    for (; j < width; ++j) {
        for (int k = 0; k < Lanes<V>::count; ++k) {
            if (k < count) rows[std::size_t(k) * stride + std::size_t(j)] = get_lane(values[j], k);
        }
    }
}

// --- packs of rows -----------------------------------------------------------------------------------------
// Calls f(first, count) for every `width` of n rows; the last may be partial.
template <int width, class F>
CSPACE_INLINE void over_packs(std::size_t n, F f) {
    std::size_t first = 0;
    for (; first + width <= n; first += width) f(first, width);
    if (first < n) f(first, int(n - first));
}

}  // namespace cspace::inline CSPACE_ISA
