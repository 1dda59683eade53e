// Sine and cosine of floats: |x| up to 10,000 rad, absolute error below 1.2e-7 (a unit in the last
// place of 1).
#pragma once

#include "cspace/math/float_lanes.hpp"

namespace cspace::inline CSPACE_ISA {

// x = k π/2 + u with |u| ≤ π/4 after Cody & Waite (1980); the polynomials of sinf and cosf are those of the
// Cephes library (Moshier 1992).
template <class F>
CSPACE_INLINE void sin_cos(F x, F& sine, F& cosine) {
    constexpr float shift = 0x1.8p+23f;  // adding it leaves the nearest integer in the low bits
    constexpr float two_over_pi = 0.636619772f;
    constexpr float half_pi_1 = 0x1.92p+0f, half_pi_2 = 0x1.fb4p-12f, half_pi_3 = 0x1.4442d2p-24f;
    const F shifted = x * two_over_pi + shift, k = shifted - shift;
    const F u = ((x - k * half_pi_1) - k * half_pi_2) - k * half_pi_3, z = u * u;
    constexpr float s_3 = -0x1.555546p-3f, s_5 = 0x1.11073cp-7f, s_7 = -0x1.9943f2p-13f;
    constexpr float c_4 = 0x1.55554ap-5f, c_6 = -0x1.6c0c34p-10f, c_8 = 0x1.99eb9cp-16f;
    const F s = ((z * s_7 + s_5) * z + s_3) * z * u + u;
    const F c = ((z * c_8 + c_6) * z + c_4) * (z * z) - z * 0.5f + 1.0f;
    // The last bit of k swaps the two; bit 1 is the sign of the sine, the sum of both that of the cosine.
    const F low = shift_bits_left<31>(shifted), high = and_bits(shift_bits_left<30>(shifted), 0x80000000u);
    const auto is_odd = xor_bits(low, fill_floats<F>(1.0f)) < 0.0f;
    sine = xor_bits(select_lanes(is_odd, c, s), high);
    cosine = xor_bits(select_lanes(is_odd, s, c), xor_bits(low, high));
}

}  // namespace cspace::inline CSPACE_ISA
