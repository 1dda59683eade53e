#include "ik_pose.hpp"

#include "cspace/ik/arm.hpp"
#include "once.hpp"

namespace cspace::inline CSPACE_ISA {

template bool make_plan(ik::Plan&, const ik::Chain&);
template bool find_self_motion(const ik::Chain&, const Posed&, double, const double*, const PoseSvd&,
                               double*);
template void accept_solution(ik::Solutions&, const ik::Chain&, const Posed&, double, double*, int, int);
template ik::Arm make_arm(const ik::Chain&, bool);
template ik::Solutions solve_pose(const ik::Arm&, const Posed&, const double*);
template ik::NearestPose nearest_to_goal(const ik::Arm&, const Posed&, double);

void ik_make_arm(const ik::Chain& chain, ik::Arm& arm) { arm = make_arm(chain); }

void ik_pose(const ik::Arm& arm, const Posed& goal, const double* unconstrained, ik::Solutions& out) {
    out = solve_pose(arm, goal, unconstrained);
}

void ik_nearest_miss(const ik::Arm& arm, const Posed& goal, double weight, ik::NearestPose& out) {
    out = nearest_to_goal(arm, goal, weight);
}

void ik_position(const ik::Chain& chain, const Vec3d& goal, bool with_nearest, ik::PositionSolutions& out) {
    out = solve_position(chain, goal, with_nearest);
}

}  // namespace cspace::inline CSPACE_ISA
