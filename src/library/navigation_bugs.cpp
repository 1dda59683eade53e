#include "navigation_bugs.hpp"

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
template <class Trip, class Robot, class Move>
bool send_robot(const PolygonCore& core, Point start, Point goal, Trip& trip, Robot& robot,
                const Move& move) {
    PolygonCore::State& state = core.state();
    maps::Settled from, to;
    if (!state.settle(start, goal, from, to)) return false;
    const Walls& walls = state.walls.get<Walls>(state.world.walls);
    trip = move(walls, from.at, to.at);
    Route& route = robot.found = std::move(trip.route);
    route.path.front() = start;
    if (route.status == Status::found) route.path.back() = goal;
    if (route.status == Status::unreachable)
        robot.shut.emplace(walls.ring(trip.witness.in.name), std::pair(trip.witness.at.x, trip.witness.at.y));
    return true;
}

enum Word : std::int8_t { go_word, hit_word, follow_word, leave_word };

// What the walk was made of, in its order: straight ways between stretches along walls.
void list_events(const std::vector<Follow>& follows, const std::vector<Point>& path, Point goal,
                 Trace& events) {
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
    for (const Follow& follow : follows) {
        steps(go_word, follow.first);
        point(hit_word);
        steps(follow_word, follow.last);
        point(leave_word);
    }
    steps(go_word, path.size() - 1);
}

}  // namespace

bool WallQuery::find(const PolygonCore& core, Point start, Point goal, Trace* trace) {
    Trip trip;
    const auto walk = [&](const Walls& walls, Point from, Point to) {
        const Hand hand = side == left ? Hand::left : Hand::right;
        if (kind == tangent_bug) {
            RangeRobot sensing(walls, from, range);
            return navigation::tangent_bug(sensing, to, side == either ? std::optional<Hand>() : hand);
        }
        ContactRobot touching(walls, from);
        return kind == bug_1 ? navigation::bug_1(touching, to, hand) : navigation::bug_2(touching, to, hand);
    };
    if (!send_robot(core, start, goal, trip, *this, walk)) return false;
    if (trace) list_events(trip.follows, found.path, goal, *trace);
    const Walls& walls = core.state().walls.get<Walls>(core.state().world.walls);
    for (const Follow& f : trip.follows) {
        hits.values.push_back(found.path[f.first]);
        leaves.values.push_back(found.path[f.last]);
        walked.values.push_back(f.walked);
        rings.values.push_back(walls.ring(f.hit.in.name));
    }
    return true;
}

bool VoronoiBugQuery::find(const PolygonCore& core, Point start, Point goal, Trace* trace) {
    PolygonCore::State& state = core.state();
    Exploration trip;
    const auto explore = [&](const Walls& walls, Point from, Point to) {
        Exploration made = deviation > 0
                               ? voronoi_bug(walls, from, to, range, {deviation, seed})
                               : voronoi_bug(walls, state.surroundings.get<Surroundings>(state.world.walls),
                                             from, to, range);
        // Else it went through a gap as narrow as a rounding.
        if (made.route.status == Status::found && !can_walk(walls, made.route.path))
            made.route.status = Status::undetermined;
        return made;
    };
    if (!send_robot(core, start, goal, trip, *this, explore)) return false;
    for (const Leg& leg : trip.legs)
        for (std::size_t i = leg.first; trace && i < leg.last; ++i)
            trace->push_back({std::int8_t(leg.move), found.path[i], found.path[i + 1], leg.clearance});
    meets.values = std::move(trip.meets);
    branches = trip.branches, dead_ends = trip.dead_ends, scans = trip.scans;
    clearance = trip.clearance;
    return true;
}

}  // namespace cspace::navigation
