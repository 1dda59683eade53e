// Arm angle (swivel) of S-R-S arms: inverse kinematics of arms with two spherical joints and one revolute
// joint between them (Shimizu et al. 2008).
//
// S is the intersection of axes 1, 2, 3. W is the intersection of axes 5, 6, 7. The elbow E is the point of
// axis 4 nearest to S. The goal fixes W, and the distance from S to W fixes q4. E can still move on a circle
// about the line from S to W. The swivel is the angle about that line, directed from S to W, from the
// half-plane through the direction of axis 1 to the half-plane through E. Where S → W is parallel to axis 1,
// `beside` replaces that direction.
#pragma once

#include <initializer_list>

#include "cspace/ik/chain.hpp"
#include "cspace/ik/trig_steps.hpp"
#include "cspace/math/linear.hpp"

namespace cspace::ik {

struct SwivelArm {
    bool applies = false;
    Chain chain;
    Vec3d shoulder, elbow, wrist;  // S, E, W at zero, in base
    Vec3d tip_to_wrist;            // W in the tip
    Vec3d reference, beside;       // directions that the swivel is measured from
    double length = 1;             // [m]
};

inline constexpr int swivel_branches = 8;

template <class V>
struct SwivelSolutions {
    V q[swivel_branches][7];
    mask_of<V> ok[swivel_branches];
};

// Angles of three concurrent axes for a given rotation: two solutions.
template <class V>
struct SphericalTurns {
    Turn<V> turn[2][3];
    mask_of<V> ok;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The point nearest to three axes. away: the largest distance of an axis from it.
inline Vec3d meeting_of(const Chain& chain, int first, double& away) {
    double A[3][3] = {}, b[3] = {};
    for (int i = first; i < first + 3; ++i) {
        const Vec3d &h = chain.axis[i], &p = chain.point[i];
        const double direction[3] = {h.x, h.y, h.z}, point[3] = {p.x, p.y, p.z};
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) {
                const double entry = (r == c) - direction[r] * direction[c];
                A[r][c] += entry;
                b[r] += entry * point[c];
            }
    }
    solve_linear(A, b);
    const Vec3d meeting = {b[0], b[1], b[2]};
    away = 0;
    for (int i = first; i < first + 3; ++i)
        away = max(away, norm(cross(meeting - chain.point[i], chain.axis[i])));
    return meeting;
}

// Sets `applies` where the axes meet to rounding. On an arm that is only approximately S-R-S a swivel is not
// exact.
inline SwivelArm make_swivel_arm(const Chain& chain) {
    constexpr double meets = 1e-12, crosses = 1e-3;
    SwivelArm arm;
    arm.chain = chain;
    if (chain.n != 7) return arm;
    for (int i = 0; i < 7; ++i)
        if (chain.prismatic[i]) return arm;
    arm.length = characteristic_length(chain);
    double off[2];
    arm.shoulder = meeting_of(chain, 0, off[0]);
    arm.wrist = meeting_of(chain, 4, off[1]);
    const Vec3d& h4 = chain.axis[3];
    arm.elbow = chain.point[3] + dot(arm.shoulder - chain.point[3], h4) * h4;
    arm.tip_to_wrist = inverse(chain.tip) * arm.wrist;
    arm.reference = chain.axis[0];
    arm.beside = any_perpendicular(chain.axis[0]);
    bool turns = true;  // both joints are spherical, and the elbow changes the distance
    for (const int i : {0, 1, 4, 5}) turns = turns && norm(cross(chain.axis[i], chain.axis[i + 1])) > crosses;
    const Vec3d upper = arm.shoulder - arm.elbow, fore = arm.wrist - arm.elbow;
    const bool bends = norm(upper) > crosses * arm.length && norm(cross(fore, h4)) > crosses * arm.length;
    arm.applies = turns && bends && off[0] <= meets * arm.length && off[1] <= meets * arm.length;
    return arm;
}

// R = e^{h1 q1} e^{h2 q2} e^{h3 q3}: h1 · R h3 determines q2, R h3 determines q1, and the remaining rotation
// about h3 determines q3.
template <class V>
CSPACE_INLINE SphericalTurns<V> three_turns(const Vec3d* axis, const Mat3<V>& R) {
    const ClosedFormSettings settings;
    const Vec3d along = dot(axis[1], axis[2]) * axis[1];  // the part of h3 that q2 does not change
    const Vec3d lean = axis[2] - along, turned = cross(axis[1], axis[2]);
    const Vec3<V> goal = R * fill_vec3<V>(axis[2]);
    const TwoAngles<V> middle =
        linear_equation<V>(fill_lanes<V>(dot(axis[0], lean)), fill_lanes<V>(dot(axis[0], turned)),
                           dot(fill_vec3<V>(axis[0]), goal) - dot(axis[0], along), 1.0, settings, {1, 0});
    SphericalTurns<V> out;
    out.ok = middle.ok;
    for (int k = 0; k < 2; ++k) {
        out.turn[k][1] = middle.root[k];
        outer_turns(axis, middle.root[k], R, settings.free, out.turn[k][0], out.turn[k][2]);
    }
    return out;
}

// The frame (n, u, n × u) with n along w and u in the direction of e.
template <class V>
CSPACE_INLINE Mat3<V> frame_towards(const Vec3<V>& w, const Vec3<V>& e) {
    const Vec3<V> n = (1.0 / norm(w)) * w;
    const Vec3<V> off = e - dot(e, n) * n;
    const Vec3<V> u = (1.0 / max(norm(off), fill_lanes<V>(tolerance::nonzero))) * off;
    return from_columns(n, u, cross(n, u));
}

// Direction of the elbow's half-plane at swivel zero: perpendicular to w, on the side of the reference.
inline Vec3d swivel_zero(const SwivelArm& arm, const Vec3d& w) {
    constexpr double along = 1e-9;
    const Vec3d n = (1 / norm(w)) * w;
    Vec3d r = arm.reference - dot(arm.reference, n) * n;
    if (norm(r) < along) r = arm.beside - dot(arm.beside, n) * n;
    return (1 / norm(r)) * r;
}

// All solutions of a goal at given swivels, one swivel per lane. Branch 4 i + 2 j + k: elbow, shoulder,
// wrist.
template <class V>
CSPACE_NOINLINE void solve_swivel(const SwivelArm& arm, const Posed& goal, V swivel,
                                  SwivelSolutions<V>& out) {
    const Chain& chain = arm.chain;
    const Vec3d W = goal * arm.tip_to_wrist, w = W - arm.shoulder;
    const Vec3d &h4 = chain.axis[3], fore = arm.wrist - arm.elbow, upper = arm.elbow - arm.shoulder;
    // |upper + e^{h4 q4} fore|² = |w|²
    const Vec3d along = dot(h4, fore) * h4, lean = fore - along;
    const double r = 0.5 * (dot(w, w) - dot(upper, upper) - dot(fore, fore)) - dot(upper, along);
    const TwoAngles<double> bend =
        linear_equation<double>(dot(upper, lean), dot(upper, cross(h4, fore)), r, arm.length * arm.length,
                                ClosedFormSettings{}, {1, 0});
    const bool reaches = bend.ok && norm(w) > tolerance::free_joint * arm.length;
    const Vec3d zero = reaches ? swivel_zero(arm, w) : Vec3d{1, 0, 0};
    const Vec3d n = reaches ? (1 / norm(w)) * w : Vec3d{0, 0, 1};
    const Turn<V> psi = turn_by(swivel);
    const Vec3<V> towards = rotate_about(fill_vec3<V>(n), psi, fill_vec3<V>(zero));
    const Mat3<V> there = from_columns(fill_vec3<V>(n), towards, cross(fill_vec3<V>(n), towards));
    const Mat3d goal_R = goal.R * transpose(chain.tip.R);
    for (int i = 0; i < 2; ++i) {
        const Vec3d bent = rotate_about(h4, bend.root[i], fore);
        const Mat3d here = frame_towards(upper + bent, upper);
        const Mat3<V> R03 = there * fill_mat3<V>(transpose(here));
        const Mat3d R34 = spatial::rotation_about(h4, bend.root[i].c, bend.root[i].s);
        const Mat3<V> R47 = fill_mat3<V>(transpose(R34)) * transpose(R03) * fill_mat3<V>(goal_R);
        const SphericalTurns<V> first = three_turns(&chain.axis[0], R03),
                                last = three_turns(&chain.axis[4], R47);
        for (int j = 0; j < 2; ++j)
            for (int k = 0; k < 2; ++k) {
                const int b = 4 * i + 2 * j + k;
                out.ok[b] = first.ok && last.ok && (fill_lanes<V>(reaches ? 1.0 : 0.0) > 0.0);
                for (int m = 0; m < 3; ++m) {
                    out.q[b][m] = angle_of(first.turn[j][m]);
                    out.q[b][4 + m] = angle_of(last.turn[k][m]);
                }
                out.q[b][3] = fill_lanes<V>(angle_of(bend.root[i]));
            }
    }
}

// The swivel of a configuration.
inline double swivel_of(const SwivelArm& arm, const double* q) {
    const Vec3d e = move_joints(arm.chain, 3, q) * arm.elbow - arm.shoulder;
    const Vec3d w = move_joints(arm.chain, 4, q) * arm.wrist - arm.shoulder;
    const Vec3d n = (1 / norm(w)) * w, zero = swivel_zero(arm, w);
    return std::atan2(dot(n, cross(zero, e)), dot(zero, e));
}

}  // namespace cspace::ik::inline CSPACE_ISA
