// The large functions that several kernels call, each compiled in one file per instruction set: a kernel
// includes this file after its headers. Where a function is defined stands beside its name.
#pragma once

#include "cspace/ik/redundancy/turning_points.hpp"

namespace cspace::inline CSPACE_ISA {
extern template void decompose_matrix(SmallSvd<6, ik::max_joints>&, bool);  // ik_self_motion.cpp
}

namespace cspace::ik::inline CSPACE_ISA {

// ik_closed_form.cpp
extern template FastPath solve_fast_path(const Plan&, const double*, double*, signed char*, int*);
extern template Branches<double> solve_closed_form(const Plan&, const Posed&, const ClosedFormSettings&);
// ik_general.cpp
extern template bool make_general_arm(const Chain&, GeneralArm&);
extern template bool renumber_general_arm(const GeneralArm&, const Chain&, GeneralArm&);
extern template bool make_plan(Plan&, const Chain&);
extern template Arm make_arm(const Chain&, bool);
extern template PositionSolutions solve_position(const Chain&, const Vec3d&, bool);
// ik_self_motion.cpp
extern template CurveEnd follow_curve(const Chain&, const TipConstraint&, const double*, const double*,
                                      VisitCurve, int, double);
extern template bool find_self_motion(const Chain&, const Posed&, double, const double*, const PoseSvd&,
                                      double*);
extern template int accept_solution(Solutions&, const Chain&, const Posed&, double, double*, int, int);
// ik_pose.cpp
extern template Solutions solve_pose(const Arm&, const Posed&, const double*);
// ik_locked.cpp
extern template LockedArm lock_joints(const Chain&, const int*, int, const double*, bool);
extern template Solutions solve_arm_quickly(const Arm&, const Posed&);
extern template Solutions solve_locked(const LockedArm&, const Posed&, const double*, const double*);
// ik_sweep.cpp
extern template Sweep make_sweep(const LockedArm&, int, const Posed&, const double*);
extern template void branches_at(const Sweep&, Pack<4>, Branches<Pack<4>>&);
extern template FoldValues fold_values(const Redundant&, const Sweep&);
extern template void onto_curve(const Chain&, int, const Posed&, double, CurvePoint&);
extern template void descend_to_manifold(const Chain&, int, const Posed&, double, double (*)[max_joints], int,
                                         bool*, const DescentRule&);

}  // namespace cspace::ik::inline CSPACE_ISA
