#include "cspace/ik/general/virtual_joints.hpp"
#include "once.hpp"

namespace cspace::inline CSPACE_ISA {

template bool make_general_arm(const ik::Chain&, ik::GeneralArm&);
template bool renumber_general_arm(const ik::GeneralArm&, const ik::Chain&, ik::GeneralArm&);

}  // namespace cspace::inline CSPACE_ISA
