#include "cspace/ik/arm.hpp"
#include "ik.hpp"
#include "once.hpp"

namespace cspace::ik::inline CSPACE_ISA {

template Solutions solve_pose(const Arm&, const Posed&, const double*);

void ik_pose(const Arm& arm, const Posed& goal, const double* unconstrained, Solutions& out) {
    out = solve_pose(arm, goal, unconstrained);
}

void ik_nearest_miss(const Arm& arm, const Posed& goal, double weight, NearestPose& out) {
    out = nearest_to_goal(arm, goal, weight);
}

void ik_position(const Chain& chain, const Vec3d& goal, bool with_nearest, PositionSolutions& out) {
    out = solve_position(chain, goal, with_nearest);
}

}  // namespace cspace::ik::inline CSPACE_ISA
