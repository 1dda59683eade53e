// The kinematic path between a base and a frame for numeric methods: joints of any type, each driven by one
// of up to sixteen coordinates.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/kinematics/jacobian.hpp"

namespace cspace::ik {

inline constexpr int max_path = 32;  // joints on a path, those that follow another one's coordinate included

struct Path {
    model::ChainJoint joint[max_path];  // their coordinates are those of the path, 0 to n − 1
    int joints = 0, n = 0;
    Posed T_base_first;
    double cos_last = 1, sin_last = 0;
    bool slides[max_joints] = {};  // of each coordinate: a length, not an angle
    double length = 1;             // typical of the path [m]; a radian weighs like it
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The view that cspace/kinematics evaluates.
CSPACE_INLINE model::Chain view_of(const Path& path) {
    return {path.joint, path.joints, path.n, false, path.T_base_first, path.cos_last, path.sin_last};
}

// What a unit of coordinate j, a radian or the length of the path, is in radians or metres.
CSPACE_INLINE double unit_of(const Path& path, int j) { return path.slides[j] ? path.length : 1.0; }

// The characteristic length of a path with every coordinate at zero.
inline double length_of(const Path& path) {
    double q[max_joints] = {}, s[max_path + 3], c[max_path + 3];
    kinematics::Axis<double> axes[max_path];
    const Posed tip = kinematics::place_axes(view_of(path), path.T_base_first, q, s, c, axes);
    return largest_offset(
        path.joints, [&](int i) { return axes[i].direction; },
        [&](int i) { return i < path.joints ? axes[i].point : tip.t; },
        [&](int i) { return path.joint[i].prismatic; });
}

}  // namespace cspace::ik::inline CSPACE_ISA
