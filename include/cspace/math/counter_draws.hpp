// Random numbers keyed by counters: Philox 4×32 with ten rounds (Salmon et al. 2011, "Parallel random
// numbers: as easy as 1, 2, 3"). The draws of a counter depend on nothing else, so the order of a loop, its
// threads and its instruction set do not matter; the normal ones neither, where products and sums are not
// contracted.
#pragma once

#include <cstdint>
#include <numbers>

#include "cspace/math/float_trig.hpp"

namespace cspace {

// Four random words, or the counter that they are made of.
struct FourWords {
    std::uint32_t word[4];
};
// The key of a stream: its seed.
struct DrawKey {
    std::uint32_t word[2];
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

CSPACE_INLINE FourWords draw_words(FourWords counter, DrawKey key) {
    constexpr std::uint64_t multiplier_0 = 0xD2511F53u, multiplier_1 = 0xCD9E8D57u;
    constexpr std::uint32_t weyl_0 = 0x9E3779B9u, weyl_1 = 0xBB67AE85u;
    constexpr int rounds = 10;
    std::uint32_t* c = counter.word;
    for (int k = 0; k < rounds; ++k) {
        const std::uint64_t p = multiplier_0 * c[0], q = multiplier_1 * c[2];
        const std::uint32_t c_0 = std::uint32_t(q >> 32) ^ c[1] ^ key.word[0];
        const std::uint32_t c_2 = std::uint32_t(p >> 32) ^ c[3] ^ key.word[1];
        c[0] = c_0, c[1] = std::uint32_t(q), c[2] = c_2, c[3] = std::uint32_t(p);
        key.word[0] += weyl_0, key.word[1] += weyl_1;
    }
    return counter;
}

// In (0, 1): an odd multiple of 2⁻²⁴.
CSPACE_INLINE float uniform_float(std::uint32_t word) {
    constexpr float last_place = 0x1p-24f;
    return float(std::int32_t(word >> 9) * 2 + 1) * last_place;
}

// The natural logarithm of a float above zero that is not subnormal; the polynomial is that of logf of the
// Cephes library (Moshier 1992).
CSPACE_INLINE float log_float(float x) {
    constexpr std::int32_t root_half = 0x3f3504f3;  // the bits of √½
    const std::int32_t bits = bits_as<std::int32_t>(x), exponent = (bits - root_half) >> 23;
    const float z = bits_as<float>(bits - exponent * (1 << 23)) - 1.0f, e = float(exponent);
    constexpr float c_9 = 7.0376836292e-2f, c_8 = -1.1514610310e-1f, c_7 = 1.1676998740e-1f;
    constexpr float c_6 = -1.2420140846e-1f, c_5 = 1.4249322787e-1f, c_4 = -1.6668057665e-1f;
    constexpr float c_3 = 2.0000714765e-1f, c_2 = -2.4999993993e-1f, c_1 = 3.3333331174e-1f;
    const float high = ((c_9 * z + c_8) * z + c_7) * z + c_6;
    const float p = ((((high * z + c_5) * z + c_4) * z + c_3) * z + c_2) * z + c_1;
    constexpr float ln2 = 0.693147182f;
    const float square = z * z;
    return z + (p * z * square - 0.5f * square) + e * ln2;
}

// Four standard normal numbers for each of eight counters first … first + 7 of a step (Box & Muller 1958).
CSPACE_INLINE void draw_normals(std::uint64_t first, std::uint32_t step, DrawKey key, Floats (&normal)[4]) {
    constexpr float two_pi = float(2 * std::numbers::pi);
    float radius[2][float_lanes], angle[2][float_lanes];
    for (int i = 0; i < float_lanes; ++i) {
        const std::uint64_t n = first + std::uint64_t(i);
        const FourWords drawn = draw_words({{std::uint32_t(n), std::uint32_t(n >> 32), step, 0}}, key);
        for (int k = 0; k < 2; ++k) {
            radius[k][i] = -2.0f * log_float(uniform_float(drawn.word[2 * k]));
            angle[k][i] = two_pi * uniform_float(drawn.word[2 * k + 1]);
        }
    }
    for (int k = 0; k < 2; ++k) {
        Floats sine, cosine;
        sin_cos(load_floats(angle[k]), sine, cosine);
        const Floats r = sqrt(load_floats(radius[k]));
        normal[2 * k] = r * cosine, normal[2 * k + 1] = r * sine;
    }
}

}  // namespace cspace::inline CSPACE_ISA
