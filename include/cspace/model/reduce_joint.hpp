// From a joint and the fixed displacement behind it to the reduced form of cspace/model/chain.hpp.
#pragma once

#include <cmath>

#include "cspace/model/chain.hpp"
#include "cspace/model/tree.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::model {
// R = Rz(first) Rx(α) Rz(last), with cos α and sin α read from R, so that right angles stay exact.
struct TurnTiltTurn {
    double first, cos_alpha, sin_alpha, last;
};
}  // namespace cspace::model

namespace cspace::model::inline CSPACE_ISA {

// The last angle is read from Rz(-first) R, not from R itself: where α is almost zero only the sum of both is
// well defined.
inline TurnTiltTurn turn_tilt_turn(const Mat3d& R) {
    const double sine = std::hypot(R.m[0][2], R.m[1][2]);
    const double first = sine == 0.0 ? 0.0 : std::atan2(R.m[0][2], -R.m[1][2]);
    const double c = std::cos(first), s = std::sin(first);
    const double last = std::atan2(-(c * R.m[0][1] + s * R.m[1][1]), c * R.m[0][0] + s * R.m[1][0]);
    return {first, R.m[2][2], sine, last};
}

// Whether the tilt is one of those that only permute axes, up to the rounding of the rotation it was read
// from.
inline Tilt tilt_of(double cos_alpha, double sin_alpha) {
    if (std::fabs(sin_alpha) <= tolerance::right_angle) return cos_alpha > 0.0 ? Tilt::none : Tilt::half;
    return std::fabs(cos_alpha) <= tolerance::right_angle ? Tilt::quarter : Tilt::any;
}

// `next`: what follows the joint, up to the next one or the frame. carried: the turn ψ that the link before
// left, and on return the one that this link leaves.
inline ChainJoint reduce_joint(const Joint& joint, const Posed& next, double& carried) {
    const TurnTiltTurn r = turn_tilt_turn(next.R);
    const double c = std::cos(r.first), s = std::sin(r.first);
    const double fixed = carried + r.first;
    carried = r.last;
    return {joint.prismatic ? 0.0 : joint.ratio,
            joint.prismatic ? fixed : joint.offset + fixed,
            joint.prismatic ? joint.ratio : 0.0,
            c * next.t.x + s * next.t.y,
            c * next.t.y - s * next.t.x,
            next.t.z + (joint.prismatic ? joint.offset : 0.0),
            r.cos_alpha,
            r.sin_alpha,
            joint.ratio,
            joint.coordinate,
            joint.prismatic,
            tilt_of(r.cos_alpha, r.sin_alpha)};
}

}  // namespace cspace::model::inline CSPACE_ISA
