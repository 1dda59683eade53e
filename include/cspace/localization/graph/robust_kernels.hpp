// Robust kernels: a weight and a cost for the squared error s of a measurement that may be false.
#pragma once

#include <algorithm>
#include <cmath>

#include "cspace/localization/graph/options.hpp"

namespace cspace::localization {

struct KernelValue {
    double cost;    // ρ(s); s itself without a kernel
    double weight;  // dρ / ds
};

// width: the error [standard deviations] beyond which the kernel doubts a measurement. Its square takes the
// place of φ in dynamic covariance scaling (Agarwal et al. 2013); the others as in Zhang 1997.
inline KernelValue evaluate_kernel(RobustKernel kernel, double s, double width) {
    const double square = width * width;
    switch (kernel) {
        case RobustKernel::none:
            break;
        case RobustKernel::huber:
            if (s <= square) break;
            return {2 * width * std::sqrt(s) - square, width / std::sqrt(s)};
        case RobustKernel::cauchy:
            return {square * std::log1p(s / square), 1 / (1 + s / square)};
        case RobustKernel::geman_mcclure: {
            const double share = square / (square + s);
            return {s * share, share * share};
        }
        case RobustKernel::tukey: {
            const double share = std::min(1.0, s / square), rest = 1 - share;
            return {square * share * (1 - share + share * share / 3), rest * rest};
        }
        case RobustKernel::dcs: {
            if (s <= square) break;
            const double scale = 2 * square / (square + s);
            return {square * (3 * s - square) / (s + square), scale * scale};
        }
    }
    return {s, 1};
}

}  // namespace cspace::localization
