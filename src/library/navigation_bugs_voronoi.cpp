#include "cspace/navigation/bugs/surroundings.hpp"
#include "cspace/navigation/bugs/voronoi_bug.hpp"
#include "navigation_bugs_state.hpp"

namespace cspace::navigation {

bool trace_diagram(const PolygonCore& core, const DiagramTracer& robot, Point start, Point goal,
                   DiagramWalk& walk, Trace* trace) {
    PolygonCore::State& state = core.state();
    Exploration trip;
    const bool is_free =
        send_robot(core, start, goal, trip, walk.shut, [&](const Walls& walls, Point from, Point to) {
            Exploration made =
                robot.deviation > 0
                    ? voronoi_bug(walls, from, to, robot.range, {robot.deviation, robot.seed})
                    : voronoi_bug(walls, state.surroundings.get<Surroundings>(state.world.walls), from, to,
                                  robot.range);
            // Else it went through a gap as narrow as a rounding.
            if (made.route.status == Status::found && !can_walk(walls, made.route.path))
                made.route.status = Status::undetermined;
            return made;
        });
    if (!is_free) return false;
    const std::vector<Point>& path = trip.route.path;
    for (const Leg& leg : trip.legs)
        for (std::size_t i = leg.first; trace && i < leg.last; ++i)
            trace->push_back({std::int8_t(leg.move), path[i], path[i + 1], leg.clearance});
    walk.meets = std::move(trip.meets);
    walk.branches = trip.branches, walk.dead_ends = trip.dead_ends, walk.scans = trip.scans;
    walk.clearance = trip.clearance;
    walk.route = std::move(trip.route);
    return true;
}

}  // namespace cspace::navigation
