// The log of a walk without a map: the points of contact, the walls followed, the points of leaving, and its
// verdict.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/bugs/boundary_tour.hpp"
#include "cspace/navigation/bugs/sensors.hpp"
#include "cspace/navigation/route.hpp"

namespace cspace::navigation {

// One stretch along the boundary: path[first] is the hit point, path[last] the leave point.
struct Follow {
    Touch hit;
    double walked;  // the length of the stretch [m]
    std::size_t first, last;
};

// How it ends: at the goal, where the robot leaves the wall, or where the hit point is met again.
enum class FollowEnd { goal, left, whole };

// The path of the route is what the robot walked, whether or not it found the goal. Of its price, nodes are
// the pieces of wall that it followed and edges the lines.
struct WalkLog {
    Route route;
    std::vector<Follow> follows;
    Touch witness;  // unreachable: where the line to the goal enters a wall that shuts the goal off
};

// Writes the path while the robot moves.
template <ContactSensor Robot>
class Walker {
  public:
    Robot& robot;
    WalkLog log;

    explicit Walker(Robot& r) : robot(r) { log.route.path.push_back(r.position()); }

    bool advance(const Line& line) {
        ++log.route.stats.edges;
        const bool arrived = robot.advance(line, log.route.path);
        note();
        return arrived;
    }
    bool approach(Point target) {
        ++log.route.stats.edges;
        const bool arrived = robot.approach(target, log.route.path);
        note();
        return arrived;
    }
    // Along the wall from a hit point, piece by piece. leaves_piece(piece, from, end) gives the point of a
    // piece at which the robot leaves it, if it does; leaves_corner() says whether it leaves the corner where
    // it stands. The boundary tour, if there is one, is told of all that is passed.
    template <class LeavesPiece, class LeavesCorner>
    FollowEnd follow(Hand hand, Point goal, Round* round, LeavesPiece leaves_piece,
                     LeavesCorner leaves_corner) {
        const Touch hit = robot.touch();
        log.follows.push_back({hit, 0, log.route.path.size() - 1, 0});
        for (bool first = true;; first = false) {
            const Wall piece = wall_ahead(robot.touch(), hand);
            const Point from = robot.position();
            if (is_on(piece, goal)) return stop(hand, goal), FollowEnd::goal;
            const bool last = !first && !hit.is_corner() && piece.name == hit.in.name;
            const std::optional<Point> leave =
                leaves_piece(piece, from, last ? hit.at : far_end(piece, hand));
            if (leave) return stop(hand, *leave), FollowEnd::left;
            if (last)
                stop(hand, hit.at);
            else
                walk(hand);
            if (round) round->add(piece, from, robot.position());
            if (last) return FollowEnd::whole;
            if (round) round->add(robot.touch());
            if (robot.touch().is_place_of(hit)) return FollowEnd::whole;
            if (leaves_corner()) return FollowEnd::left;
        }
    }
    // Along the wall to a place on its ring.
    void go_to(const Touch& target, Hand hand) {
        while (!robot.touch().is_place_of(target) || !target.is_corner()) {
            if (!target.is_corner() && wall_ahead(robot.touch(), hand).name == target.in.name)
                return stop(hand, target.at);
            walk(hand);
        }
    }
    WalkLog finish(Status status) {
        log.route.status = status;
        log.route.length = length_of(log.route.path);
        return std::move(log);
    }

  private:
    InterruptPoll poll_{64};

    void walk(Hand hand) {
        move([&] { robot.walk(hand); });
    }
    void stop(Hand hand, Point at) {
        move([&] { robot.stop(hand, at); });
    }
    template <class Move>
    void move(Move along_wall) {
        const Point before = robot.position();
        along_wall();
        ++log.route.stats.nodes;
        note();
        log.follows.back().walked += distance(before, robot.position());
        log.follows.back().last = log.route.path.size() - 1;
    }
    void note() {
        poll_.step();
        if (log.route.path.back() != robot.position()) log.route.path.push_back(robot.position());
    }
};

// Runs plan(robot) from each side of the walls on which the start lies, until one finds the goal.
template <ContactSensor Robot, class Plan>
auto from_every_side(Robot& robot, Plan plan) {
    decltype(plan(robot)) log;
    Stats stats;
    bool sure = true;
    for (std::size_t side = 0; side < robot.sides(); ++side) {
        robot.stand(side);
        log = plan(robot);
        stats.nodes += log.route.stats.nodes;
        stats.edges += log.route.stats.edges;
        sure = sure && log.route.status == Status::unreachable;
        if (log.route.status == Status::found) break;
    }
    if (!sure && log.route.status != Status::found) log.route.status = Status::undetermined;
    log.route.stats = stats;
    return log;
}

}  // namespace cspace::navigation
