#include "cspace/ik/redundancy/limits.hpp"
#include "ik_redundancy.hpp"
#include "once.hpp"

namespace cspace::inline CSPACE_ISA {

template ik::LockedArm lock_joints(const ik::Chain&, const int*, int, const double*, bool);
template ik::Solutions solve_arm_quickly(const ik::Arm&, const Posed&);
template ik::Solutions solve_locked(const ik::LockedArm&, const Posed&, const double*, const double*);

void ik_make_redundant(const ik::Chain& chain, const double* lower, const double* upper, const double* weight,
                       ik::Redundant& arm) {
    arm = make_redundant(chain, lower, upper, weight);
}

void ik_lock_joints(const ik::Redundant& arm, const int* joints, int count, ik::LockedArm& out) {
    double typical[ik::max_joints];
    typical_values(arm, typical);
    out = lock_joints(arm.chain, joints, count, typical);
}

void ik_locked(const ik::LockedArm& locked, const Posed& goal, const double* at, const double* unconstrained,
               ik::Solutions& out) {
    out = solve_locked(locked, goal, at, unconstrained);
}

}  // namespace cspace::inline CSPACE_ISA
