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
    const Vec3d step = to.t - from.t, turn = spatial::rotvec_of_rotation(to.R * transpose(from.R));
    return {from, step, turn, norm(step) / arm_length + norm(turn)};
}

// The pose at the fraction u of the segment.
inline Posed pose_on(const Way& way, double u) {
    return {spatial::rotation_of_rotvec(u * way.turn) * way.from.R, way.from.t + u * way.step};
}

}  // namespace cspace::ik::inline CSPACE_ISA
