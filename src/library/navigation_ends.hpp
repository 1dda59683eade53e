// The ends of a route as they were asked for, where the search took them off a wall: for files of the
// library.
#pragma once

#include "cspace/navigation/route.hpp"

namespace cspace::navigation {

inline void restore_ends(Route& route, Point start, Point goal) {
    if (route.path.empty()) return;
    route.path.front() = start, route.path.back() = goal;
    route.length = length_of(route.path);
}

}  // namespace cspace::navigation
