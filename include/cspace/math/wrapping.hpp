// Angles modulo 2π.
#pragma once

#include "cspace/math/trig.hpp"

namespace cspace::inline CSPACE_ISA {

// The multiple of 2π nearest to a difference of angles: how many, and the angle.
template <class V>
CSPACE_INLINE V count_turns(V difference) {
    return round(difference * (1 / (2 * pi)));
}
template <class V>
CSPACE_INLINE V nearest_multiple(V difference) {
    return 2 * pi * count_turns(difference);
}
// Of the multiples of 2π that move angles from `least` to `most` between limits, that nearest to `wanted`;
// `none` if there is none.
inline double turns_within(double least, double most, double lower, double upper, double wanted,
                           double none) {
    const double fewest = std::ceil((lower - least) / (2 * pi)), last = std::floor((upper - most) / (2 * pi));
    return fewest <= last ? std::fmin(std::fmax(wanted, fewest), last) : none;
}
// The difference of two angles the short way round, in [−π, π].
template <class V>
CSPACE_INLINE V short_way(V difference) {
    return difference - nearest_multiple(difference);
}
// Brings an angle that is off by at most one turn back into (−π, π].
template <class V>
CSPACE_INLINE V wrap_once(V t) {
    t = select_lanes(t > pi, t - 2 * pi, t);
    return select_lanes(t <= fill_lanes<V>(-pi), t + 2 * pi, t);
}
// The same in floats, in [−π, π] rounded.
inline float wrap_once(float t) {
    constexpr float half_turn = float(pi), turn = float(2 * pi);
    return t > half_turn ? t - turn : t < -half_turn ? t + turn : t;
}
// The angle in (−π, π].
template <class V>
CSPACE_INLINE V wrap_angle(V t) {
    return wrap_once(short_way(t));
}
// The angle in [start, start + 2π). The quotient of an angle just below a multiple of 2π rounds to it.
inline double wrap_above(double t, double start) {
    return max(start, t - 2 * pi * std::floor((t - start) / (2 * pi)));
}

}  // namespace cspace::inline CSPACE_ISA
