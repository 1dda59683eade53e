// The box of configurations in floats: bounds per coordinate; joints that wrap have the period 2π, and their
// values lie between −π and π.
#pragma once

#include <algorithm>
#include <cmath>

#include "cspace/math/wrapping.hpp"

namespace cspace::planning {

struct Box {
    int width = 0;
    const float *lower = nullptr, *upper = nullptr;
    const unsigned char* wraps = nullptr;  // null: no joint does

    bool is_wrapping(int k) const { return wraps && wraps[k]; }

    // From a to b in one coordinate, the short way round.
    float difference(int k, float a, float b) const { return is_wrapping(k) ? wrap_once(b - a) : b - a; }
    float distance(const float* a, const float* b) const {
        float sum = 0;
        for (int k = 0; k < width; ++k) {
            const float d = difference(k, a[k], b[k]);
            sum += d * d;
        }
        return std::sqrt(sum);
    }
    // The configuration at a share of the way from a to b.
    void interpolate(const float* a, const float* b, float share, float* q) const {
        if (!wraps) {
            for (int k = 0; k < width; ++k) q[k] = a[k] + share * (b[k] - a[k]);
            return;
        }
        for (int k = 0; k < width; ++k) {
            const float x = a[k] + share * difference(k, a[k], b[k]);
            q[k] = is_wrapping(k) ? wrap_once(x) : x;
        }
    }
    // The configuration of a point of the unit cube, in a cube around a row.
    void move_within(const float* at, float half_side, const float* unit, float* q) const {
        for (int k = 0; k < width; ++k) {
            const float half = is_wrapping(k) ? std::min(half_side, float(pi)) : half_side;
            const float x = at[k] + half * (2 * unit[k] - 1);
            q[k] = is_wrapping(k) ? wrap_once(x) : std::clamp(x, lower[k], upper[k]);
        }
    }
    // The configuration of a point of the unit cube.
    void scale(const float* unit, float* q) const {
        for (int k = 0; k < width; ++k) q[k] = lower[k] + unit[k] * (upper[k] - lower[k]);
    }
};

}  // namespace cspace::planning
