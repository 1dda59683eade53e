// Subproblems 1, 3 and 4 for a prismatic joint: the rotation Rot(k, θ) p becomes the translation p + x h, h a
// unit vector.
//
//     1  min over x of ‖p1 + x h − p2‖
//     3  min over x of | ‖p1 + x h − p2‖ − d |
//     4  min over x of |nᵀ (p + x h) − d|
//
// Proof. With r = p2 − p1, x0 = h·r and m = ‖h × r‖ the distance of p2 from the line, Pythagoras gives ‖p1 +
// x h − p2‖² = (x − x0)² + m². Hence 1: x = x0, with the error m. 3: x = x0 ± √(d² − m²) for d > m, one
// solution x0 for d = m; for d < m the same x0 is nearest, with the error m − d. 4 is linear: x = (d − n·p) /
// (n·h). If the line is parallel to the plane (n·h = 0), every x is equivalent, 0 is returned and `free` is
// set.
#pragma once

#include "cspace/math/vec.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::ik {

// x[0] is always a solution; x[1] is a second one if `two`, otherwise equal to the first.
template <class V>
struct Slides {
    V x[2];
    V error;  // what is left of the equation at the answer
    mask_of<V> two, exact, free;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE Slides<V> slide_1(const Vec3<V>& h, const Vec3<V>& p1, const Vec3<V>& p2) {
    const Vec3<V> r = p2 - p1;
    const V zero = fill<V>(0.0), x = dot(h, r);
    Slides<V> s;
    s.x[0] = s.x[1] = x;
    s.error = norm(cross(h, r));
    s.exact = s.error <= tolerance::exact * max(norm(p1), norm(p2));
    s.two = s.free = zero > zero;
    return s;
}

template <class V>
CSPACE_INLINE Slides<V> slide_3(const Vec3<V>& h, const Vec3<V>& p1, const Vec3<V>& p2, V d) {
    const V zero = fill<V>(0.0), size = max(max(norm(p1), norm(p2)), abs(d));
    Slides<V> s = slide_1(h, p1, p2);
    const V nearest = s.error;
    s.two = d - nearest > tolerance::rounding * size;
    const V aside = select(s.two, sqrt(max((d - nearest) * (d + nearest), zero)), zero);
    s.x[1] = s.x[0] - aside;
    s.x[0] = s.x[0] + aside;
    s.error = max(nearest - d, zero);
    s.exact = s.error <= tolerance::exact * size;
    return s;
}

template <class V>
CSPACE_INLINE Slides<V> slide_4(const Vec3<V>& n, const Vec3<V>& h, const Vec3<V>& p, V d) {
    const V zero = fill<V>(0.0), one = fill<V>(1.0), along = dot(n, h), missing = d - dot(n, p);
    Slides<V> s;
    s.free = abs(along) <= tolerance::rounding * norm(n);
    s.x[0] = s.x[1] = select(s.free, zero, missing / select(s.free, one, along));
    s.error = select(s.free, abs(missing), zero);
    s.exact = s.error <= tolerance::exact * max(norm(n) * norm(p), abs(d));
    s.two = zero > zero;
    return s;
}

}  // namespace cspace::ik::inline CSPACE_ISA
