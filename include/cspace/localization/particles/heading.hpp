// A heading as an integer, 2³² to the full circle: turns add up exactly and wrap by themselves.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "cspace/math/float_trig.hpp"

namespace cspace::localization {

using Heading = std::uint32_t;

inline constexpr double heading_unit = std::numbers::pi / 2147483648.0;  // [rad]

// Angles beyond ±10⁹ rad wrap to another heading, as their last digits are lost.
inline Heading heading_of(double angle) {
    constexpr double whole = 4294967296.0, largest = 1e9;
    const double turns = std::fabs(angle) < largest ? angle / (whole * heading_unit) : 0.0;
    return Heading(std::int64_t(std::floor((turns - std::floor(turns)) * whole + 0.5)));
}
// In (−π, π].
inline double angle_of(Heading heading) {
    const double angle = double(std::int32_t(heading)) * heading_unit;
    return heading == 0x80000000u ? -angle : angle;
}

}  // namespace cspace::localization

namespace cspace::localization::inline CSPACE_ISA {

CSPACE_INLINE void sin_cos_headings(const Heading* headings, Floats& sine, Floats& cosine) {
    float angle[float_lanes];
    for (int i = 0; i < float_lanes; ++i) angle[i] = float(std::int32_t(headings[i])) * float(heading_unit);
    sin_cos(load_floats(angle), sine, cosine);
}

}  // namespace cspace::localization::inline CSPACE_ISA
