// Polynomials on [0, 1] in Bernstein form: signs, halves, roots (Farouki 2012; Mourrain, Rouillier & Roy
// 2005).
#pragma once

#include "cspace/math/rows.hpp"

namespace cspace {

// How often the coefficients of a polynomial change sign: as counted, leaving out those that drown in noise,
// and at the most, whatever these are. A polynomial has as many roots inside as variations, or fewer by an
// even number (Descartes).
struct Variations {
    int count, most;
    bool ends_known;
    double largest;
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

CSPACE_INLINE int count_bits(unsigned x) {
#if defined(__GNUC__) || defined(__clang__)
    return __builtin_popcount(x);
#else
    int count = 0;
    for (; x; x &= x - 1) ++count;
    return count;
#endif
}

template <int n>
inline Variations count_variations(const double* b, double noise) {
    Variations out{0, 0, true, 0};
    unsigned above = 0, below = 0;
    for_each_pack(n + 1, [&](auto pack, int i) {
        const auto part = load_lanes<decltype(pack)>(b + i, n + 1 - i);
        above |= bits_of(part > noise) << i;
        below |= bits_of(part < -noise) << i;
    });
    constexpr unsigned all = (1u << (n + 1)) - 1;
    above &= all;
    below &= all;
    if (above == all || below == all) return out;
    for (int i = 0; i <= n; ++i) out.largest = max(out.largest, std::fabs(b[i]));
    const unsigned known = above | below;
    out.ends_known = (known & 1) && (known >> n & 1);
    if (known == all) {
        out.count = out.most = count_bits((above ^ above >> 1) & all >> 1);
        return out;
    }
    int last = 0, unknown = 0;
    for (int i = 0; i <= n; ++i) {
        const int sign = int(above >> i & 1) - int(below >> i & 1);
        if (sign == 0) {
            ++unknown;
            continue;
        }
        const bool changes = last != 0 && sign != last;
        out.count += changes;
        // Between known signs the unknown ones add an even number of changes, outside of them any number.
        out.most += last == 0 ? unknown : changes + (unknown + !changes) / 2 * 2;
        last = sign;
        unknown = 0;
    }
    out.most += unknown;
    return out;
}

template <int n>
struct BinomialRow {
    double c[n + 1];
    constexpr BinomialRow() : c{} {
        c[0] = 1;
        for (int i = 0; i < n; ++i) c[i + 1] = c[i] * (n - i) / (i + 1);
    }
};

// Σ a_i xⁱ (1 − x)ⁿ⁻ⁱ.
template <int n, class V>
CSPACE_INLINE V scaled_bernstein(const V* a, V x) {
    const V rest = 1.0 - x;
    V power = x, sum = a[0] * rest;
    for (int i = 1; i < n; ++i) {
        sum = mul_add(power, a[i], sum) * rest;
        power = power * x;
    }
    return mul_add(power, a[n], sum);
}

// The roots of polynomials that change sign once, one on each lane, by Newton's method inside a bracket; to
// `width`.
template <int n, class V>
CSPACE_NOINLINE V only_roots(const V* b, double width) {
    static constexpr BinomialRow<n> of_value;
    static constexpr BinomialRow<n - 1> of_slope;
    V a[n + 1], d[n];
    for (int i = 0; i <= n; ++i) a[i] = b[i] * of_value.c[i];
    for (int i = 0; i < n; ++i) d[i] = (b[i + 1] - b[i]) * (n * of_slope.c[i]);
    V low = fill_lanes<V>(0.0), high = fill_lanes<V>(1.0), x = 0.25 + 0.5 * (b[0] / (b[0] - b[n]));
    for (int step = 0; step < 60; ++step) {
        const V value = scaled_bernstein<n>(a, x), slope = scaled_bernstein<n - 1>(d, x);
        const mask_of<V> before = value * b[0] > 0.0;
        low = select_lanes(before, x, low);
        high = select_lanes(before, high, x);
        const V newton = x - value / slope;
        const V next = select_lanes((newton >= low) && (newton <= high), newton, 0.5 * (low + high));
        const V moved = abs(next - x);
        x = next;
        if (!any(moved >= width)) break;
    }
    return x;
}

}  // namespace cspace::inline CSPACE_ISA
