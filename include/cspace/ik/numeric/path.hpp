// The kinematic path between a base and a frame for numeric methods: joints of any type, each driven by one
// of up to sixteen coordinates.
#pragma once

#include "cspace/ik/chain.hpp"
#include "cspace/kinematics/forward.hpp"
#include "cspace/model/reduce_joint.hpp"

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

// The largest distance between consecutive axes, or from an axis to the tip, with every coordinate at zero; 1
// if all intersect.
inline double length_of(const Path& path) {
    double q[max_joints] = {}, s[max_path + 3], c[max_path + 3];
    Vec3d point[max_path + 1], axis[max_path];
    const model::Chain chain = view_of(path);
    kinematics::chain_sines(chain, q, s, c);
    const Posed tip = kinematics::follow_chain(chain, path.T_base_first, q, s, c,
                                               [&](int i, const Vec3d& p, const Vec3d& d) {
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
inline Path path_of(const Chain& chain) {
    Path path;
    path.joints = path.n = chain.n;
    Posed frame[max_joints + 1];  // of each joint at zero, its axis along z
    for (int i = 0; i < chain.n; ++i) frame[i] = {turned_to(chain.axis[i]), chain.point[i]};
    frame[chain.n] = chain.tip;
    path.T_base_first = frame[0];
    double carried = 0;
    for (int i = 0; i < chain.n; ++i) {
        const model::Joint joint = {frame[i], i - 1, i, 1.0, 0.0, chain.prismatic[i], 0.0};
        path.joint[i] = model::reduce_joint(joint, inverse(frame[i]) * frame[i + 1], carried);
        path.slides[i] = chain.prismatic[i];
    }
    path.cos_last = std::cos(carried);
    path.sin_last = std::sin(carried);
    path.length = length_of(path);
    return path;
}

}  // namespace cspace::ik::inline CSPACE_ISA
