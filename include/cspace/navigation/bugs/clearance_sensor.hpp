// The interface of a robot without a map whose sensor measures the distances of the nearest walls.
#pragma once

#include <array>
#include <optional>

#include "cspace/navigation/bugs/sensors.hpp"
#include "cspace/navigation/voronoi/contacts.hpp"

namespace cspace::navigation {

// A nearest point of the walls, by its direction; the site distinguishes pieces of wall and corners.
using Foot = voronoi::Contact;

// What else ends a glide than walls.
struct Aim {
    Point goal;
    double nearer = 0;  // where it rolls along a wall, it stops at points next to the goal less far than this
    std::optional<Point> mark;  // a place along a wall that it will know again
    bool stops = true;          // where the goal is no farther than the walls
};

// How a glide ends: where more walls are as near (feet() has all of them), where the walls are as far as the
// robot keeps from them, in view of the corner between the two walls, where the goal is no farther than the
// walls, at a point of a wall next to the goal, at the mark, when the caller says so, or by rounding.
enum class Halt { meet, limit, corner, goal, low, mark, told, open, lost };

// What a robot notes on its way.
struct Log {
    std::vector<Point> path;
    std::vector<Touch> corners;                              // that its feet came by
    double least = std::numeric_limits<double>::infinity();  // distance from walls [m]
    std::optional<std::size_t> low;                          // the point of the path nearest to the goal

    void note(Point p) {
        if (path.empty() || path.back() != p) path.push_back(p);
    }
};

// By how much places and directions may differ that the robot takes for one.
struct Likeness {
    double share;  // of the distance from walls
    double fine;   // [m]
    double turn;   // of the directions of two feet, together
    double far;    // of how far it keeps from a single wall
    double loop;   // no way back to where it begins is shorter, by how far places may differ
};

// range, sees    as of a range sensor
// likeness       how well it tells places apart
// again          where all is exhausted, whether it looks again, keeping less far from walls
// keeps          how far it keeps from a single wall [m], less than its range
// clearance      the distance to the nearest walls
// feet           where they are, counterclockwise; the robot came from between the last and the first
// begin          from the start away from the nearest wall until another is as near
// trace          between two feet, the first on its right, away from what else is near
// roll           along the wall under a foot on its right, as far from it as it keeps
// fly            straight towards the goal until a wall is as near as it keeps from walls
// stand_at       goes back to where it has been
//
// Each calls look() regularly and stops when that is true.
template <class Robot>
concept ClearanceSensor =
    ContactSensor<Robot> &&
    requires(Robot robot, const Robot& still, Foot foot, const Aim& aim, Log& log, bool (*look)(), Point p) {
        { still.range() } -> std::convertible_to<double>;
        { robot.sees(p) } -> std::convertible_to<double>;
        { still.likeness() } -> std::same_as<Likeness>;
        { robot.again() } -> std::same_as<bool>;
        { still.keeps() } -> std::convertible_to<double>;
        { still.clearance() } -> std::convertible_to<double>;
        { still.feet() } -> std::convertible_to<std::vector<Foot>>;
        { robot.begin(log) } -> std::same_as<Halt>;
        { robot.trace(foot, foot, aim, log, look) } -> std::same_as<Halt>;
        { robot.roll(foot, aim, log, look) } -> std::same_as<Halt>;
        { robot.fly(aim, log) } -> std::same_as<Halt>;
        robot.stand_at(p);
    };

}  // namespace cspace::navigation
