#include "ik_general.hpp"

#include "cspace/ik/general/completion.hpp"

namespace cspace::inline CSPACE_ISA {

bool plan_general(const ik::Chain& chain, ik::GeneralArm& arm) { return make_general_arm(chain, arm); }

}  // namespace cspace::inline CSPACE_ISA
