#pragma once

#include "cspace/ik/general/loop.hpp"
#include "dispatch.hpp"

// The plan of six revolute joints in general position; its `solve` belongs to the same instruction set.
CSPACE_KERNEL(void, plan_general, (const cspace::ik::Chain& chain, cspace::ik::GeneralPlan& plan))
