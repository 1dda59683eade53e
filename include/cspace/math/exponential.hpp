// e^x − 1 and the hyperbolic tangent, over a scalar or a pack of lanes, within some units in the last place.
//
// With x = k ln 2 + r and |r| ≤ ½ ln 2, e^x − 1 = 2^k (e^r − 1) + (2^k − 1) (Muller 2016, section 11.2).
#pragma once

#include "cspace/math/trig.hpp"

namespace cspace::inline CSPACE_ISA {

// (e^r − 1 − r) / r² by its series, for |r| ≤ ½ ln 2; the next term is below the last place.
inline constexpr double exponential[] = {1.0 / 2,       1.0 / 6,        1.0 / 24,        1.0 / 120,
                                         1.0 / 720,     1.0 / 5040,     1.0 / 40320,     1.0 / 362880,
                                         1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
// e^x − 1 for x up to 709; larger ones give that of 709.
template <class V>
CSPACE_INLINE V expm1(V x) {
    constexpr double largest = 709.0, smallest = -60.0;  // e^−60 is lost beside 1
    constexpr double inverse_ln2 = 1.44269504088896338700, ln2_high = 6.93147180369123816490e-01,
                     ln2_low = 1.90821492927058770002e-10;
    x = min(fill_lanes<V>(largest), max(fill_lanes<V>(smallest), x));  // NaN stays
    const V k = round(inverse_ln2 * x);
    const V r = mul_add(k, fill_lanes<V>(-ln2_low), mul_add(k, fill_lanes<V>(-ln2_high), x));
    // The lowest bits of 2^52 + i are those of i, here an exponent.
    constexpr double exponent_of_one = 4503599627370496.0 + 1023.0;
    const V power = shift_bits_left<52>(k + exponent_of_one);
    return mul_add(power, mul_add(r * r, trig::polynomial(exponential, r), r), power - 1.0);
}
template <class V>
CSPACE_INLINE V tanh(V x) {
    constexpr double saturated = 20.0;  // 1 − tanh is then below half a unit in the last place
    const V e = expm1(2.0 * min(fill_lanes<V>(saturated), abs(x)));
    return copysign(e / (e + 2.0), x);
}

}  // namespace cspace::inline CSPACE_ISA
