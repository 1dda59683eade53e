// What robots without a map share: for files of the library, not for bindings.
#pragma once

#include "cspace/navigation/bugs/contact_robot.hpp"
#include "cspace/navigation/bugs/walls.hpp"
#include "maps_polygon_state.hpp"
#include "navigation_bugs.hpp"

namespace cspace::navigation {

// Calls walk(walls, start, goal) with the ends settled, for a trip with a route and a witness; false where an
// end lies in an obstacle.
template <class Trip, class Walk>
bool send_robot(const PolygonCore& core, Point start, Point goal, Trip& trip, ShutOff& shut,
                const Walk& walk) {
    PolygonCore::State& state = core.state();
    const maps::Settled from = state.settle(start), to = state.settle(goal);
    if (!from.is_free() || !to.is_free()) return false;
    const Walls& walls = state.walls.get<Walls>(state.world.walls);
    trip = walk(walls, from.at, to.at);
    trip.route.path.front() = start;
    if (trip.route.status == Status::found) trip.route.path.back() = goal;
    if (trip.route.status == Status::unreachable) shut = {walls.ring(trip.witness.in.name), trip.witness.at};
    return true;
}

}  // namespace cspace::navigation
