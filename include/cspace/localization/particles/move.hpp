// Motion of particles: T ← T D exp(w), w normal, drawn per particle and step.
#pragma once

#include <cstdint>

#include "cspace/localization/particles/heading.hpp"
#include "cspace/math/counter_draws.hpp"

namespace cspace::localization {

// A step of odometry and its noise.
struct MotionStep {
    float x, y;            // of D, in the base before [m]
    float cosine, sine;    // of its turn
    Heading turn;          // its turn
    float noise[6];        // rows of the lower triangle L of the covariance L Lᵀ of w = (x, y, θ) [m, rad]
    DrawKey seed;          // of the draws
    std::uint32_t number;  // of the step
};

}  // namespace cspace::localization

namespace cspace::localization::inline CSPACE_ISA {

// Particles first … first + count − 1, of which x, y and headings are given; count is a multiple of eight.
CSPACE_INLINE void move_particles_by(const MotionStep& step, std::uint64_t first, int count, double* x,
                                     double* y, Heading* headings) {
    constexpr float most_turn = 3.1f;  // of noise: more than half a turn has no integer
    const float* L = step.noise;
    for (int i = 0; i < count; i += float_lanes) {
        Floats z[4];
        draw_normals(first + std::uint64_t(i), step.number, step.seed, z);
        const Floats along = z[0] * L[0], aside = z[0] * L[1] + z[1] * L[2];
        const Floats bound = fill_floats(most_turn);
        const Floats turn = max(min(z[0] * L[3] + z[1] * L[4] + z[2] * L[5], bound), -bound);
        // exp(w): sin θ / θ and (1 − cos θ) / θ by their series.
        const Floats t = turn * turn;
        const Floats a = 1.0f - t * (1.0f / 6) * (1.0f - t * (1.0f / 20) * (1.0f - t * (1.0f / 42)));
        const Floats b =
            turn * 0.5f * (1.0f - t * (1.0f / 12) * (1.0f - t * (1.0f / 30) * (1.0f - t * (1.0f / 56))));
        const Floats u = a * along - b * aside, v = b * along + a * aside;
        const Floats forwards = step.x + (u * step.cosine - v * step.sine);
        const Floats sideways = step.y + (u * step.sine + v * step.cosine);
        Floats sine, cosine;
        sin_cos_headings(headings + i, sine, cosine);
        float dx[float_lanes], dy[float_lanes], noise[float_lanes];
        store_floats(dx, cosine * forwards - sine * sideways);
        store_floats(dy, sine * forwards + cosine * sideways);
        store_floats(noise, turn * float(1 / heading_unit));
        for (int k = 0; k < float_lanes; ++k) {
            x[i + k] += double(dx[k]), y[i + k] += double(dy[k]);
            headings[i + k] += step.turn + Heading(std::int32_t(noise[k]));
        }
    }
}

}  // namespace cspace::localization::inline CSPACE_ISA
