#pragma once

#include "cspace/ik/numeric/descent.hpp"
#include "dispatch.hpp"

// Descents on the pose error: see cspace/ik/numeric/descent.hpp.
CSPACE_KERNEL(void, ik_descend, (const cspace::DescentRows& rows))

// One descent per start to one goal: see cspace/ik/numeric/many_starts.hpp.
CSPACE_KERNEL(void, ik_many_starts,
              (const cspace::ik::Chain& chain, const double* T, const double* starts, std::size_t count,
               double* q, double* residual))
