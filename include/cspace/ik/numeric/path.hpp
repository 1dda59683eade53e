// The kinematic path between a base and a frame for numeric methods: joints of any type, each driven by one
// of up to sixteen coordinates.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/kinematics/forward.hpp"
#include "cspace/model/reduce_joint.hpp"

namespace cspace::ik {

inline constexpr int max_path = 32;  // joints on a path, those that follow another one's coordinate included

struct Path {
    ChainJoint joint[max_path];  // their coordinates are those of the path, 0 to n − 1
    int joints = 0, n = 0;
    Posed T_base_first;
    double cos_last = 1, sin_last = 0;
    bool slides[max_joints] = {};  // of each coordinate: a length, not an angle
    double length = 1;             // typical of the path [m]; a radian weighs like it
};

}  // namespace cspace::ik

namespace cspace::inline CSPACE_ISA {

// The view that cspace/kinematics evaluates.
CSPACE_INLINE Chain view_of(const ik::Path& path) {
    return {path.joint, path.joints, path.n, false, path.T_base_first, path.cos_last, path.sin_last};
}

// The largest distance between consecutive axes, or from an axis to the tip, with every coordinate at zero; 1
// if all intersect.
inline double length_of(const ik::Path& path) {
    double q[ik::max_joints] = {}, s[ik::max_path + 3], c[ik::max_path + 3];
    Vec3d point[ik::max_path + 1], axis[ik::max_path];
    const Chain chain = view_of(path);
    chain_sines(chain, q, s, c);
    const Posed tip =
        follow_chain(chain, path.T_base_first, q, s, c, [&](int i, const Vec3d& p, const Vec3d& d) {
            point[i] = p;
            axis[i] = d;
        });
    point[path.joints] = tip.t;
    double longest = 0;
    for (int i = 0; i < path.joints; ++i) {
        const Vec3d step = point[i + 1] - point[i];
        longest = max(longest, norm(cross(step, axis[i])));
        if (i + 1 < path.joints && !path.joint[i + 1].prismatic)
            longest = max(longest, norm(cross(step, axis[i + 1])));
    }
    return longest > 0 ? longest : 1.0;
}

// A rotation whose third column is the unit vector z.
inline Mat3d turned_to(const Vec3d& z) {
    const Vec3d x = any_perpendicular(z);
    return from_columns(x, cross(z, x), z);
}

// The path of an arm given by its joint axes; joint i is coordinate i.
inline ik::Path path_of(const ik::Chain& chain) {
    ik::Path path;
    path.joints = path.n = chain.n;
    Posed frame[ik::max_joints + 1];  // of each joint at zero, its axis along z
    for (int i = 0; i < chain.n; ++i) frame[i] = {turned_to(chain.axis[i]), chain.point[i]};
    frame[chain.n] = chain.tip;
    path.T_base_first = frame[0];
    double carried = 0;
    for (int i = 0; i < chain.n; ++i) {
        const Joint joint = {frame[i], i - 1, i, 1.0, 0.0, chain.prismatic[i], 0.0};
        path.joint[i] = reduce_joint(joint, inverse(frame[i]) * frame[i + 1], carried);
        path.slides[i] = chain.prismatic[i];
    }
    path.cos_last = std::cos(carried);
    path.sin_last = std::sin(carried);
    path.length = length_of(path);
    return path;
}

}  // namespace cspace::inline CSPACE_ISA
