// Bug 1 (Lumelsky and Stepanov 1987): straight towards the goal; where a wall stops the robot, around the
// whole boundary loop, then the shorter way to its point nearest to the goal, and on from there. No loop is
// met twice. If the line from that point to the goal enters the wall, no path exists. The path is no longer
// than the distance from start to goal and one and a half times the perimeters of the rings met.
#pragma once

#include "cspace/navigation/bugs/walk_log.hpp"

namespace cspace::navigation {

class Bug1 {
  public:
    Bug1(Point goal, Hand hand) : goal_(goal), hand_(hand) {}

    template <ContactSensor Robot>
    WalkLog run(Robot& robot) const {
        Walker<Robot> walker(robot);
        double nearest = std::numeric_limits<double>::infinity();
        while (!walker.advance({robot.position(), goal_})) {
            Round round(goal_, robot.touch());
            const auto stays_on = [](const Wall&, Point, Point) { return std::optional<Point>(); };
            if (walker.follow(hand_, goal_, &round, stays_on, [] { return false; }) == FollowEnd::goal) break;
            const bool shut = round.shuts_off_goal();
            const Nearest& leave = shut ? round.blocked : round.free;
            if (!(leave.squared_distance < nearest)) return walker.finish(Status::undetermined);
            nearest = leave.squared_distance;
            const bool goes_on = leave.along <= round.length() - leave.along;
            walker.go_to(leave.touch, goes_on ? hand_ : other_hand(hand_));
            if (!shut) continue;
            walker.log.witness = robot.touch();
            return walker.finish(Status::unreachable);
        }
        return walker.finish(Status::found);
    }

  private:
    Point goal_;
    Hand hand_;
};

template <ContactSensor Robot>
WalkLog bug_1(Robot& robot, Point goal, Hand hand) {
    return from_every_side(robot, [&](Robot& r) { return Bug1(goal, hand).run(r); });
}

}  // namespace cspace::navigation
