// Subproblem 3 (Paden–Kahan III): rotate a point to a given distance from another.
//
//     min over θ of | ‖Rot(k, θ) p1 − p2‖ − d |
//
// Proof. In the cylindrical coordinates of subproblem 1 the squared distance is (z1 − z2)² + ρ1² + ρ2² − 2 ρ1
// ρ2 cos(θ − φ): it grows with |θ − φ| from the nearest distance m² = (z1 − z2)² + (ρ1 − ρ2)² at θ = φ to the
// farthest M² = (z1 − z2)² + (ρ1 + ρ2)² at θ = φ + π. Hence there are two solutions θ = φ ± ψ for m < d < M
// and one at either end. Beyond an end, that end is the best. Subtracting the ends, d² − m² = 4 ρ1 ρ2
// sin²(ψ/2) and M² − d² = 4 ρ1 ρ2 cos²(ψ/2), so with S = (d − m)(d + m) and C = (M − d)(M + d): cos ψ = (C −
// S)/(C + S), sin ψ = 2 √(S C)/(C + S). This avoids differences of nearly equal squares, which matters for
// small d. A point on the axis has a constant distance: every angle is a solution, 0 is returned and `free`
// is set.
//
// Reference: Paden 1986, §4.3; Elias & Wen 2022, §3.3.
#pragma once

#include "cspace/ik/subproblems/sp1.hpp"
#include "cspace/ik/subproblems/sp4.hpp"

namespace cspace::ik {

// `error` is | ‖Rot(k, θ) p1 − p2‖ − d | at the answer.
template <class V>
using Sp3 = Sp4<V>;

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

template <class V>
CSPACE_INLINE Sp3<V> subproblem_3(const Vec3<V>& k, const Vec3<V>& p1, const Vec3<V>& p2, V d) {
    const V zero = fill_lanes<V>(0.0), one = fill_lanes<V>(1.0);
    const Sp1<V> towards = subproblem_1(k, p1, p2);
    const V along = dot(k, p1) - dot(k, p2), outer = norm(cross(k, p1)) + norm(cross(k, p2));
    const V nearest = towards.error, farthest = sqrt(along * along + outer * outer);
    const V size = max(max(norm(p1), norm(p2)), abs(d));
    const V S = max((d - nearest) * (d + nearest), zero), C = max((farthest - d) * (farthest + d), zero);

    Sp3<V> r;
    r.free = towards.free;
    r.error = max(max(nearest - d, d - farthest), zero);
    r.exact = r.error <= tolerance::exact * size;
    r.two = d - nearest > tolerance::rounding * size && farthest - d > tolerance::rounding * size && !r.free;
    const V inverse = 1.0 / select_lanes(r.two, C + S, one);
    const V end = select_lanes(d + d < nearest + farthest, one, -one);
    const Turn<V> aside = {select_lanes(r.two, (C - S) * inverse, end),
                           select_lanes(r.two, 2.0 * sqrt(S) * sqrt(C) * inverse, zero)};
    r.theta[0] = select_lanes(r.free, no_turn<V>(), towards.theta + aside);
    r.theta[1] = select_lanes(r.free, no_turn<V>(), towards.theta - aside);
    return r;
}

}  // namespace cspace::ik::inline CSPACE_ISA
