// Bug 2 (Lumelsky and Stepanov 1987, "Path-planning strategies for a point mobile automaton moving amidst
// unknown obstacles of arbitrary shape"): along the line from start to goal; where a wall stops the robot,
// along the wall to a point of the line that lies beyond, from which the line is free. Met again, the hit
// point proves that no path exists. The path is no longer than the line and, for each boundary loop, as many
// times its perimeter as the line enters it.
//
// A point of the line lies beyond the hit point if it is nearer to the goal; or where two pieces of wall
// touch, on the other side of the same point, which a robot cannot pass but can walk around.
#pragma once

#include "cspace/navigation/bugs/walk_log.hpp"

namespace cspace::navigation {

class Bug2 {
  public:
    Bug2(Point start, Point goal, Hand hand) : m_{start, goal}, hand_(hand) {}

    template <ContactSensor Robot>
    Trip run(Robot& robot) const {
        Walker<Robot> walker(robot);
        while (!walker.advance(m_)) {
            const Touch hit = robot.touch();
            for (const Follow& earlier : walker.trip.follows)
                if (hit.is_place_of(earlier.hit)) return walker.finish(Status::undetermined);
            walker.begin_follow();
            const bool whole = follow(walker, hit);
            walker.end_follow();
            if (!whole) continue;
            walker.trip.follows.back().whole = true;
            walker.trip.witness = hit;
            return walker.finish(Status::unreachable);
        }
        return walker.finish(Status::found);
    }

  private:
    Line m_;
    Hand hand_;

    // Along the wall to the goal or to a leave point; true if the hit point is met first.
    template <ContactSensor Robot>
    bool follow(Walker<Robot>& walker, const Touch& hit) const {
        for (bool first = true;; first = false) {
            const Wall piece = ahead(walker.robot.touch(), hand_);
            if (is_on(piece, m_.to)) {
                walker.stop(hand_, m_.to);
                return false;
            }
            if (!first && !hit.is_corner() && piece.name == hit.in.name) {
                walker.stop(hand_, hit.at);
                return true;
            }
            if (is_free_at(piece, hit)) {
                walker.stop(hand_, crossing_point(m_, piece));
                return false;
            }
            walker.walk(hand_);
            const Touch corner = walker.robot.touch();
            if (corner.is_place_of(hit)) return true;
            if (is_free_at_corner(corner, hit)) return false;
        }
    }

    bool is_free_at(const Wall& piece, const Touch& hit) const {
        if (crossing(m_, piece) != -1 || orientation(piece.begin, piece.end, m_.to) <= 0) return false;
        return hit.is_corner() ? order(-1, hit.at, piece) <= 0 : order(m_, hit.in, piece) <= 0;
    }

    bool is_free_at_corner(const Touch& corner, const Touch& hit) const {
        if (side_of(m_, corner.at) != 0 || !comes_after(m_, corner.at, m_.to)) return false;
        const bool beyond = hit.is_corner() ? corner.at == hit.at || comes_after(m_, hit.at, corner.at)
                                            : order(1, corner.at, hit.in) >= 0;
        return beyond && way_towards(corner, m_.to) == Way::free;
    }
};

template <ContactSensor Robot>
Trip bug_2(Robot& robot, Point goal, Hand hand) {
    return from_every_side(robot, [&](Robot& r) { return Bug2(r.position(), goal, hand).run(r); });
}

}  // namespace cspace::navigation
