// The large functions that several kernels call, each compiled in one file per instruction set: a kernel
// includes this file after its headers. Where a function is defined stands beside its name.
#pragma once

#include "cspace/ik/redundancy/turning_points.hpp"

namespace cspace::inline CSPACE_ISA {

// ik_closed_form.cpp
extern template ik::FastPath solve_quickly(const ik::Plan&, const double*, double*, signed char*, int*);
extern template Branches<double> solve_closed_form(const ik::Plan&, const Posed&, const Care&);
// ik_general.cpp
extern template bool make_general_arm(const ik::Chain&, ik::GeneralArm&);
extern template bool renumber_general_arm(const ik::GeneralArm&, const ik::Chain&, ik::GeneralArm&);
// ik_pose.cpp
extern template bool make_plan(ik::Plan&, const ik::Chain&);
extern template bool find_self_motion(const ik::Chain&, const Posed&, double, const double*, const PoseSvd&,
                                      double*);
extern template void accept_solution(ik::Solutions&, const ik::Chain&, const Posed&, double, double*, int,
                                     int);
extern template ik::Arm make_arm(const ik::Chain&, bool);
extern template ik::Solutions solve_pose(const ik::Arm&, const Posed&, const double*);
extern template ik::NearestPose nearest_to_goal(const ik::Arm&, const Posed&, double);
// ik_locked.cpp
extern template ik::LockedArm lock_joints(const ik::Chain&, const int*, int, const double*, bool);
extern template ik::Solutions solve_arm_quickly(const ik::Arm&, const Posed&);
extern template ik::Solutions solve_locked(const ik::LockedArm&, const Posed&, const double*, const double*);
// ik_sweep.cpp
extern template Sweep make_sweep(const ik::LockedArm&, int, const Posed&, const double*);
extern template void branches_at(const Sweep&, Pack<4>, Branches<Pack<4>>&);
extern template FoldValues fold_values(const ik::Redundant&, const Sweep&);
extern template void onto_curve(const ik::Chain&, int, const Posed&, double, CurvePoint&);

}  // namespace cspace::inline CSPACE_ISA
