#pragma once

#include "cspace/ik/tracking/follow.hpp"
#include "dispatch.hpp"

// Branches along a path of poses: see cspace/ik/tracking/follow.hpp.
CSPACE_KERNEL(void, ik_track, (const cspace::ik::Track& track))
