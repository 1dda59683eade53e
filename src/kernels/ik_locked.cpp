#include "cspace/ik/redundancy/limits.hpp"
#include "ik.hpp"
#include "once.hpp"

namespace cspace::ik::inline CSPACE_ISA {

template LockedArm lock_joints(const Chain&, const int*, int, const double*, bool);
template Solutions solve_arm_quickly(const Arm&, const Posed&);
template Solutions solve_locked(const LockedArm&, const Posed&, const double*, const double*);

void ik_make_redundant(const Chain& chain, const double* lower, const double* upper, const double* weight,
                       Redundant& arm) {
    arm = make_redundant(chain, lower, upper, weight);
}

void ik_lock_joints(const Redundant& arm, const int* joints, int count, LockedArm& out) {
    double typical[max_joints];
    typical_values(arm, typical);
    out = lock_joints(arm.chain, joints, count, typical);
}

void ik_locked(const LockedArm& locked, const Posed& goal, const double* at, const double* unconstrained,
               Solutions& out) {
    out = solve_locked(locked, goal, at, unconstrained);
}

}  // namespace cspace::ik::inline CSPACE_ISA
