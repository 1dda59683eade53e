// An occupancy grid as Python holds it: cspace.maps.OccupancyGrid is the subclass of its class.
#pragma once

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/grid_frame.hpp"

struct GridWorld {
    cspace::maps::BitGrid bits;
    cspace::maps::GridFrame frame;
};
