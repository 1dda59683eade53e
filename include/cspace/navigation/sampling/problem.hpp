// From start to goal in one component of free space: the query of every sampling planner.
#pragma once

#include "cspace/maps/polygon_world.hpp"
#include "cspace/navigation/route.hpp"
#include "cspace/navigation/sampling/sight.hpp"

namespace cspace::navigation::sampling {

struct End {
    Point at;
    std::vector<Index> triangles;  // of the component: several where the point lies on edges
};

struct Problem {
    const maps::PolygonWorld& world;
    Index component;
    End start, goal;

    // The triangle where a segment from an end reaches q, or none.
    Index sight(const End& from, Point q) const {
        for (const Index t : from.triangles) {
            const Index last = end_of_sight(world.space, {from.at, t}, q);
            if (last != none) return last;
        }
        return none;
    }
};

inline Problem problem_of(const maps::PolygonWorld& world, Index component, const maps::Settled& from,
                          const maps::Settled& to) {
    Problem problem{world, component, {from.at, {}}, {to.at, {}}};
    const auto keep = [&](const maps::Settled& settled, End& end) {
        for (const Index t : settled.triangles)
            if (world.space.component[std::size_t(t)] == component) end.triangles.push_back(t);
    };
    keep(from, problem.start), keep(to, problem.goal);
    return problem;
}

enum Kind : std::int8_t { connect, rewire };  // of events

}  // namespace cspace::navigation::sampling
