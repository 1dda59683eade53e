// The bend of a wrist at a solution of a closed form, and what rounding leaves of it. A wrist that is
// straight to 1e-9 rad hardly moves the tip when it rolls, and yet its bend determines the roll: the solution
// is isolated. Where joints before the wrist are close to a fold, rounding of the goal may turn the bend any
// way, and the roll is free as far as the goal tells.
#pragma once

#include <algorithm>

#include "cspace/ik/closed_form.hpp"
#include "cspace/ik/refine.hpp"
#include "cspace/ik/solution.hpp"

namespace cspace::ik {

// Error of poses and axes, in lengths of the arm.
inline constexpr double pose_noise = 5e-16;

// Distance [rad] by which rounding may move a solution that still counts as known: as at two folds at once.
inline constexpr double most_moved = 1e-3;

// The same of the joints that place the wrist: five times the lever below which a joint counts as free.
inline constexpr double most_misplaced = 1e-4;

// The sine of the angle between the axes that a straight wrist aligns. Rounding of the goal moves the joints
// that place the wrist by `place` [rad], the bend by `blur`, and joints that the wrist places by `placed`.
struct Bend {
    double sine, place, blur, placed = 0;
};

// What a goal leaves open of a branch of a closed form.
enum class Looseness {
    none,        // the solution is isolated
    straight,    // the wrist is so straight that its roll misses the goal by next to nothing
    as_rounded,  // rounding of the goal decides about the roll, or about an elbow that the wrist places
    unknown,     // a joint before the wrist may be free
};

// The axes of an arm at a configuration, in the order of its closed form, and the centre of its wrist.
struct WristPlace {
    Vec3d axis[6], point[6], centre;
    double length;
    double noise;  // error of poses and axes, in lengths of the arm
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Whether the closed form is that of the arm itself, on lanes, or differs from it by no more than solutions
// may miss.
inline bool is_exact(const Plan& plan) {
    return plan.on_lanes && plan.virtual_joints == 0 && plan.form.deviation < tolerance::reached;
}

// How far a root of slope x + ½ curvature x² moves where the equation is known up to `noise`.
inline double blur_of_root(double slope, double curvature, double noise) {
    slope = std::fabs(slope), curvature = std::fabs(curvature);
    return slope * slope > 4 * curvature * noise ? noise / slope : std::sqrt(2 * noise / curvature);
}

// Velocity of the wrist's centre about axis i, in lengths of the arm.
inline Vec3d centre_velocity(const WristPlace& at, int i) {
    return (1 / at.length) * cross(at.axis[i], at.centre - at.point[i]);
}
inline WristPlace place_of_wrist(const Plan& plan, const double* q, double noise) {
    Vec3d axis[6], point[6];
    const auto keep_axis = [&](int i, const Vec3d& h, const Vec3d& p) { axis[i] = h, point[i] = p; };
    move_joints(plan.chain, 6, q, keep_axis);
    WristPlace out;
    for (int i = 0; i < 6; ++i) out.axis[i] = axis[plan.joint[i]], out.point[i] = point[plan.joint[i]];
    out.centre =
        common_normal(out.axis[4], out.point[4], out.axis[5], out.point[5], false, out.point[4]).from;
    out.length = plan.form.length;
    out.noise = noise;
    return out;
}

// How far the joints of a planar arm move, whose end is known up to `noise` along its reach. Where the arm is
// folded back, its first joint moves farther than its elbow.
inline double blur_of_links(const Vec3d& h, const Vec3d& upper, const Vec3d& fore, double noise) {
    return blur_of_root(dot(upper, cross(h, fore)), dot(upper, fore), noise) *
           (1 + norm(fore) / norm(upper + fore));
}

// Axes 2 ∥ 3 ∥ 4: the height of the wrist over their plane moves joint 1. The bend of the wrist determines
// the sum of the parallel joints, and what that leaves of the reach the elbow.
inline Bend bend_behind_shoulder(const WristPlace& at, double sine) {
    const Vec3d &h = at.axis[1], pan = centre_velocity(at, 0);
    const auto in_plane = [&](const Vec3d& v) { return (1 / at.length) * (v - dot(v, h) * h); };
    const double first = blur_of_root(dot(h, pan), dot(h, cross(at.axis[0], pan)), at.noise);
    const double blur = at.noise + first * norm(cross(at.axis[0], at.axis[3]));
    const Vec3d upper = in_plane(at.point[2] - at.point[1]), fore = in_plane(at.point[3] - at.point[2]);
    const Vec3d reach = upper + fore, end = in_plane(at.centre - at.point[3]);
    constexpr double of_sum = 3;  // the sum is known less well than its bend: it is a quotient of two of them
    const double noise = at.noise + of_sum * blur / sine * std::fabs(dot(reach, cross(h, end)));
    return {sine, first, blur, blur_of_links(h, upper, fore, noise) + at.noise / norm(reach)};
}

// Axes 2 ∥ 3: the height of the wrist over their plane moves joint 1, its distance from axis 2 the elbow.
inline Bend bend_behind_parallel(const WristPlace& at, double sine) {
    const Vec3d &h = at.axis[1], pan = centre_velocity(at, 0);
    const auto in_plane = [&](const Vec3d& v) { return v - dot(v, h) * h; };
    const double first = blur_of_root(dot(h, pan), dot(h, cross(at.axis[0], pan)), at.noise);
    const Vec3d upper = (1 / at.length) * in_plane(at.point[2] - at.point[1]),
                fore = (1 / at.length) * in_plane(at.centre - at.point[2]);
    const Vec3d reach = upper + fore, moved = in_plane(pan);
    const double noise = at.noise + first * (std::fabs(dot(reach, moved)) + first * norm(pan));
    const double lift = blur_of_links(h, upper, fore, noise) + (at.noise + first * norm(moved)) / norm(reach);
    return {sine, max(first, lift),
            at.noise + first * norm(cross(at.axis[0], at.axis[3])) + lift * norm(cross(h, at.axis[3]))};
}

// Three joints of any kind, of which at most one direction is weak.
inline Bend bend_behind_three(const WristPlace& at, double sine) {
    constexpr double firm = 1e-4, unknown = 1;
    SmallSvd<3, 3> J{3, 3, {}, {}, {}};
    for (int j = 0; j < 3; ++j) {
        const Vec3d l = centre_velocity(at, j);
        J.us[j][0] = l.x, J.us[j][1] = l.y, J.us[j][2] = l.z;
    }
    decompose_matrix(J);
    const int weak = weakest_direction(J), a = (weak + 1) % 3, b = (weak + 2) % 3;
    if (min(J.sigma[a], J.sigma[b]) < firm) return {sine, unknown, unknown, unknown};
    const auto u = [&](int j) { return (1 / J.sigma[j]) * Vec3d{J.us[j][0], J.us[j][1], J.us[j][2]}; };
    const double* v = J.v[weak];
    Vec3d turn{}, bent{};
    for (int i = 0; i < 3; ++i) {
        turn = turn + v[i] * at.axis[i];
        for (int j = 0; j < 3; ++j)
            bent = bent + v[i] * v[j] * cross(at.axis[std::min(i, j)], centre_velocity(at, std::max(i, j)));
    }
    const double place = blur_of_root(J.sigma[weak], dot(cross(u(a), u(b)), bent), at.noise);
    return {sine, place, at.noise + place * norm(cross(turn, at.axis[3]))};
}

// A wrist that is bent least, but not straight, is at a fold of its middle joint: a change `blur` of the bend
// turns its direction by more. Returns what that adds to the blur.
inline double blur_across(const WristPlace& at, double sine, double blur) {
    const Vec3d &h = at.axis[3], moves = cross(at.axis[4], at.axis[5]);
    const Vec3d across = moves - dot(moves, h) * h;
    const double rate = dot(at.axis[5], across) / sine, aside2 = max(dot(across, across) - rate * rate, 0.0);
    return std::sqrt(aside2) * blur_of_root(rate, aside2 / sine, blur);
}

// At q, a solution of an arm with an exact closed form on lanes.
inline Bend measure_bend(const Plan& plan, const double* q, double noise) {
    const WristPlace at = place_of_wrist(plan, q, noise);
    const double sine = norm(cross(at.axis[3], at.axis[5]));
    Bend out = plan.family == Family::three_parallel                ? bend_behind_shoulder(at, sine)
               : plan.wrist.first.kind == PieperCase::last_parallel ? bend_behind_parallel(at, sine)
                                                                    : bend_behind_three(at, sine);
    out.blur += blur_across(at, sine, out.blur);
    return out;
}

// Whether at q the centre of the wrist lies on axis 1, so that joint 1 turns and the wrist keeps the
// orientation, without being straight on the way. Axes 2 ∥ 3, and a wrist of right angles.
inline bool turns_first_joint(const Plan& plan, const double* q) {
    constexpr double on_axis = 1e-12, apart = 1e-4;
    if (plan.family != Family::spherical_wrist || plan.wrist.first.kind != PieperCase::last_parallel ||
        !plan.wrist.last.right_angled)
        return false;
    const WristPlace at = place_of_wrist(plan, q, pose_noise);
    const Vec3d& h = at.axis[1];
    const auto in_plane = [&](const Vec3d& v) { return (1 / at.length) * (v - dot(v, h) * h); };
    const Vec3d upper = in_plane(at.point[2] - at.point[1]), fore = in_plane(at.centre - at.point[2]);
    const double lift = blur_of_links(h, upper, fore, at.noise) + at.noise / norm(upper + fore);
    const double hand = dot(at.axis[0], at.axis[5]), forearm = dot(at.axis[0], at.axis[3]);
    return norm(centre_velocity(at, 0)) < on_axis && lift < most_misplaced &&
           std::fabs(hand * hand - forearm * forearm) > apart;
}

// The direction in which a straight wrist rolls at q: the axes that it aligns turn against each other.
inline void roll_of_wrist(const Plan& plan, const double* q, double* direction) {
    const WristPlace at = place_of_wrist(plan, q, pose_noise);
    for (int i = 0; i < 6; ++i) direction[i] = 0;
    direction[plan.joint[3]] = std::sqrt(0.5);
    direction[plan.joint[5]] = std::copysign(std::sqrt(0.5), -dot(at.axis[3], at.axis[5]));
}

inline Looseness looseness_of(const Bend& bend, double determined, double misplaced) {
    constexpr double bent = 1.5e-10;  // below, the roll misses the goal by next to nothing
    if (!(bend.place < misplaced)) return Looseness::unknown;
    if (!(bend.blur < determined * bend.sine) || !(bend.placed < most_moved)) return Looseness::as_rounded;
    return bend.sine > bent ? Looseness::none : Looseness::straight;
}

// At q. A closed form that idealises the arm does not move the solution, which is refined, but must not
// confuse it with another one.
inline Looseness looseness_of(const Plan& plan, const double* q) {
    constexpr double rounded = 1e-4, alone = 0.3, beside = 1e-2;  // what may be left open of joints [rad]
    const Looseness out = looseness_of(measure_bend(plan, q, pose_noise), rounded, most_misplaced);
    if (!plan.idealised) return out;
    return std::max(out, looseness_of(measure_bend(plan, q, 4 * plan.form.deviation), alone, beside));
}

// Whether a list with an isolated solution q may be complete.
inline bool leaves_certificate(const Plan& plan, const double* q, Looseness loose) {
    if (loose == Looseness::none || loose == Looseness::straight) return true;
    return plan.family == Family::three_parallel && !(measure_bend(plan, q, pose_noise).placed >= most_moved);
}

// Whether the rows of self-motions cover those of three parallel axes with a free wrist. The sum of their
// angles moves the end of the planar arm of two links round a circle. Where all of the circle is in reach,
// each elbow has a curve. Where the circle leaves the reach, inwards or outwards, the two curves are one.
inline bool covers_curves(const Plan& plan, const Posed& goal_form, const ClosedFormSettings& settings,
                          const Solutions& out) {
    constexpr double same_shoulder = 1e-4, clear = 1e-6;
    const ThreeParallel& arm = plan.parallel;
    const TwoAngles<double> shoulder = shoulder_angles(arm, goal_form.t, settings);
    for (const Turn<double>& t1 : shoulder.root) {
        bool elbow[2] = {};
        const double pan = joint_angle(plan, 0, angle_of(t1));
        for (int k = 0; k < out.count; ++k)
            if (out.self_motion[k] && std::fabs(short_way(out.q[k][plan.joint[0]] - pan)) < same_shoulder)
                elbow[std::sin(plan.sign[2] * out.q[k][plan.joint[2]] + plan.form.offset[2]) > 0] = true;
        if (!elbow[0] && !elbow[1]) continue;
        const Vec3d p = undo_joint(t1, arm.ca1, arm.sa1, goal_form.t);
        const double away = std::hypot(p.x - arm.a1, p.y), radius = std::hypot(arm.x4, arm.y4);
        const double inwards = std::fabs(arm.l2 - arm.l3) - std::fabs(away - radius);
        const double outwards = away + radius - (arm.l2 + arm.l3), margin = clear * arm.length;
        if (min(inwards, outwards) > -margin || std::fabs(away - radius) < margin) return false;
        if (max(inwards, outwards) < margin && !(elbow[0] && elbow[1])) return false;
    }
    return true;
}

}  // namespace cspace::ik::inline CSPACE_ISA
