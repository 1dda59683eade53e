#pragma once

#include "cspace/ik/tracking/follow.hpp"
#include "dispatch.hpp"

// Branches along a path of poses: see cspace/ik/tracking/follow.hpp.
CSPACE_KERNEL(cspace::ik, void, ik_track, (const Track& track))
