// What a robot without a map tells of its way: where it touched, what it followed, where it left, and its
// verdict.
#pragma once

#include <vector>

#include "cspace/navigation/bugs/contact_sensor.hpp"

namespace cspace::navigation {

enum class Verdict { found, unreachable, undetermined };

// One stretch along the boundary: path[first] is the hit point, path[last] the leave point.
struct Follow {
    Touch hit, leave;
    double walked = 0;   // the length of the stretch [m]
    bool whole = false;  // whether the hit point was met again
    std::size_t first = 0, last = 0;
};

struct Trip {
    Verdict verdict = Verdict::undetermined;
    std::vector<Point> path;
    std::vector<Follow> follows;
    Touch witness;  // unreachable: where the line to the goal enters a wall that shuts the goal off
};

inline double length_of(const std::vector<Point>& path) {
    double sum = 0;
    for (std::size_t i = 1; i < path.size(); ++i) sum += distance(path[i - 1], path[i]);
    return sum;
}

// Writes the path while the robot moves.
template <ContactSensor Robot>
class Walker {
  public:
    Robot& robot;
    Trip trip;

    explicit Walker(Robot& r) : robot(r) { trip.path.push_back(r.position()); }

    bool advance(const Line& line) {
        const bool arrived = robot.advance(line, trip.path);
        note();
        return arrived;
    }
    void begin_follow() { trip.follows.push_back({robot.touch(), {}, 0, false, trip.path.size() - 1, 0}); }
    void walk(Hand hand) {
        const Point before = robot.position();
        robot.walk(hand);
        trip.follows.back().walked += distance(before, robot.position());
        note();
    }
    void stop(Hand hand, Point at) {
        const Point before = robot.position();
        robot.stop(hand, at);
        trip.follows.back().walked += distance(before, robot.position());
        note();
    }
    void end_follow() {
        trip.follows.back().leave = robot.touch();
        trip.follows.back().last = trip.path.size() - 1;
    }
    Trip finish(Verdict verdict) {
        trip.verdict = verdict;
        return std::move(trip);
    }

  private:
    void note() {
        if (trip.path.back() != robot.position()) trip.path.push_back(robot.position());
    }
};

// Runs plan(robot) from each side of the walls on which the start lies, until one finds the goal.
template <ContactSensor Robot, class Plan>
Trip from_every_side(Robot& robot, Plan plan) {
    Trip trip;
    bool sure = true;
    for (std::size_t side = 0; side < robot.sides(); ++side) {
        robot.stand(side);
        trip = plan(robot);
        if (trip.verdict == Verdict::found) return trip;
        sure = sure && trip.verdict == Verdict::unreachable;
    }
    if (!sure) trip.verdict = Verdict::undetermined;
    return trip;
}

}  // namespace cspace::navigation
