#include "navigation_bugs.hpp"

#include "cspace/navigation/bugs/bug_1.hpp"
#include "cspace/navigation/bugs/bug_2.hpp"
#include "cspace/navigation/bugs/contact_robot.hpp"
#include "cspace/navigation/bugs/range_robot.hpp"
#include "cspace/navigation/bugs/tangent_bug.hpp"
#include "cspace/navigation/bugs/voronoi_bug.hpp"
#include "cspace/navigation/bugs/walls.hpp"
#include "maps_polygon_state.hpp"

namespace cspace::navigation {

namespace {

// Calls move(walls, start, goal) with the ends taken off walls, for a log with a route and a witness; false
// where an end lies in an obstacle.
template <class Log, class Move>
bool send_robot(const Query<PolygonCore>& query, Log& log, Route& route, Shut& shut, const Move& move) {
    PolygonCore::State& state = query.world.state();
    maps::Settled from, to;
    if (!state.settle(query.start, query.goal, from, to)) return false;
    const Walls& walls = state.walls.get<Walls>(state.world.walls);
    log = move(walls, from.at, to.at);
    route = std::move(log.route);
    route.path.front() = query.start;
    if (route.status == Status::found) route.path.back() = query.goal;
    if (route.status == Status::unreachable)
        shut.emplace(walls.ring(log.witness.in.name), std::pair(log.witness.at.x, log.witness.at.y));
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

bool plan_bug(const Query<PolygonCore>& query, WallAnswer& answer, std::int64_t kind, std::int64_t side,
              double range) {
    enum Kind { bug_1, bug_2, tangent_bug };
    enum Side { left, right, either };
    WalkLog log;
    Shut shut;
    const auto walk = [&](const Walls& walls, Point from, Point to) {
        const Hand hand = side == left ? Hand::left : Hand::right;
        if (kind == tangent_bug) {
            RangeRobot sensing(walls, from, range);
            return navigation::tangent_bug(sensing, to, side == either ? std::optional<Hand>() : hand);
        }
        ContactRobot touching(walls, from);
        return kind == bug_1 ? navigation::bug_1(touching, to, hand) : navigation::bug_2(touching, to, hand);
    };
    if (!send_robot(query, log, answer.route, shut, walk)) return false;
    const std::vector<Point>& path = answer.route.path;
    if (query.trace) list_events(log.follows, path, query.goal, *query.trace);
    PolygonCore::State& state = query.world.state();
    const Walls& walls = state.walls.get<Walls>(state.world.walls);
    auto& [hits, leaves, walked, rings, known] = answer.evidence.emplace();
    for (const Follow& f : log.follows) {
        hits.values.push_back(path[f.first]);
        leaves.values.push_back(path[f.last]);
        walked.values.push_back(f.walked);
        rings.values.push_back(walls.ring(f.hit.in.name));
    }
    known = shut;
    return true;
}

bool plan_voronoi_bug(const Query<PolygonCore>& query, VoronoiBugAnswer& answer, double range,
                      double deviation, std::uint64_t seed) {
    PolygonCore::State& state = query.world.state();
    Shut shut;
    Exploration exploration;
    const auto explore = [&](const Walls& walls, Point from, Point to) {
        Exploration made =
            deviation > 0
                ? voronoi_bug(walls, from, to, range, {deviation, seed})
                : voronoi_bug(walls, state.sites.get<voronoi::Sites>(state.world.walls), from, to, range);
        // Else it went through a gap as narrow as a rounding.
        if (made.route.status == Status::found && !can_walk(walls, made.route.path))
            made.route.status = Status::undetermined;
        return made;
    };
    if (!send_robot(query, exploration, answer.route, shut, explore)) return false;
    const std::vector<Point>& path = answer.route.path;
    for (const Leg& leg : exploration.legs)
        for (std::size_t i = leg.first; query.trace && i < leg.last; ++i)
            query.trace->push_back({std::int8_t(leg.move), path[i], path[i + 1], leg.clearance});
    answer.evidence = {Table<Point>{std::move(exploration.meets)},
                       exploration.branches,
                       exploration.dead_ends,
                       exploration.clearance,
                       exploration.scans,
                       shut};
    return true;
}

}  // namespace cspace::navigation
