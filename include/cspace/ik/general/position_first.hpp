// Six joints with a spherical wrist behind three of any kind: these place the wrist's centre, in up to eight
// ways, and the wrist makes the orientation, in two each (Pieper 1968). Or the same read from the tip.
#pragma once

#include <initializer_list>

#include "cspace/ik/general/three_revolutes.hpp"
#include "cspace/ik/position/solve.hpp"

namespace cspace::ik {

struct PositionFirst {
    bool serves = false;
    bool backwards = false;  // the wrist is at the base
    Chain arm;               // all six joints, read so that the wrist comes last
    Chain first;             // three of them, up to the wrist's centre
    Vec3d centre_in_tip;
    ThreeTurns wrist;
};

struct PlacedAndTurned {
    static constexpr int room = 2 * max_position_solutions;
    int count = 0;
    double q[room][6];
    bool close[room];    // to another one
    bool doubt = false;  // a joint is free, or two solutions merge
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// The point in which the axes of joints 4, 5, 6 meet; false if they do not, up to rounding.
inline bool wrist_centre(const Chain& six, Vec3d& centre) {
    const Vec3d &h4 = six.axis[3], &h5 = six.axis[4], &h6 = six.axis[5];
    const bool parallel = norm(cross(h4, h5)) < tolerance::axis_relation;
    if (parallel || six.prismatic[3] || six.prismatic[4] || six.prismatic[5]) return false;
    const Vec3d n = cross(h4, h5), gap = six.point[4] - six.point[3];
    centre = six.point[3] + (dot(cross(gap, h5), n) / dot(n, n)) * h4;
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
        out.arm = backwards ? reversed(six) : six;
        Vec3d centre;
        if (!slides || !wrist_centre(out.arm, centre)) continue;
        out.serves = true;
        out.first = out.arm;
        out.first.n = 3;
        out.first.tip = {identity_pose().R, centre};
        out.centre_in_tip = inverse(out.arm.tip) * centre;
        out.wrist = three_turns(out.arm.axis[3], out.arm.axis[4], out.arm.axis[5]);
        break;
    }
    return out;
}

inline PlacedAndTurned solve(const PositionFirst& plan, const Posed& goal_of_six) {
    constexpr double merging = 1e-6;
    PlacedAndTurned out;
    const Posed goal = plan.backwards ? inverse(goal_of_six) : goal_of_six;
    const PositionSolutions placed = solve_position(plan.first, goal * plan.centre_in_tip, false);
    for (int k = 0; k < placed.count; ++k) {
        Mat3d G = goal.R * transpose(plan.arm.tip.R);
        for (int i = 0; i < 3; ++i) G = transpose(joint_motion(plan.first, i, placed.q[k][i]).R) * G;
        const TurnedTwice turned = solve(plan.wrist, G);
        const bool close = placed.close[k] || turned.inside < merging;
        out.doubt = out.doubt || close;
        for (int j = 0; j < turned.count; ++j, ++out.count) {
            out.close[out.count] = close;
            for (int i = 0; i < 6; ++i)
                out.q[out.count][plan.backwards ? 5 - i : i] = i < 3 ? placed.q[k][i] : turned.q[j][i - 3];
        }
    }
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
