// The linear equation of one angle, a cos θ + b sin θ = d.
//
// With r = √(a² + b²) and (a, b) = r (cos φ, sin φ) it reads r cos(θ − φ) = d. So θ = φ ± arccos(d / r): two
// answers for |d| < r, one for |d| = r, none beyond, where θ = φ (d > 0) or φ + π (d < 0) leaves the smallest
// error |d| − r. With r = 0 every angle serves alike.
#pragma once

#include "cspace/math/turn.hpp"
#include "cspace/tolerances.hpp"

namespace cspace {

// theta[0] is always a solution; theta[1] is a second one if `two`, otherwise equal to the first.
template <class V>
struct CosSinRoots {
    Turn<V> theta[2];
    V error;  // max(|d| − r, 0)
    mask_of<V> two, free;
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

// The vector (x, y) of length r > 0 as a turn; no turn where `idle`.
template <class V>
CSPACE_INLINE Turn<V> turn_towards(V x, V y, V r, mask_of<V> idle) {
    const V inverse = 1.0 / select_lanes(idle, fill_lanes<V>(1.0), r);
    return {select_lanes(idle, fill_lanes<V>(1.0), x * inverse),
            select_lanes(idle, fill_lanes<V>(0.0), y * inverse)};
}

// scale: the size of the numbers a and b were made of; r within rounding of it counts as zero.
template <class V>
CSPACE_INLINE CosSinRoots<V> cos_sin_roots(V a, V b, V d, V scale) {
    const V r = sqrt(a * a + b * b), zero = fill_lanes<V>(0.0);
    const V inside = (r - d) * (r + d);
    CosSinRoots<V> roots;
    roots.free = r <= tolerance::rounding * scale;
    roots.two = inside > tolerance::rounding * r * r && !roots.free;
    roots.error = max(abs(d) - r, zero);
    const Turn<V> middle = turn_towards(a, b, r, roots.free);
    const V one_sided = copysign(fill_lanes<V>(1.0), d);
    const V inverse = 1.0 / select_lanes(roots.free, fill_lanes<V>(1.0), r);
    const Turn<V> aside = {select_lanes(roots.two, d * inverse, one_sided),
                           select_lanes(roots.two, sqrt(max(inside, zero)) * inverse, zero)};
    roots.theta[0] = select_lanes(roots.free, middle, middle + aside);
    roots.theta[1] = select_lanes(roots.free, middle, middle - aside);
    return roots;
}

}  // namespace cspace::inline CSPACE_ISA
