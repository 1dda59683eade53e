// What planners are asked and what they answer. Each is a function
//   bool plan(const Query<W>&, Route& or Answer<…>&, settings…)
// that returns false where an end is not free; its settings come in the order of the package.
#pragma once

#include <cstdint>
#include <optional>
#include <tuple>

#include "cspace/navigation/route.hpp"
#include "maps_grid.hpp"
#include "maps_polygon_world.hpp"

namespace cspace::navigation {

using maps::GridWorld;
using maps::PolygonCore;

// A question about a world of type W; the trace may be null.
template <class W>
struct Query {
    const W& world;
    Point start, goal;
    Trace* trace;
};

// A route and what backs its verdict, where path and length do not say it.
template <class... Evidence>
struct Answer {
    Route route;
    std::optional<std::tuple<Evidence...>> evidence;
    double spent = 0;  // [s] by Python for this query
};
inline const Route& route_of(const Route& route) { return route; }
template <class... Evidence>
const Route& route_of(const Answer<Evidence...>& answer) {
    return answer.route;
}

}  // namespace cspace::navigation
