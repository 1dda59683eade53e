// Angles on lanes: sine and cosine together, the angle of a vector, the inverse cosine and sine.
//
// Errors, bounded over the whole range by tests/math/test_trig.py against 80-bit arithmetic: sine and cosine
// 0.85 ulp, atan2 1.5 ulp, acos and asin 1.15 ulp, with and without fused multiply-add. Special values are
// those of C (Annex F). One double is served by a pack of two, where every choice is a selection, not a
// branch.
//
// The polynomials are minimax fits of relative error by tools/minimax.py.
#pragma once

#include <cmath>
#include <type_traits>

#include "cspace/math/far_angle.hpp"
#include "cspace/math/lanes.hpp"

namespace cspace {
inline constexpr double pi = 3.14159265358979323846;
}

namespace cspace::inline CSPACE_ISA {

namespace trig {

// π/2 as a double and its error (2⁻⁵⁴ relative, again as a double).
inline constexpr double half_pi = 0x1.921fb54442d18p+0, half_pi_rest = 0x1.1a62633145c07p-54;

// The largest power of two up to n ≥ 1.
constexpr int largest_power_of_two(int n) { return n < 2 ? 1 : 2 * largest_power_of_two(n / 2); }

template <int n, class V>
CSPACE_INLINE V power_of(V z) {
    if constexpr (n == 1) {
        return z;
    } else {
        return power_of<n / 2>(z) * power_of<n / 2>(z);
    }
}
// c[0] + c[1] z + … of n coefficients by halves (Estrin 1960): short chains keep every unit busy.
template <int n, class V>
CSPACE_INLINE V polynomial(const double* c, V z) {
    if constexpr (n == 1) {
        return fill_lanes<V>(c[0]);
    } else {
        constexpr int half = largest_power_of_two(n - 1);
        return mul_add(polynomial<n - half>(c + half, z), power_of<half>(z), polynomial<half>(c, z));
    }
}
template <int n, class V>
CSPACE_INLINE V polynomial(const double (&c)[n], V z) {
    return mul_add(polynomial<n - 1>(&c[1], z), z,
                   fill_lanes<V>(c[0]));  // the large first term is rounded once
}

// sin u = u + u³ S(u²) and cos u = 1 − u²/2 + u⁴ C(u²) for |u| ≤ π/4; relative error 2⁻⁵⁷, absolute 2⁻⁶⁴.
inline constexpr double sine[] = {-0x1.5555555555548p-3, 0x1.111111110f730p-7,   -0x1.a01a019be920fp-13,
                                  0x1.71de35552a526p-19, -0x1.ae5e4b82c7a53p-26, 0x1.5d8b553bc4fd2p-33};
inline constexpr double cosine[] = {0x1.555555555554cp-5,   -0x1.6c16c16c1521ep-10, 0x1.a01a019cbf281p-16,
                                    -0x1.27e4f812716a5p-22, 0x1.1ee9f11167fecp-29,  -0x1.8fb1062b78871p-37};
// atan t = t + t³ A(t²) for 0 ≤ t ≤ 1; relative error 2⁻⁶⁰.
inline constexpr double arctangent[] = {
    -0x1.555555555554dp-2, 0x1.9999999998c66p-3, -0x1.24924924576e7p-3,  0x1.c71c71b65214cp-4,
    -0x1.745d15d2e3843p-4, 0x1.3b139bed69ac2p-4, -0x1.1110336492e6cp-4,  0x1.e1d4930bdb878p-5,
    -0x1.aeda8938f504bp-5, 0x1.84b515cd3b98ap-5, -0x1.5f264e5356d8fp-5,  0x1.390923ee61cf9p-5,
    -0x1.0c9c855c44433p-5, 0x1.ac8fa9ae256acp-6, -0x1.311369189f84cp-6,  0x1.73070b67cc5eap-7,
    -0x1.700873dcde30ap-8, 0x1.1a385435e659bp-9, -0x1.371de2ef0ee6bp-11, 0x1.b41acbb242d0dp-14,
    -0x1.22b6436abb76ep-17};
// asin p = p + p³ B(p²) for 0 ≤ p ≤ 1/2; relative error 2⁻⁵⁹.
inline constexpr double arcsine[] = {0x1.5555555555577p-3, 0x1.333333332e130p-4, 0x1.6db6db721278dp-5,
                                     0x1.f1c71a94eb95fp-6, 0x1.6e8bdee1210a0p-6, 0x1.1c49f04c0e3a3p-6,
                                     0x1.ca1f8f18f364dp-7, 0x1.75857b6ba31cap-7, 0x1.613cdfc5bdecbp-7,
                                     0x1.e5f069fd94e3fp-9, 0x1.639e0fd471ee4p-6, -0x1.57ffdacc99460p-6,
                                     0x1.0b4781f40221ep-5};

// |x| = k π/2 + u + rest with |u| ≤ π/4. The low bits of `shifted` are those of k.
template <class V>
struct Reduced {
    V u, rest, shifted;
};
inline constexpr double shift = 0x1.8p+52;  // adding it leaves the nearest integer in the low bits

// For |x| ≤ cheap_range, after Cody & Waite (1980). Two parts of π/2 have 37 bits and k has 16, so both
// products are exact, fused or not; so are both differences, but for the last rounding, which `rest` takes
// back. For the double nearest to a multiple of π/2 in this range (45.55…, 6e-19 away) the remainder is still
// right to 2⁻⁵⁶.
inline constexpr double cheap_range = 1e5;
template <class V>
CSPACE_INLINE Reduced<V> reduce_angle(V magnitude) {
    constexpr double part_1 = 0x1.921fb54440000p+0, part_2 = 0x1.68c234c4c0000p-39,
                     part_3 = 0x1.98a2e03707345p-77;
    constexpr double two_over_pi = 0x1.45f306dc9c883p-1;
    const V shifted = mul_add(magnitude, fill_lanes<V>(two_over_pi), fill_lanes<V>(shift));
    const V k = shifted - shift;
    const V t = magnitude - k * part_1;
    const V w = k * part_2;
    const V u = t - w;
    return {u, mul_add(k, fill_lanes<V>(-part_3), (t - u) - w), shifted};
}

// Puts right the lanes beyond the cheap range; infinities and NaN become NaN.
template <class V>
CSPACE_COLD Reduced<V> mend(V magnitude, Reduced<V> r) {
    for (int i = 0; i < Lanes<V>::count; ++i) {
        const double x = get_lane(magnitude, i);
        if (x <= cheap_range) continue;
        const FarAngle far = std::isfinite(x) ? reduce_far(x) : FarAngle{x - x, 0.0, 0};
        set_lane(r.u, i, far.u);
        set_lane(r.rest, i, far.rest);
        set_lane(r.shifted, i, shift + far.quadrant);
    }
    return r;
}

template <class V>
CSPACE_INLINE void sincos_lanes(V x, V& s, V& c) {
    const V magnitude = abs(x);
    Reduced<V> r = reduce_angle(magnitude);
    if (!all(magnitude <= cheap_range)) r = mend(magnitude, r);

    const V u = r.u, z = u * u, half = 0.5 * z;
    const V sine_tail = mul_add(u * z, polynomial(sine, z), mul_add(-r.rest, half, r.rest));
    const V sine_u = u + sine_tail;
    const V one = 1.0 - half;
    const V cosine_rest = mul_add(-u, r.rest, (1.0 - one) - half);
    const V cosine_u = one + mul_add(z * z, polynomial(cosine, z), cosine_rest);

    // The quadrant k mod 4 chooses the function by its low bit and the signs by both.
    const auto odd = lowest_bit(r.shifted);
    const V second_bit = shift_bits_left<62>(r.shifted), first_bit = shift_bits_left<63>(r.shifted);
    s = bit_xor(select_lanes(odd, cosine_u, sine_u), sign_bit(bit_xor(second_bit, x)));
    c = bit_xor(select_lanes(odd, sine_u, cosine_u), sign_bit(bit_xor(second_bit, first_bit)));
}

template <class V>
CSPACE_INLINE V atan2_lanes(V y, V x) {
    const V height = abs(y), width = abs(x);
    const auto steep = height > width;
    // A NaN in either goes into the quotient: min and max return their second argument then.
    const V small = min(height, width), large = max(width, height);
    V t = small / large;
    t = select_lanes(small == large, keep_lanes(large != 0.0, fill_lanes<V>(1.0)),
                     t);  // 0/0 counts as 0, ∞/∞ as 1
    const V z = t * t;

    // The angle from the positive x axis is B π/2 ± atan t: B = 1 where steep, else 0 or 2 by the sign of x.
    const V one = fill_lanes<V>(1.0);
    const V B = 1.0 - keep_lanes(!steep, copysign(one, x));
    const V sign = bit_xor(keep_lanes(steep, fill_lanes<V>(-0.0)), sign_bit(x));
    const V signed_t = bit_xor(t, sign);
    const V low = mul_add(signed_t * z, polynomial(arctangent, z), B * half_pi_rest);
    return bit_or(mul_add(B, fill_lanes<V>(half_pi), signed_t + low), sign_bit(y));
}

// asin |x| = p + cubed B(z), or its complement doubled where |x| > 1/2: z = p², there p²/4 = (1 − |x|)/2.
template <class V>
struct Arcsine {
    mask_of<V> beyond_half;
    V p, cubed, factor;
};
template <class V>
CSPACE_INLINE Arcsine<V> arcsine_parts(V x) {
    const V magnitude = abs(x);
    const auto beyond_half = magnitude > 0.5;
    const V z = select_lanes(beyond_half, 0.5 - 0.5 * magnitude, x * x);
    const V root = sqrt(z);
    const V p = select_lanes(beyond_half, root + root, magnitude);
    return {beyond_half, p, p * z, polynomial(arcsine, z)};
}

// acos x = B π/2 ± asin: B = 1 near zero, else 0 or 2 by the sign of x.
template <class V>
CSPACE_INLINE V acos_lanes(V x) {
    const Arcsine<V> a = arcsine_parts(x);
    const V B = 1.0 - keep_lanes(a.beyond_half, copysign(fill_lanes<V>(1.0), x));
    const V sign = bit_xor(keep_lanes(!a.beyond_half, fill_lanes<V>(-0.0)), sign_bit(x));
    const V low = mul_add(bit_xor(a.cubed, sign), a.factor, B * half_pi_rest);
    return mul_add(B, fill_lanes<V>(half_pi), bit_xor(a.p, sign) + low);
}

// Beyond a half the sum π/2 − p is kept with its rounding error, since the result has smaller ulps.
template <class V>
CSPACE_INLINE V asin_lanes(V x) {
    const Arcsine<V> a = arcsine_parts(x);
    const V high = half_pi - a.p;
    const V lost = (half_pi - high) - a.p;
    const V beyond = high + mul_add(-a.cubed, a.factor, lost + half_pi_rest);
    const V within = mul_add(a.cubed, a.factor, a.p);
    return bit_or(select_lanes(a.beyond_half, beyond, within), sign_bit(x));
}

// One double travels in a register of two lanes where there is one.
#if CSPACE_VECTOR_EXTENSIONS
using Single = Pack<2>;
#else
using Single = double;
#endif
template <class V>
using Carrier = std::conditional_t<Lanes<V>::count == 1, Single, V>;

template <class V>
CSPACE_INLINE Carrier<V> to_carrier(V x) {
    if constexpr (Lanes<V>::count == 1) {
        return fill_lanes<Single>(x);
    } else {
        return x;
    }
}
template <class V>
CSPACE_INLINE V from_carrier(Carrier<V> x) {
    if constexpr (Lanes<V>::count == 1) {
        return get_lane(x, 0);
    } else {
        return x;
    }
}

}  // namespace trig

// Sine and cosine of x.
template <class V>
CSPACE_INLINE void sincos(V x, V& s, V& c) {
    trig::Carrier<V> sine, cosine;
    trig::sincos_lanes(trig::to_carrier(x), sine, cosine);
    s = trig::from_carrier<V>(sine);
    c = trig::from_carrier<V>(cosine);
}
// Passes i, sine and cosine of angle(i) to write, for i < n. Where V is one number, four angles fill the
// lanes.
template <class V, class Angle, class Write>
CSPACE_INLINE void sincos_each(int n, const Angle& angle, const Write& write) {
    if constexpr (Lanes<V>::count == 1) {
        for (int i = 0; i < n; i += 4) {
            auto angles = fill_lanes<Pack<4>>(0.0);
            const int count = n - i < 4 ? n - i : 4;
            for (int k = 0; k < count; ++k) set_lane(angles, k, angle(i + k));
            Pack<4> sines, cosines;
            sincos(angles, sines, cosines);
            for (int k = 0; k < count; ++k) write(i + k, get_lane(sines, k), get_lane(cosines, k));
        }
    } else {
        for (int i = 0; i < n; ++i) {
            V s, c;
            sincos(angle(i), s, c);
            write(i, s, c);
        }
    }
}
// The angle of the vector (x, y) in [−π, π].
template <class V>
CSPACE_INLINE V atan2(V y, V x) {
    return trig::from_carrier<V>(trig::atan2_lanes(trig::to_carrier(y), trig::to_carrier(x)));
}
// The angle in [0, π] with cosine x; NaN beyond ±1.
template <class V>
CSPACE_INLINE V acos(V x) {
    return trig::from_carrier<V>(trig::acos_lanes(trig::to_carrier(x)));
}
// The angle in [−π/2, π/2] with sine x; NaN beyond ±1.
template <class V>
CSPACE_INLINE V asin(V x) {
    return trig::from_carrier<V>(trig::asin_lanes(trig::to_carrier(x)));
}

}  // namespace cspace::inline CSPACE_ISA
