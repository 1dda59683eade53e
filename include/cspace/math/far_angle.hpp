// The remainder of a large angle modulo π/2, exact enough for any finite double (Payne & Hanek 1983).
//
// Of x · 2/π only the bits between the quadrant and some way below the leading bit of the fraction matter. So
// a window of 192 bits of 2/π, chosen by the exponent of x, is multiplied by the 53 bits of x in integers.
// The double nearest to a multiple of π/2 is 2⁻⁶¹ away; the window ends at 2⁻¹³⁷. C libraries are not all so
// careful: glibc 2.36 is eight ulp off at 6381956970095103 · 2⁷⁹⁷.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "cspace/math/isa.hpp"

namespace cspace {

// x = (4 n + quadrant) π/2 + u + rest, with |u| ≤ π/4 and rest below the last place of u.
struct FarAngle {
    double u, rest;
    int quadrant;
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {
namespace far {

// 2/π in words of 32 bits, after two words of zeros.
inline constexpr std::uint32_t two_over_pi_words[40] = {
    0x00000000, 0x00000000, 0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041,
    0xfe5163ab, 0xdebbc561, 0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e,
    0xe88235f5, 0x2ebb4484, 0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b,
    0x1ff897ff, 0xde05980f, 0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7, 0x4f463f66, 0x9e5fea2d,
    0x7527bac7, 0xebe5f17b, 0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046, 0xfc7b6bab};

// A number in [0, 1) as a fraction of 2¹⁹², words from the lowest.
struct Fraction {
    std::uint32_t word[6];
};

// The 192 bits of 2/π from the bit of weight 2^-(first + 1) on; first ≥ −64.
inline Fraction two_over_pi_from(int first) {
    const int bit = first + 64, index = bit / 32, shift = bit % 32;
    Fraction w;
    for (int i = 0; i < 6; ++i) {
        const std::uint64_t pair =
            std::uint64_t(two_over_pi_words[index + i]) << 32 | two_over_pi_words[index + i + 1];
        w.word[5 - i] = std::uint32_t(pair << shift >> 32);
    }
    return w;
}
// The product modulo 1.
inline Fraction multiply_fraction(Fraction w, std::uint64_t m) {
    const std::uint64_t part[2] = {m & 0xffffffffu, m >> 32};
    Fraction p = {};
    for (int j = 0; j < 2; ++j) {
        std::uint64_t carry = 0;
        for (int i = 0; i + j < 6; ++i) {
            carry += p.word[i + j] + w.word[i] * part[j];
            p.word[i + j] = std::uint32_t(carry);
            carry >>= 32;
        }
    }
    return p;
}
inline Fraction double_fraction(Fraction f) {
    for (int i = 5; i >= 0; --i) f.word[i] = f.word[i] << 1 | (i > 0 ? f.word[i - 1] >> 31 : 0);
    return f;
}
inline Fraction negate_fraction(Fraction f) {
    std::uint64_t carry = 1;
    for (int i = 0; i < 6; ++i) {
        carry += std::uint32_t(~f.word[i]);
        f.word[i] = std::uint32_t(carry);
        carry >>= 32;
    }
    return f;
}

}  // namespace far

// For 2 ≤ x < ∞.
inline FarAngle reduce_far(double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    const int exponent = int(bits >> 52) - 1075;  // x = m 2^exponent
    const std::uint64_t m = (bits & 0xfffffffffffffu) | 0x10000000000000u;
    // Bits of 2/π that make multiples of four quadrants are left out: the product is (x 2/π mod 4) / 4.
    far::Fraction f = far::multiply_fraction(far::two_over_pi_from(exponent - 2), m);
    int quadrant = int(f.word[5] >> 30);
    f = far::double_fraction(far::double_fraction(f));
    const bool beyond_half = f.word[5] >> 31;
    if (beyond_half) {
        f = far::negate_fraction(f);
        ++quadrant;
    }
    constexpr double half_place = 0x1p-53;  // of a number between one half and one
    double unit = beyond_half ? -half_place : half_place;
    while (!(f.word[5] >> 31)) {
        f = far::double_fraction(f);
        unit *= 0.5;
    }
    // The leading 53 bits and the 53 that follow, times π/2 with both of its parts.
    const std::uint64_t high = std::uint64_t(f.word[5]) << 32 | f.word[4],
                        low = std::uint64_t(f.word[3]) << 32 | f.word[2];
    const double a = double(high >> 11) * unit;
    const double b = double((high << 42 | low >> 22) & 0x1fffffffffffffu) * (unit * half_place);
    constexpr double half_pi = 0x1.921fb54442d18p+0, half_pi_rest = 0x1.1a62633145c07p-54;
    const double u = a * half_pi;
    return {u, std::fma(a, half_pi, -u) + (a * half_pi_rest + b * half_pi), quadrant & 3};
}

}  // namespace cspace::inline CSPACE_ISA
