// The log of a walk without a map: the points of contact, the walls followed, the points of leaving, and its
// verdict.
#pragma once

#include <utility>
#include <vector>

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/bugs/sensors.hpp"
#include "cspace/navigation/route.hpp"

namespace cspace::navigation {

// One stretch along the boundary: path[first] is the hit point, path[last] the leave point.
struct Follow {
    Touch hit, leave;
    double walked = 0;   // the length of the stretch [m]
    bool whole = false;  // whether the hit point was met again
    std::size_t first = 0, last = 0;
};

// The path of the route is what the robot walked, whether or not it found the goal. Of its price, nodes are
// the pieces of wall that it followed and edges the lines.
struct Trip {
    Route route;
    std::vector<Follow> follows;
    Touch witness;  // unreachable: where the line to the goal enters a wall that shuts the goal off
};

// Writes the path while the robot moves.
template <ContactSensor Robot>
class Walker {
  public:
    Robot& robot;
    Trip trip;

    explicit Walker(Robot& r) : robot(r) { trip.route.path.push_back(r.position()); }

    bool advance(const Line& line) {
        ++trip.route.stats.edges;
        const bool arrived = robot.advance(line, trip.route.path);
        note();
        return arrived;
    }
    bool approach(Point target) {
        ++trip.route.stats.edges;
        const bool arrived = robot.approach(target, trip.route.path);
        note();
        return arrived;
    }
    void begin_follow() {
        trip.follows.push_back({robot.touch(), {}, 0, false, trip.route.path.size() - 1, 0});
    }
    void walk(Hand hand) {
        follow([&] { robot.walk(hand); });
    }
    void stop(Hand hand, Point at) {
        follow([&] { robot.stop(hand, at); });
    }
    // Along the wall to a place on its ring.
    void go_to(const Touch& target, Hand hand) {
        while (!robot.touch().is_place_of(target) || !target.is_corner()) {
            if (!target.is_corner() && ahead(robot.touch(), hand).name == target.in.name)
                return stop(hand, target.at);
            walk(hand);
        }
    }
    void end_follow() {
        trip.follows.back().leave = robot.touch();
        trip.follows.back().last = trip.route.path.size() - 1;
    }
    Trip finish(Status status) {
        trip.route.status = status;
        trip.route.length = length_of(trip.route.path);
        return std::move(trip);
    }

  private:
    InterruptPoll poll_{64};

    template <class Move>
    void follow(Move move) {
        const Point before = robot.position();
        move();
        ++trip.route.stats.nodes;
        trip.follows.back().walked += distance(before, robot.position());
        note();
    }
    void note() {
        poll_.step();
        if (trip.route.path.back() != robot.position()) trip.route.path.push_back(robot.position());
    }
};

// Runs plan(robot) from each side of the walls on which the start lies, until one finds the goal.
template <ContactSensor Robot, class Plan>
auto from_every_side(Robot& robot, Plan plan) {
    decltype(plan(robot)) trip;
    Stats stats;
    bool sure = true;
    for (std::size_t side = 0; side < robot.sides(); ++side) {
        robot.stand(side);
        trip = plan(robot);
        stats.nodes += trip.route.stats.nodes;
        stats.edges += trip.route.stats.edges;
        sure = sure && trip.route.status == Status::unreachable;
        if (trip.route.status == Status::found) break;
    }
    if (!sure && trip.route.status != Status::found) trip.route.status = Status::undetermined;
    trip.route.stats = stats;
    return trip;
}

}  // namespace cspace::navigation
