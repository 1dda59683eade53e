// The left Jacobian J(u) of the exponential of rotations, and its inverse, applied to vectors.
//
// Along exp([u]) R the angular velocity is ω = J(u) u'. Transposed they are those of −u (Chirikjian 2012,
// section 10.7; Solà, Deray and Atchuthan 2018).
#pragma once

#include <array>
#include <cmath>

#include "cspace/math/trig.hpp"
#include "cspace/math/vec.hpp"

namespace cspace::spatial::inline CSPACE_ISA {

// The square of a rotation [rad²] below which factors come from their series: their closed forms lose digits
// there, and six terms are exact to rounding.
inline constexpr double small_rotation_square = 0.1;

// f = (1 − cos θ)/θ² and g = (θ − sin θ)/θ³, θ = |u|.
template <class V>
struct LeftJacobianFactors {
    V f, g;
};
template <class V>
CSPACE_INLINE LeftJacobianFactors<V> left_jacobian_factors(V square) {
    constexpr double first[] = {1.0 / 2, -1.0 / 24, 1.0 / 720, -1.0 / 40320, 1.0 / 3628800, -1.0 / 479001600};
    constexpr double second[] = {1.0 / 6,       -1.0 / 120,     1.0 / 5040,
                                 -1.0 / 362880, 1.0 / 39916800, -1.0 / 6227020800};
    const mask_of<V> is_small = square < small_rotation_square;
    const V safe = select_lanes(is_small, fill_lanes<V>(1.0), square), theta = sqrt(safe);
    V s, c;
    sincos(0.5 * theta, s, c);
    const V near = select_lanes(is_small, square, fill_lanes<V>(0.0));
    return {select_lanes(is_small, trig::polynomial(first, near), 2.0 * (s * s) / safe),
            select_lanes(is_small, trig::polynomial(second, near), (1.0 - 2.0 * (s * c) / theta) / safe)};
}
// J(u) a = a + f u × a + g u × (u × a).
template <class V>
CSPACE_INLINE Vec3<V> left_jacobian_times(const Vec3<V>& u, const Vec3<V>& a) {
    const LeftJacobianFactors<V> factors = left_jacobian_factors(dot(u, u));
    const Vec3<V> ua = cross(u, a);
    return a + factors.f * ua + factors.g * cross(u, ua);
}
// (1 − (θ/2) cot(θ/2))/θ² of θ², smooth for less than a full turn.
template <class V>
CSPACE_INLINE V half_cotangent_rest(V square) {
    constexpr double series[] = {1.0 / 12,      1.0 / 720,      1.0 / 30240,
                                 1.0 / 1209600, 1.0 / 47900160, 691.0 / 1307674368000.0};
    const mask_of<V> is_small = square < small_rotation_square;
    if constexpr (Lanes<V>::count == 1) {
        if (is_small) return trig::polynomial(series, square);
    }
    const V safe = select_lanes(is_small, fill_lanes<V>(1.0), square), half = 0.5 * sqrt(safe);
    V s, c;
    sincos(half, s, c);
    const V near = select_lanes(is_small, square, fill_lanes<V>(0.0));
    return select_lanes(is_small, trig::polynomial(series, near), (1.0 - half * c / s) / safe);
}
// J⁻¹(u) a = a − ½ u × a + (1 − (θ/2) cot(θ/2))/θ² u × (u × a), for less than a full turn.
template <class V>
CSPACE_INLINE Vec3<V> left_jacobian_inverse_times(const Vec3<V>& u, const Vec3<V>& a) {
    const Vec3<V> ua = cross(u, a);
    return a - 0.5 * ua + half_cotangent_rest(dot(u, u)) * cross(u, ua);
}
// The derivatives of f and g by θ²; ½ sin θ / θ = ½ (1 − g θ²).
template <class V>
CSPACE_INLINE LeftJacobianFactors<V> left_jacobian_slopes(V square, const LeftJacobianFactors<V>& of) {
    constexpr double first[] = {-1.0 / 24, 2.0 / 720, -3.0 / 40320, 4.0 / 3628800, -5.0 / 479001600};
    constexpr double second[] = {-1.0 / 120, 2.0 / 5040, -3.0 / 362880, 4.0 / 39916800, -5.0 / 6227020800};
    const mask_of<V> is_small = square < small_rotation_square;
    const V near = select_lanes(is_small, square, fill_lanes<V>(0.0)),
            safe = select_lanes(is_small, fill_lanes<V>(1.0), square);
    return {select_lanes(is_small, trig::polynomial(first, near), (0.5 * (1.0 - of.g * safe) - of.f) / safe),
            select_lanes(is_small, trig::polynomial(second, near), (0.5 * of.f - 1.5 * of.g) / safe)};
}

// The angular velocity ω = J(u) u' of exp([u]) R in fixed axes, and its derivative ω'.
template <class V>
struct AngularRates {
    Vec3<V> velocity, acceleration;
};
template <class V>
CSPACE_INLINE AngularRates<V> angular_rates(const Vec3<V>& u, const Vec3<V>& slope, const Vec3<V>& bend) {
    const V square = dot(u, u);
    const LeftJacobianFactors<V> of = left_jacobian_factors(square);
    const auto [f, g] = of;
    const auto [df, dg] = left_jacobian_slopes(square, of);
    const Vec3<V> once = cross(u, slope), twice = cross(u, once), once_rate = cross(u, bend);
    const Vec3<V> twice_rate = cross(slope, once) + cross(u, once_rate);
    return {slope + f * once + g * twice,
            bend + f * once_rate + g * twice_rate + (2.0 * dot(u, slope)) * (df * once + dg * twice)};
}

// That of the plane, V(w) = [[a, −b], [b, a]]: a twist (v, w) moves by V(w) v. c = cos w, s = sin w.
struct PlanarJacobian {
    double a, b;

    PlanarJacobian(double w, double c, double s) {
        constexpr double small = 1e-4;  // where the series is exact to rounding
        const bool is_small = std::fabs(w) < small;
        a = is_small ? 1 - w * w / 6 : s / w;
        b = is_small ? w / 2 - w * w * w / 24 : (1 - c) / w;
    }
    std::array<double, 2> times(const double* v) const { return {a * v[0] - b * v[1], b * v[0] + a * v[1]}; }
};

}  // namespace cspace::spatial::inline CSPACE_ISA
