// Bug 1 (Lumelsky and Stepanov 1987): straight towards the goal; where a wall stops the robot, around the
// whole boundary loop, then the shorter way to its point nearest to the goal, and on from there. No loop is
// met twice. If the line from that point to the goal enters the wall, no path exists. The path is no longer
// than the distance from start to goal and one and a half times the perimeters of the rings met.
#pragma once

#include "cspace/navigation/bugs/boundary_tour.hpp"
#include "cspace/navigation/bugs/walk_log.hpp"

namespace cspace::navigation {

class Bug1 {
  public:
    Bug1(Point goal, Hand hand) : goal_(goal), hand_(hand) {}

    template <ContactSensor Robot>
    Trip run(Robot& robot) const {
        Walker<Robot> walker(robot);
        double nearest = std::numeric_limits<double>::infinity();
        while (!walker.advance({robot.position(), goal_})) {
            walker.begin_follow();
            Round round(goal_, robot.touch());
            if (walk_around(walker, round)) {
                walker.end_follow();
                return walker.finish(Status::found);
            }
            walker.trip.follows.back().whole = true;
            const bool shut = round.shuts_off_goal();
            const Nearest& leave = shut ? round.blocked : round.free;
            if (!(leave.squared_distance < nearest)) return walker.finish(Status::undetermined);
            nearest = leave.squared_distance;
            const bool onwards = leave.along <= round.length() - leave.along;
            walker.go_to(leave.touch, onwards ? hand_ : other(hand_));
            walker.end_follow();
            if (!shut) continue;
            walker.trip.witness = robot.touch();
            return walker.finish(Status::unreachable);
        }
        return walker.finish(Status::found);
    }

  private:
    Point goal_;
    Hand hand_;

    // Around the ring back to the hit point; true if the goal is reached on the way.
    template <ContactSensor Robot>
    bool walk_around(Walker<Robot>& walker, Round& round) const {
        const Touch hit = walker.robot.touch();
        for (bool first = true;; first = false) {
            const Wall piece = ahead(walker.robot.touch(), hand_);
            if (is_on(piece, goal_)) {
                walker.stop(hand_, goal_);
                return true;
            }
            const bool last = !first && !hit.is_corner() && piece.name == hit.in.name;
            const Point from = walker.robot.position();
            if (last)
                walker.stop(hand_, hit.at);
            else
                walker.walk(hand_);
            round.add(piece, from, walker.robot.position());
            if (last) return false;
            round.add(walker.robot.touch());
            if (walker.robot.touch().is_place_of(hit)) return false;
        }
    }
};

template <ContactSensor Robot>
Trip bug_1(Robot& robot, Point goal, Hand hand) {
    return from_every_side(robot, [&](Robot& r) { return Bug1(goal, hand).run(r); });
}

}  // namespace cspace::navigation
