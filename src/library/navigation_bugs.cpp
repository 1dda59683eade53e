#include "navigation_bugs.hpp"

#include <optional>

#include "cspace/navigation/bugs/bug_1.hpp"
#include "cspace/navigation/bugs/bug_2.hpp"
#include "cspace/navigation/bugs/contact_robot.hpp"
#include "cspace/navigation/bugs/range_robot.hpp"
#include "cspace/navigation/bugs/surroundings.hpp"
#include "cspace/navigation/bugs/tangent_bug.hpp"
#include "cspace/navigation/bugs/voronoi_bug.hpp"
#include "cspace/navigation/bugs/walls.hpp"
#include "maps_polygon_state.hpp"

namespace cspace::navigation {

namespace {

// Calls move(walls, start, goal) with the ends taken off walls, for a trip with a route and a witness; false
// where an end lies in an obstacle.
template <class Trip, class Move>
bool send_robot(const PolygonCore& core, Point start, Point goal, Trip& trip, Walk& walk, const Move& move) {
    PolygonCore::State& state = core.state();
    const maps::Settled from = state.settle(start), to = state.settle(goal);
    if (!from.is_free() || !to.is_free()) return false;
    const Walls& walls = state.walls.get<Walls>(state.world.walls);
    trip = move(walls, from.at, to.at);
    trip.route.path.front() = start;
    if (trip.route.status == Status::found) trip.route.path.back() = goal;
    if (trip.route.status == Status::unreachable)
        walk.shut_ring = walls.ring(trip.witness.in.name), walk.shut_at = trip.witness.at;
    return true;
}

enum Word : std::int8_t { go_word, hit_word, follow_word, leave_word };

// What the walk was made of, in its order: straight ways between stretches along walls.
void list_events(const Trip& trip, Point goal, Trace& events) {
    const std::vector<Point>& path = trip.route.path;
    std::size_t at = 0;
    const auto steps = [&](std::int8_t word, std::size_t end) {
        for (double walked = 0; at < end; ++at) {
            walked += distance(path[at], path[at + 1]);
            events.push_back(
                {word, path[at], path[at + 1], word == follow_word ? walked : distance(path[at + 1], goal)});
        }
    };
    const auto point = [&](std::int8_t word) {
        events.push_back({word, path[at], path[at], distance(path[at], goal)});
    };
    for (const Follow& follow : trip.follows) {
        steps(go_word, follow.first);
        point(hit_word);
        steps(follow_word, follow.last);
        point(leave_word);
    }
    steps(go_word, path.size() - 1);
}

}  // namespace

bool follow_walls(const PolygonCore& core, const WallFollower& robot, Point start, Point goal, WallWalk& walk,
                  Trace* trace) {
    Trip trip;
    const Walls* all = nullptr;
    const bool is_free =
        send_robot(core, start, goal, trip, walk, [&](const Walls& walls, Point from, Point to) {
            all = &walls;
            const Hand hand = robot.side == robot.left ? Hand::left : Hand::right;
            if (robot.kind == robot.tangent_bug) {
                RangeRobot sensing(walls, from, robot.range);
                return tangent_bug(sensing, to, robot.side == robot.either ? std::optional<Hand>() : hand);
            }
            ContactRobot touching(walls, from);
            return robot.kind == robot.bug_1 ? bug_1(touching, to, hand) : bug_2(touching, to, hand);
        });
    if (!is_free) return false;
    if (trace) list_events(trip, goal, *trace);
    for (const Follow& f : trip.follows) {
        walk.hits.push_back(trip.route.path[f.first]);
        walk.leaves.push_back(trip.route.path[f.last]);
        walk.walked.push_back(f.walked);
        walk.rings.push_back(all->ring(f.hit.in.name));
    }
    walk.route = std::move(trip.route);
    return true;
}

bool trace_diagram(const PolygonCore& core, const DiagramTracer& robot, Point start, Point goal,
                   DiagramWalk& walk, Trace* trace) {
    PolygonCore::State& state = core.state();
    Exploration trip;
    const bool is_free =
        send_robot(core, start, goal, trip, walk, [&](const Walls& walls, Point from, Point to) {
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
