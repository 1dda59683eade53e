// What a robot without a map sees that has a range sensor besides its touch.
#pragma once

#include "cspace/navigation/bugs/contact_sensor.hpp"

namespace cspace::navigation {

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
