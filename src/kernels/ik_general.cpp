#include "cspace/ik/general/virtual_joints.hpp"
#include "once.hpp"

namespace cspace::ik::inline CSPACE_ISA {

template bool make_general_arm(const Chain&, GeneralArm&);
template bool renumber_general_arm(const GeneralArm&, const Chain&, GeneralArm&);

}  // namespace cspace::ik::inline CSPACE_ISA
