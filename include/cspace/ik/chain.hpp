// Serial chain: the joint axes of an arm at zero, from which the inverse kinematics solvers are built.
#pragma once

#include "cspace/kinematics/jacobian.hpp"
#include "cspace/math/vec.hpp"
#include "cspace/math/wrapping.hpp"
#include "cspace/spatial/rotation.hpp"

namespace cspace::ik {

inline constexpr int max_joints = 16;

// Product of exponentials (Brockett 1984): T_base_tip(q) = e^{ξ1 q1} … e^{ξn qn} tip.
struct Chain {
    int n = 0;
    Vec3d axis[max_joints];   // unit direction at zero, in base
    Vec3d point[max_joints];  // any point on the axis at zero, in base [m]
    bool prismatic[max_joints] = {};
    Posed tip;  // T_base_tip at zero
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The difference of two values of joint i, of a revolute joint the short way round.
template <class V>
CSPACE_INLINE V joint_difference(const Chain& chain, int i, V difference) {
    return chain.prismatic[i] ? difference : short_way(difference);
}
// The value of joint i, of a revolute joint in (−π, π].
inline double wrap_joint(const Chain& chain, int i, double q) {
    return chain.prismatic[i] ? q : wrap_angle(q);
}

// The displacement of joint i by q.
template <class V>
CSPACE_INLINE Pose<V> joint_motion(const Chain& chain, int i, V q) {
    const Vec3<V> h = fill_vec3<V>(chain.axis[i]), p = fill_vec3<V>(chain.point[i]);
    if (chain.prismatic[i]) return {fill_mat3<V>(identity_pose().R), q * h};
    V s, c;
    sincos(q, s, c);
    const Mat3<V> R = spatial::rotation_about(h, c, s);
    return {R, p - R * p};
}

// The displacement of what the first n joints carry. visit(i, axis, point) sees the axis of each joint at q,
// in base.
template <class V, class Visit>
CSPACE_INLINE Pose<V> move_joints(const Chain& chain, int n, const V* q, const Visit& visit) {
    Pose<V> T = fill_pose<V>(identity_pose());
    for (int i = 0; i < n; ++i) {
        const Vec3<V> h = fill_vec3<V>(chain.axis[i]), p = fill_vec3<V>(chain.point[i]);
        const Vec3<V> axis = T.R * h, point = T * p;
        visit(i, axis, point);
        if (chain.prismatic[i]) {
            T.t = T.t + q[i] * axis;
            continue;
        }
        V s, c;
        sincos(q[i], s, c);
        T.R = T.R * spatial::rotation_about(h, c, s);
        T.t = point - T.R * p;
    }
    return T;
}
inline Posed move_joints(const Chain& chain, int n, const double* q) {
    return move_joints(chain, n, q, [](int, const Vec3d&, const Vec3d&) {});
}
inline Posed forward_kinematics(const Chain& chain, const double* q) {
    return move_joints(chain, chain.n, q) * chain.tip;
}

// [Δp / length; rotation vector] from the pose of the tip to a goal, to first order in the rotation. Returns
// the trace of that rotation: 3 at the goal, −1 half a turn from it, where the first order vanishes too.
template <class V>
CSPACE_INLINE V tip_error(const Pose<V>& tip, const Pose<V>& goal, double length, V* error) {
    const Vec3<V> dp = (1 / length) * (goal.t - tip.t), w = spatial::sine_between(tip.R, goal.R);
    error[0] = dp.x, error[1] = dp.y, error[2] = dp.z;
    error[3] = w.x, error[4] = w.y, error[5] = w.z;
    return spatial::trace_between(tip.R, goal.R);
}
// [per_length · v; ω]
template <class V>
CSPACE_INLINE void write_twist(const kinematics::Twist<V>& twist, double per_length, V* out) {
    const Vec3<V> v = per_length * twist.v;
    out[0] = v.x, out[1] = v.y, out[2] = v.z;
    out[3] = twist.w.x, out[4] = twist.w.y, out[5] = twist.w.z;
}

// The same arm from the tip to the base: reverse_chain(chain) at (qn, …, q1) is the inverse of chain at q.
inline Chain reverse_chain(const Chain& chain) {
    const Posed T_tip_base = inverse(chain.tip);
    Chain back;
    back.n = chain.n;
    for (int i = 0; i < chain.n; ++i) {
        const int k = chain.n - 1 - i;
        back.axis[i] = -(T_tip_base.R * chain.axis[k]);
        back.point[i] = T_tip_base * chain.point[k];
        back.prismatic[i] = chain.prismatic[k];
    }
    back.tip = T_tip_base;
    return back;
}

// The largest distance between consecutive axes, or from an axis to the next point. Where that is only
// rounding, the largest distance between consecutive points; 1 if there is none.
// axis(i) (i < n) and point(i) (i ≤ n; the last is the tip) of joints of which slides(i) are prismatic.
template <class AxisOf, class PointOf, class Slides>
double largest_offset(int n, const AxisOf& axis, const PointOf& point, const Slides& slides) {
    constexpr double meeting = 1e-6;  // of the distance between points
    double longest = 0, farthest = 0;
    for (int i = 0; i < n; ++i) {
        const Vec3d step = point(i + 1) - point(i);
        farthest = max(farthest, norm(step));
        longest = max(longest, norm(cross(step, axis(i))));
        if (i + 1 < n && !slides(i + 1)) longest = max(longest, norm(cross(step, axis(i + 1))));
    }
    return longest > meeting * farthest ? longest : farthest > 0 ? farthest : 1.0;
}
// A characteristic length of the arm [m].
inline double characteristic_length(const Chain& chain) {
    return largest_offset(
        chain.n, [&](int i) { return chain.axis[i]; },
        [&](int i) { return i < chain.n ? chain.point[i] : chain.tip.t; },
        [&](int i) { return chain.prismatic[i]; });
}

}  // namespace cspace::ik::inline CSPACE_ISA
