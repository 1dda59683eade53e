#pragma once

#include "cspace/ik/redundancy/arm_angle.hpp"
#include "dispatch.hpp"

// All solutions of a goal at n swivels: q (n, 8, 7), NaN in rows without a solution.
CSPACE_NARROW_KERNEL(cspace::ik, void, swivel_solutions,
                     (const SwivelArm& arm, const Posed& goal, const double* swivels, int n, double* q))
