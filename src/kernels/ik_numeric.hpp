#pragma once

#include "cspace/ik/numeric/descent.hpp"
#include "dispatch.hpp"

// Descents on the pose error: see cspace/ik/numeric/descent.hpp.
CSPACE_KERNEL(cspace::ik, void, ik_descend, (const DescentRows& rows))

// One descent per start to one goal: see cspace/ik/numeric/descent.hpp.
CSPACE_KERNEL(cspace::ik, void, ik_many_starts,
              (const Chain& chain, const double* T, const double* starts, std::size_t count, double* q,
               double* residual))
