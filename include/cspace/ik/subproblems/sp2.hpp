// Subproblem 2 (Paden–Kahan II): rotate two points about two axes until they coincide.
//
//     min over θ1, θ2 of ‖Rot(k1, θ1) p1 − Rot(k2, θ2) p2‖
//
// Proof. The squared error is ‖p1‖² + ‖p2‖² − 2 (Rot(k1, θ1) p1)·(Rot(k2, θ2) p2), so only the directions
// matter: let p1 and p2 be unit vectors. They move on two circles of the unit sphere, at the heights c1 =
// k1·p1 over k1 and c2 = k2·p2 over k2. A common point z has k1·z = c1, k2·z = c2, ‖z‖ = 1. With c = k1·k2, s
// = ‖k1 × k2‖, the axes e = (k2 − c k1)/s and n = (k1 × k2)/s complete k1 to a frame, in which
//     z = c1 k1 + y e + γ n,  y = (c2 − c c1)/s,  γ² = 1 − c1² − y².
// γ² > 0: two solutions; γ² = 0: one, the circles touch. γ² < 0: the circles miss each other. Then the
// nearest pair of points lies in the plane of k1 and k2 (the distance on the sphere is smallest on the great
// circle through both poles), each on the side of its axis where the line pair k1·z = c1, k2·z = c2 of that
// plane meets: outside the unit circle, at z = c1 k1 + y e. For y exceeds ρ1 = √(1 − c1²) just when circle 1
// must turn towards k2, and is below −ρ1 when it must turn away; the same holds for circle 2. So z with γ = 0
// gives both angles. In each case θ1 rotates p1 towards z about k1 and θ2 rotates p2 towards z about k2: two
// subproblems 1. For parallel axes (s = 0) only the angle θ1 ∓ θ2 matters: θ2 = 0 is returned with `parallel`
// set.
//
// Reference: Paden 1986, §4.3; Elias & Wen 2022, §3.2.
#pragma once

#include "cspace/ik/subproblems/sp1.hpp"

namespace cspace::ik {

// theta1[0], theta2[0] are always a solution; the second pair is different if `two`.
template <class V>
struct Sp2 {
    Turn<V> theta1[2], theta2[2];
    V error;  // the distance left at the answer
    mask_of<V> two, exact, free1, free2, parallel;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE Sp2<V> subproblem_2(const Vec3<V>& k1, const Vec3<V>& k2, const Vec3<V>& p1,
                                  const Vec3<V>& p2) {
    const V one = fill_lanes<V>(1.0), zero = fill_lanes<V>(0.0);
    const V length1 = norm(p1), length2 = norm(p2);
    const auto nothing = length1 == zero || length2 == zero;
    const Vec3<V> u1 = (1.0 / select_lanes(length1 == zero, one, length1)) * p1;
    const Vec3<V> u2 = (1.0 / select_lanes(length2 == zero, one, length2)) * p2;

    Sp2<V> r;
    const Vec3<V> k1_k2 = cross(k1, k2);
    const V c = dot(k1, k2), s = norm(k1_k2), c1 = dot(k1, u1), c2 = dot(k2, u2);
    const V rho1 = norm(cross(k1, u1)), rho2 = norm(cross(k2, u2));
    r.parallel = s <= tolerance::rounding * one;
    const V inverse = 1.0 / select_lanes(r.parallel, one, s);
    const Vec3<V> n = inverse * k1_k2;
    // Seen from the smaller circle: γ² = (ρ − y)(ρ + y) then loses least.
    const auto second = rho2 < rho1;
    const V y = select_lanes(second, c1 - c * c2, c2 - c * c1) * inverse,
            rho = select_lanes(second, rho2, rho1);
    const V inside = (rho - y) * (rho + y);
    r.two = inside > tolerance::rounding * rho && !r.parallel && !nothing;
    const V gamma = select_lanes(r.two, sqrt(max(inside, zero)), zero);
    const Vec3<V> in_plane = select_lanes(second, c2 * k2 + y * cross(k2, n), c1 * k1 + y * cross(n, k1));

    const Sp1<V> coaxial = subproblem_1(k1, u1, u2);
    for (int i = 0; i < 2; ++i) {
        const Vec3<V> z = i ? in_plane - gamma * n : in_plane + gamma * n;
        const Sp1<V> onto1 = subproblem_1(k1, u1, z), onto2 = subproblem_1(k2, u2, z);
        r.theta1[i] =
            select_lanes(nothing, no_turn<V>(), select_lanes(r.parallel, coaxial.theta, onto1.theta));
        r.theta2[i] = select_lanes(nothing || r.parallel, no_turn<V>(), onto2.theta);
    }
    r.free1 = nothing || rho1 <= tolerance::rounding * one;
    r.free2 = nothing || rho2 <= tolerance::rounding * one;
    r.error = norm(rotate_about(k1, r.theta1[0], p1) - rotate_about(k2, r.theta2[0], p2));
    r.exact = r.error <= tolerance::exact * max(length1, length2);
    return r;
}

}  // namespace cspace::ik::inline CSPACE_ISA
