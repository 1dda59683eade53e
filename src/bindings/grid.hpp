// An occupancy grid as Python holds it: cspace.maps.OccupancyGrid is the subclass of its class.
#pragma once

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/grid_frame.hpp"
#include "cspace/maps/grid_parts.hpp"

struct GridWorld {
    cspace::maps::BitGrid bits;
    cspace::maps::GridFrame frame;
    cspace::maps::LazyParts parts{};
};
