// The interface of a robot without a map: it detects contact with walls, follows them and knows its position.
#pragma once

#include <concepts>
#include <cstddef>
#include <vector>

#include "cspace/navigation/bugs/line.hpp"

namespace cspace::navigation {

// The hand that stays on the wall. With the right hand a robot walks pieces from begin to end.
enum class Hand { left, right };

inline Hand other_hand(Hand hand) { return hand == Hand::left ? Hand::right : Hand::left; }
inline const Wall& wall_ahead(const Touch& touch, Hand hand) {
    return hand == Hand::right ? touch.out : touch.in;
}
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

// What a robot without a map sees that has a range sensor besides its touch.

// A point where a piece of wall comes into view or goes out of it. At an edge the view jumps: there the robot
// sees past a corner, or the wall leaves the sensor's range.
struct Seen {
    Point at;
    Wall wall;
    bool is_edge = false;
};

// range          how far it sees [m], infinity if there is no limit
// sees           how far it sees towards a point: the distance to the wall in between, or to the point
// itself, but
//                never more than the range
// look           the ends of all pieces of wall in view
// approach       goes straight towards a point until a wall comes into range ahead; true if it arrives
template <class Robot>
concept RangeSensor = ContactSensor<Robot> && requires(Robot moving, const Robot& robot, Point target,
                                                       std::vector<Seen>& seen, std::vector<Point>& touched) {
    { robot.range() } -> std::convertible_to<double>;
    { robot.sees(target) } -> std::convertible_to<double>;
    robot.look(seen);
    { moving.approach(target, touched) } -> std::same_as<bool>;
};

}  // namespace cspace::navigation
