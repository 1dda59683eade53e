// The interface of a robot without a map: it detects contact with walls, follows them and knows its position.
#pragma once

#include <concepts>
#include <cstddef>
#include <vector>

#include "cspace/navigation/bugs/line.hpp"

namespace cspace::navigation {

// The hand that stays on the wall. With the right hand a robot walks pieces from begin to end.
enum class Hand { left, right };

inline Hand other(Hand hand) { return hand == Hand::left ? Hand::right : Hand::left; }
inline const Wall& ahead(const Touch& touch, Hand hand) { return hand == Hand::right ? touch.out : touch.in; }
inline Point far_end(const Wall& wall, Hand hand) { return hand == Hand::right ? wall.end : wall.begin; }
inline bool is_on(const Wall& wall, Point p) {
    return orientation(wall.begin, wall.end, p) == 0 && is_between(wall.begin, p, wall.end);
}

// sides          on how many sides of walls the robot may begin: 1, more only where obstacles touch
// stand          goes back to the start, on that side
// position       where the robot is
// advance        follows a line on which it stands up to the line's end; true if it arrives, false if a wall
//                stops it. It passes corners and slides along walls where the line does not enter them, and
//                writes down the corners that it touches.
// touch          what it touches
// walk           follows the wall by hand to the end of the piece ahead
// stop           follows the piece ahead as far as a point on it
template <class Robot>
concept ContactSensor =
    requires(Robot robot, const Robot& still, Line line, Hand hand, Point at, std::vector<Point>& touched) {
        { still.sides() } -> std::convertible_to<std::size_t>;
        robot.stand(std::size_t());
        { still.position() } -> std::convertible_to<Point>;
        { robot.advance(line, touched) } -> std::same_as<bool>;
        { still.touch() } -> std::convertible_to<Touch>;
        robot.walk(hand);
        robot.stop(hand, at);
    };

}  // namespace cspace::navigation
