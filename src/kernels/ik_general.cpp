#include "cspace/ik/arm.hpp"
#include "ik.hpp"
#include "once.hpp"

namespace cspace::ik::inline CSPACE_ISA {

template bool make_general_arm(const Chain&, GeneralArm&);
template bool renumber_general_arm(const GeneralArm&, const Chain&, GeneralArm&);
template bool make_plan(Plan&, const Chain&);
template Arm make_arm(const Chain&, bool);
template PositionSolutions solve_position(const Chain&, const Vec3d&, bool);

void ik_make_arm(const Chain& chain, Arm& arm) { arm = make_arm(chain); }

}  // namespace cspace::ik::inline CSPACE_ISA
