// Continuation of a curve of solutions: a predictor along the tangent, a test of the corrected point, and a
// step that is halved until the test succeeds (Allgower & Georg 1990, chapter 6).
#pragma once

#include "cspace/math/small_svd.hpp"

namespace cspace::inline CSPACE_ISA {

// Largest part of a step that the corrector may move its end. Curves closer to each other than this cannot be
// distinguished.
inline constexpr double most_correction = 0.1;

// The point at the length h along a curve: from + h tangent + ½ h² bend, n numbers. `to` may be `from`.
CSPACE_INLINE void predict_along(const double* from, const double* tangent, const double* bend, double h,
                                 int n, double* to) {
    for (int i = 0; i < n; ++i) to[i] = from[i] + h * (tangent[i] + 0.5 * h * bend[i]);
}

// Gives a tangent the sense of `along`.
inline void orient_tangent(double* tangent, const double* along, int n) {
    if (dot_n(tangent, along, n) >= 0) return;
    for (int i = 0; i < n; ++i) tangent[i] = -tangent[i];
}

// Halves h until attempt(h) succeeds; false below the shortest.
template <class Attempt>
bool halve_step(double& h, double shortest, const Attempt& attempt) {
    for (; h >= shortest; h *= 0.5)
        if (attempt(h)) return true;
    return false;
}

}  // namespace cspace::inline CSPACE_ISA
