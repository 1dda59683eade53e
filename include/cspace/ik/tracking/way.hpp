// The segment between two poses: its point moves on a straight line, and its rotation about a fixed axis,
// both at constant speed.
#pragma once

#include "cspace/ik/numeric/error.hpp"

namespace cspace::ik {

struct Way {
    Posed from;
    Vec3d step, turn;  // of the whole way: [m] and rotation vector [rad], in base
    double length;     // |step| over the length of the arm + |turn|
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline Way way_between(const Posed& from, const Posed& to, double arm_length) {
    const Vec3d step = to.t - from.t, turn = log_of(to.R * transpose(from.R));
    return {from, step, turn, norm(step) / arm_length + norm(turn)};
}

// The pose at the fraction u of the segment.
inline Posed pose_on(const Way& way, double u) {
    const double angle = norm(way.turn);
    Posed at = {way.from.R, way.from.t + u * way.step};
    if (angle == 0) return at;
    double s, c;
    sincos(u * angle, s, c);
    at.R = rotation_about((1 / angle) * way.turn, c, s) * way.from.R;
    return at;
}

}  // namespace cspace::ik::inline CSPACE_ISA
