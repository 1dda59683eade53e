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
    WalkLog run(Robot& robot) const {
        Walker<Robot> walker(robot);
        while (!walker.advance(m_)) {
            const Touch hit = robot.touch();
            for (const Follow& earlier : walker.log.follows)
                if (hit.is_place_of(earlier.hit)) return walker.finish(Status::undetermined);
            const auto leaves_piece = [&](const Wall& piece, Point, Point) {
                return is_free_at(piece, hit) ? std::optional(crossing_point(m_, piece)) : std::nullopt;
            };
            const auto leaves_corner = [&] { return is_free_at_corner(robot.touch(), hit); };
            // At the goal the next line has no length.
            if (walker.follow(hand_, m_.to, nullptr, leaves_piece, leaves_corner) != FollowEnd::whole)
                continue;
            walker.log.witness = hit;
            return walker.finish(Status::unreachable);
        }
        return walker.finish(Status::found);
    }

  private:
    Line m_;
    Hand hand_;

    bool is_free_at(const Wall& piece, const Touch& hit) const {
        if (crossing_sign(m_, piece) != -1 || orientation(piece.begin, piece.end, m_.to) <= 0) return false;
        return hit.is_corner() ? order_on_line(-1, hit.at, piece) <= 0
                               : order_on_line(m_, hit.in, piece) <= 0;
    }

    bool is_free_at_corner(const Touch& corner, const Touch& hit) const {
        if (side_of(m_, corner.at) != 0 || !comes_after(m_, corner.at, m_.to)) return false;
        const bool beyond = hit.is_corner() ? corner.at == hit.at || comes_after(m_, hit.at, corner.at)
                                            : order_on_line(1, corner.at, hit.in) >= 0;
        return beyond && way_towards(corner, m_.to) == Way::free;
    }
};

template <ContactSensor Robot>
WalkLog bug_2(Robot& robot, Point goal, Hand hand) {
    return from_every_side(robot, [&](Robot& r) { return Bug2(r.position(), goal, hand).run(r); });
}

}  // namespace cspace::navigation
