// The time derivative of the Jacobian at given joint velocities: the part of an acceleration that needs no
// force, a = J q̈ + J̇ q̇.
//
// Each column is differentiated directly: ḋ = ω × d for a direction carried by a link that rotates
// with ω, the derivative of [d × (p − o); d] is [ḋ × (p − o) + d × (ṗ − ȯ); ḋ].
#pragma once

#include "cspace/kinematics/jacobian.hpp"

namespace cspace::kinematics::inline CSPACE_ISA {

// The rates of all axes of a chain, and, returned, the twist of the point p at its end. base is the twist
// of the base at p_base; qd contains the joint velocities by coordinate.
template <class V>
CSPACE_INLINE Twist<V> axis_rates(const model::Chain& chain, const Axis<V>* axes, const Vec3<V>& p,
                                  const V* qd, const Twist<V>& base, const Vec3<V>& p_base, Axis<V>* rates) {
    Twist<V> link = base;
    Vec3<V> from = p_base;
    for (int i = 0; i < chain.n; ++i) {
        const Vec3<V>& d = axes[i].direction;
        link.v = link.v + cross(link.w, axes[i].point - from);
        from = axes[i].point;
        rates[i] = {link.v, cross(link.w, d)};
        const V speed = chain.joints[i].ratio * qd[chain.joints[i].coordinate];
        if (chain.joints[i].prismatic) {
            link.v = link.v + speed * d;
        } else {
            link.w = link.w + speed * d;
        }
    }
    link.v = link.v + cross(link.w, p - from);
    return link;
}

// The derivative of joint_twist: the axis and the point p change at the given rates.
template <class V>
CSPACE_INLINE Twist<V> joint_twist_rate(bool prismatic, const Axis<V>& axis, const Axis<V>& rate,
                                        const Vec3<V>& p, const Vec3<V>& p_rate) {
    const V zero = fill_lanes<V>(0.0);
    if (prismatic) return {rate.direction, {zero, zero, zero}};
    return {cross(rate.direction, p - axis.point) + cross(axis.direction, p_rate - rate.point),
            rate.direction};
}

// The columns of the joints of a chain, differentiated.
template <class V>
CSPACE_INLINE void joint_column_rates(const model::Chain& chain, const Axis<V>* axes, const Axis<V>* rates,
                                      const Vec3<V>& p, const Vec3<V>& p_rate, V* J, int columns, int first) {
    sum_columns(chain, J, columns, first, [&](int i) {
        return joint_twist_rate(chain.joints[i].prismatic, axes[i], rates[i], p, p_rate);
    });
}

// The derivative of Rᵀ J, of a frame that turns with w: Rᵀ (J̇ − [w]× J), written over J_rate.
template <class V>
CSPACE_INLINE void express_rate_in(const Mat3<V>& R, const Vec3<V>& w, const V* J, V* J_rate, int columns) {
    for (int j = 0; j < columns; ++j) {
        for (int half = 0; half < 6; half += 3) {
            const Vec3<V> turned = cross(w, get_column(J, columns, j, half));
            put_column(J_rate, columns, j, half,
                       transpose_times(R, get_column(J_rate, columns, j, half) - turned));
        }
    }
}

}  // namespace cspace::kinematics::inline CSPACE_ISA
