// A query: the settings of a planner, its search between two points and what it found.
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

// What queries of a world of type W have in common. Each derives from it and has
//   bool find(const W&, start, goal, Trace*)  false where an end is not free; the trace may be null
// and, where it has more than a route, its own
//   settings()   references to what has to be set before, in the order of the package
//   evidence()   what backs the verdict beside path and length: an optional tuple
template <class W, class F = Route>
struct Query {
    using World = W;
    F found;
    double spent = 0;  // [s] by Python for this query

    std::tuple<> settings() { return {}; }
    bool is_concurrent(const W&) const { return true; }  // whether others may ask the world meanwhile
    const Route& route() const {
        if constexpr (requires { found.route; })
            return found.route;
        else
            return found;
    }
};

}  // namespace cspace::navigation
