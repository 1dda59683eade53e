// Six joints of which three revolute ones make the orientation alone, in up to two ways: a spherical wrist,
// or three revolute joints among three prismatic ones. The other three joints then place a point.
#pragma once

#include <initializer_list>

#include "cspace/ik/chain.hpp"
#include "cspace/ik/dh_form.hpp"
#include "cspace/ik/position/solve.hpp"
#include "cspace/ik/trig_steps.hpp"
#include "cspace/math/linear.hpp"
#include "cspace/math/turn.hpp"

namespace cspace::ik {

// R(h1, q1) R(h2, q2) R(h3, q3) = G; what h1 sees of h3 fixes q2:  a cos q2 + b sin q2 + constant = h1 G h3.
struct ThreeTurns {
    Vec3d h[3];
    double a, b, constant;
};

// `inside` is Δ = a² + b² − k² over a² + b²: negative without a solution, zero where two merge.
struct TurnedTwice {
    int count = 0;
    double q[2][3];
    double inside;
};

struct PositionFirst {
    bool applies = false;
    bool backwards = false;  // the wrist is at the base
    Chain arm;               // all six joints, read so that the wrist comes last
    Chain first;             // three of them, up to the wrist's centre
    Vec3d centre_in_tip;
    ThreeTurns wrist;
};

struct OrientationFirst {
    int turn[3], slide[3];
    ThreeTurns turns;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline ThreeTurns three_turns(const Vec3d& h1, const Vec3d& h2, const Vec3d& h3) {
    ThreeTurns out = {{h1, h2, h3}, 0, 0, dot(h1, h2) * dot(h2, h3)};
    out.a = dot(h1, h3) - out.constant;
    out.b = dot(h1, cross(h2, h3));
    return out;
}

// Whether they make more than a two-parameter set of rotations.
inline bool is_regular(const ThreeTurns& turns) {
    constexpr double least = 1e-12;  // square of a sine: rounded axes bend by less
    return turns.a * turns.a + turns.b * turns.b > least;
}

inline TurnedTwice solve_three_turns(const ThreeTurns& turns, const Mat3d& G) {
    constexpr double slack = 1e-9;  // a double solution may be lost by its square root
    TurnedTwice out;

    const double square = turns.a * turns.a + turns.b * turns.b,
                 k = dot(turns.h[0], G * turns.h[2]) - turns.constant;
    out.inside = (square - k * k) / square;
    if (!(out.inside > -slack)) return out;
    const double root = std::sqrt(max(out.inside, 0.0) / square), along = k / square;
    for (const double sign : {root, -root}) {
        const Turn<double> t2 = {turns.a * along - sign * turns.b, turns.b * along + sign * turns.a};
        double* const q = out.q[out.count++];
        Turn<double> t1, t3;
        outer_turns(turns.h, t2, G, tolerance::free_joint, t1, t3);
        q[0] = angle_of(t1);
        q[1] = angle_of(t2);
        q[2] = angle_of(t3);
        if (root == 0) break;
    }
    return out;
}

// Six joints with a spherical wrist behind three of any kind: these place the wrist's centre, in up to eight
// ways, and the wrist makes the orientation, in two each (Pieper 1968). Or the same read from the tip.

// The point in which the axes of joints 4, 5, 6 meet; false if they do not, up to rounding.
inline bool wrist_centre(const Chain& six, Vec3d& centre) {
    const Vec3d &h4 = six.axis[3], &h5 = six.axis[4], &h6 = six.axis[5];
    const bool parallel = norm(cross(h4, h5)) < tolerance::axis_relation;
    if (parallel || six.prismatic[3] || six.prismatic[4] || six.prismatic[5]) return false;
    centre = common_normal(h4, six.point[3], h5, six.point[4], false, centre).from;
    const auto off = [&](int i) { return norm(cross(centre - six.point[i], six.axis[i])); };
    return max(off(4), off(5)) < tolerance::geometry_exact * 10 && is_regular(three_turns(h4, h5, h6));
}

// For arms with slides, lengths over the arm's; those that only turn have closed forms on lanes.
inline PositionFirst position_first(const Chain& six) {
    PositionFirst out;
    bool slides = false;
    for (int i = 0; i < 6; ++i) slides = slides || six.prismatic[i];
    for (const bool backwards : {false, true}) {
        out.backwards = backwards;
        out.arm = backwards ? reverse_chain(six) : six;
        Vec3d centre;
        if (!slides || !wrist_centre(out.arm, centre)) continue;
        out.applies = true;
        out.first = out.arm;
        out.first.n = 3;
        out.first.tip = {identity_pose().R, centre};
        out.centre_in_tip = inverse(out.arm.tip) * centre;
        out.wrist = three_turns(out.arm.axis[3], out.arm.axis[4], out.arm.axis[5]);
        break;
    }
    return out;
}

// Calls add(q, close) for every solution; close: it may stand close to another. Returns whether any does, or
// a joint is free.
template <class Add>
bool solve_position_first(const PositionFirst& plan, const Posed& goal_of_six, const Add& add) {
    constexpr double merging = 1e-6;
    bool doubt = false;
    const Posed goal = plan.backwards ? inverse(goal_of_six) : goal_of_six;
    const PositionSolutions placed = solve_position(plan.first, goal * plan.centre_in_tip, false);
    for (int k = 0; k < placed.count; ++k) {
        Mat3d G = goal.R * transpose(plan.arm.tip.R);
        for (int i = 0; i < 3; ++i) G = transpose(joint_motion(plan.first, i, placed.q[k][i]).R) * G;
        const TurnedTwice turned = solve_three_turns(plan.wrist, G);
        const bool close = placed.close[k] || turned.inside < merging;
        doubt = doubt || close;
        for (int j = 0; j < turned.count; ++j) {
            double q[6];
            for (int i = 0; i < 6; ++i)
                q[plan.backwards ? 5 - i : i] = i < 3 ? placed.q[k][i] : turned.q[j][i - 3];
            add(q, close);
        }
    }
    return doubt;
}

// Three joints that turn and three that slide, in any order: the turns alone make the orientation, in up to
// two ways, and the slides then follow from three linear equations.

inline OrientationFirst orientation_first(const Chain& chain) {
    OrientationFirst out;
    int turns = 0, slides = 0;
    for (int i = 0; i < 6; ++i) {
        if (chain.prismatic[i])
            out.slide[slides++] = i;
        else
            out.turn[turns++] = i;
    }
    out.turns = three_turns(chain.axis[out.turn[0]], chain.axis[out.turn[1]], chain.axis[out.turn[2]]);
    return out;
}

// The slides that bring the tip to the goal, the turns being as in q. Lowers `volume` to that of the slides'
// directions.
inline bool solve_slides(const Chain& chain, const OrientationFirst& arm, const Posed& goal, double* q,
                         double& volume) {
    for (const int i : arm.slide) q[i] = 0;
    Vec3d D[3];
    int slides = 0;
    const auto keep_direction = [&](int i, const Vec3d& axis, const Vec3d&) {
        if (chain.prismatic[i]) D[slides++] = axis;
    };
    const Vec3d gap = goal.t - (move_joints(chain, 6, q, keep_direction) * chain.tip).t;
    volume = min(volume, std::fabs(dot(D[0], cross(D[1], D[2]))));
    double A[3][3], b[3] = {gap.x, gap.y, gap.z};
    for (int j = 0; j < 3; ++j) A[0][j] = D[j].x, A[1][j] = D[j].y, A[2][j] = D[j].z;
    const bool regular = solve_linear(A, b);
    for (int j = 0; j < 3; ++j) q[arm.slide[j]] = b[j];
    return regular;
}

// Calls add(q, close) as above. Returns whether nothing but these solves the goal.
template <class Add>
bool solve_orientation_first(const Chain& chain, const Posed& goal, const Add& add) {
    constexpr double clear = 1e-9, flat = 1e-9;
    constexpr double merging = 1e-6;  // square of a sine: the two solutions for it nearly meet
    const OrientationFirst arm = orientation_first(chain);
    const TurnedTwice turned = solve_three_turns(arm.turns, goal.R * transpose(chain.tip.R));
    double volume = 1;
    for (int k = 0; k < turned.count; ++k) {
        double q[6];
        for (int i = 0; i < 3; ++i) q[arm.turn[i]] = turned.q[k][i];
        if (solve_slides(chain, arm, goal, q, volume)) add(q, turned.inside < merging);
    }
    return volume > flat && std::fabs(turned.inside) > clear;
}

}  // namespace cspace::ik::inline CSPACE_ISA
