// Subproblem 4: rotate a point into a plane.
//
//     min over θ of | hᵀ Rot(k, θ) p − d |
//
// Proof. Rot(k, θ) p = (k·p) k + cos θ p⊥ + sin θ k × p with p⊥ the component of p perpendicular to the axis.
// Its product with h is linear in (cos θ, sin θ):
//     a cos θ + b sin θ = d − (h·k)(k·p),  a = h·p⊥ = (k × h)·(k × p),  b = h·(k × p),
// solved by cos_sin.hpp: two, one or no angle; outside the range, the nearer end of it. If the point lies on
// the axis or the plane is perpendicular to it (a = b = 0), every angle is a solution: 0 is returned and
// `free` is set.
//
// Reference: Elias & Wen 2022, §3.4.
#pragma once

#include "cspace/math/cos_sin.hpp"

namespace cspace::ik {

// theta[0] is always a solution; theta[1] is a second one if `two`, otherwise equal to the first.
template <class V>
struct Sp4 {
    Turn<V> theta[2];
    V error;  // |hᵀ Rot(k, θ) p − d| at the answer
    mask_of<V> two, exact, free;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE Sp4<V> subproblem_4(const Vec3<V>& h, const Vec3<V>& k, const Vec3<V>& p, V d) {
    const Vec3<V> kp = cross(k, p);
    const V size = norm(h) * norm(p);
    const CosSinRoots<V> roots =
        cos_sin_roots(dot(cross(k, h), kp), dot(h, kp), d - dot(h, k) * dot(k, p), size);
    Sp4<V> r;
    r.theta[0] = roots.theta[0];
    r.theta[1] = roots.theta[1];
    r.error = roots.excess;
    r.exact = r.error <= tolerance::exact * max(size, abs(d));
    r.two = roots.two;
    r.free = roots.free;
    return r;
}

}  // namespace cspace::ik::inline CSPACE_ISA
