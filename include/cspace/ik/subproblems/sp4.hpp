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

// `error` is |hᵀ Rot(k, θ) p − d| at the answer.
template <class V>
struct Sp4 : CosSinRoots<V> {
    mask_of<V> exact;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE Sp4<V> subproblem_4(const Vec3<V>& h, const Vec3<V>& k, const Vec3<V>& p, V d) {
    const Vec3<V> kp = cross(k, p);
    const V size = norm(h) * norm(p);
    const CosSinRoots<V> roots =
        cos_sin_roots(dot(cross(k, h), kp), dot(h, kp), d - dot(h, k) * dot(k, p), size);
    return {roots, roots.error <= tolerance::exact * max(size, abs(d))};
}

}  // namespace cspace::ik::inline CSPACE_ISA
