// Angles on lanes: sine and cosine together, the angle of a vector, the inverse cosine.
#pragma once

#include <cmath>

#include "cspace/math/lanes.hpp"

namespace cspace {
inline constexpr double pi = 3.14159265358979323846;
}

namespace cspace::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE void sincos(V x, V& s, V& c) {
    for (int i = 0; i < Lanes<V>::count; ++i) {
        set_lane(s, i, std::sin(lane(x, i)));
        set_lane(c, i, std::cos(lane(x, i)));
    }
}
template <class V>
CSPACE_INLINE V atan2(V y, V x) {
    V r;
    for (int i = 0; i < Lanes<V>::count; ++i) set_lane(r, i, std::atan2(lane(y, i), lane(x, i)));
    return r;
}
template <class V>
CSPACE_INLINE V acos(V x) {
    V r;
    for (int i = 0; i < Lanes<V>::count; ++i) set_lane(r, i, std::acos(lane(x, i)));
    return r;
}

}  // namespace cspace::inline CSPACE_ISA
