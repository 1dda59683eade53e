// Subproblem 1 (Paden–Kahan I): rotate one point onto another.
//
//     min over θ of ‖Rot(k, θ) p1 − p2‖
//
// Proof. A rotation about k keeps the component z = k·p along the axis and the distance ρ = ‖k × p‖ from it,
// and adds θ to the polar angle around it. In these coordinates
//     ‖Rot(k, θ) p1 − p2‖² = (z1 − z2)² + ρ1² + ρ2² − 2 ρ1 ρ2 cos(θ − φ),
// φ being the polar angle from p1 to p2. The minimum is at θ = φ alone, with the error √((z1 − z2)² + (ρ1 −
// ρ2)²); it is zero exactly when p2 lies on the circle of p1. Both k × p1 and k × p2 are the perpendicular
// components rotated by 90°, so ρ1 ρ2 cos φ = (k × p1)·(k × p2) and ρ1 ρ2 sin φ = k·((k × p1) × (k × p2)). If
// ρ1 or ρ2 is zero the error does not depend on θ: every angle is a solution, 0 is returned and `free` is
// set.
//
// Reference: Paden 1986, §4.3; Elias & Wen 2022, §3.1.
#pragma once

#include "cspace/math/cos_sin.hpp"

namespace cspace::ik {

template <class V>
struct Sp1 {
    Turn<V> theta;
    V error;  // ‖Rot(k, θ) p1 − p2‖ at the answer
    mask_of<V> exact, free;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE Sp1<V> subproblem_1(const Vec3<V>& k, const Vec3<V>& p1, const Vec3<V>& p2) {
    const Vec3<V> a = cross(k, p1), b = cross(k, p2);
    const V rho1 = norm(a), rho2 = norm(b), size = max(norm(p1), norm(p2));
    const V along = dot(k, p1) - dot(k, p2), across = rho1 - rho2;
    Sp1<V> r;
    r.free = rho1 <= tolerance::rounding * size || rho2 <= tolerance::rounding * size;
    const V x = dot(a, b), y = dot(k, cross(a, b));
    r.theta = turn_towards(x, y, sqrt(x * x + y * y), r.free);
    r.error = sqrt(along * along + across * across);
    r.exact = r.error <= tolerance::exact * size;
    return r;
}

}  // namespace cspace::ik::inline CSPACE_ISA
