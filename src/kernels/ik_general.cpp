#include "ik_general.hpp"

#include "cspace/ik/general/plan.hpp"

namespace cspace::inline CSPACE_ISA {

void plan_general(const ik::Chain& chain, ik::GeneralPlan& plan) { make_general_plan(chain, plan); }

}  // namespace cspace::inline CSPACE_ISA
