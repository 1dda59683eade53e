#include "navigation_bugs.hpp"

#include <optional>

#include "cspace/navigation/bugs/bug_1.hpp"
#include "cspace/navigation/bugs/bug_2.hpp"
#include "cspace/navigation/bugs/range_robot.hpp"
#include "cspace/navigation/bugs/tangent_bug.hpp"
#include "navigation_bugs_state.hpp"

namespace cspace::navigation {

namespace {

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
        send_robot(core, start, goal, trip, walk.shut, [&](const Walls& walls, Point from, Point to) {
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

}  // namespace cspace::navigation
