#pragma once

#include "cspace/ik/general/loop.hpp"
#include "dispatch.hpp"

// The solver of an arm in general position; its `solve` belongs to the same instruction set.
CSPACE_KERNEL(bool, plan_general, (const cspace::ik::Chain& chain, cspace::ik::GeneralArm& arm))
