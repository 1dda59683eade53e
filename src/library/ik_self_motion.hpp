// Self-motions of an arm: the curves of configurations along which the tip keeps its pose, or its position
// alone.
#pragma once

#include <vector>

#include "ik_arm.hpp"

namespace cspace::ik {

// The unit direction of the self-motion through q (dof,); false where there is none.
bool self_motion_direction(const BuiltArm& built, const double* q, bool whole_pose, double* direction);

struct SelfMotionCurve {
    std::vector<double> q, tangents;  // rows of dof
    int end;                          // ik::CurveEnd
};
// The curve through q, from there in a direction.
SelfMotionCurve follow_self_motion(const BuiltArm& built, const double* q, const double* direction,
                                   bool whole_pose);

// Brings k rows onto the curve through q; their tangents on entry say which way it runs. NaN in rows that do
// not arrive.
void project_on_self_motion(const BuiltArm& built, const double* q, bool whole_pose, int k, double* rows,
                            double* tangents);

}  // namespace cspace::ik
