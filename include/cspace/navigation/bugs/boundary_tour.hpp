// What a robot learns by walking a whole boundary loop: its length, whether the goal lies on the same side,
// and the points nearest to the goal.
#pragma once

#include <algorithm>
#include <limits>

#include "cspace/navigation/bugs/sensors.hpp"

namespace cspace::navigation {

// A point of the ring: a corner, or the foot of the perpendicular from the goal on a piece of wall.
struct Nearest {
    Touch touch;
    double squared_distance = std::numeric_limits<double>::infinity();
    double along = 0;  // how far along the ring from the hit point [m]
};

// What a directed edge adds to the winding number around a point: whether it crosses the ray from there to
// the right, upwards (1) or downwards (−1).
inline int turn_around(Point p, Point begin, Point end) {
    const bool begin_above = begin.y > p.y, end_above = end.y > p.y;
    if (begin_above == end_above) return 0;
    const int side = orientation(begin, end, p);
    return end_above ? side > 0 : -(side < 0);
}

class Round {
  public:
    Nearest free, blocked;  // the nearest points from which the line to the goal is free, and is not

    Round(Point goal, const Touch& hit) : goal_(goal), hit_(hit) {
        if (!hit.is_corner()) turns_ += turn_around(goal, hit.in.begin, hit.in.end);
    }

    // A piece that was walked from its one end to the other, or the part of the piece with the hit point.
    void add(const Wall& piece, Point from, Point to) {
        const bool with_hit = !hit_.is_corner() && piece.name == hit_.in.name;
        if (!with_hit) turns_ += turn_around(goal_, piece.begin, piece.end);
        add_foot(piece, from, to);
        length_ += distance(from, to);
    }
    void add(const Touch& corner) {
        look_outwards(corner);
        const double d = squared_norm(goal_ - corner.at);
        if (d >= free.squared_distance && d >= blocked.squared_distance) return;
        offer({corner, d, length_}, way_towards(corner, goal_) == Way::free);
    }

    double length() const { return length_; }

    // Whether the ring separates the goal from the robot, by its winding number around the goal.
    bool shuts_off_goal() const { return turns_ != (is_outer_ ? 1 : 0); }

  private:
    Point goal_;
    Touch hit_;
    double length_ = 0;
    int turns_ = 0;  // the winding number around the goal
    bool is_outer_ = true, any_corner_ = false;
    Point leftmost_;

    void offer(const Nearest& point, bool is_free) {
        Nearest& best = is_free ? free : blocked;
        if (point.squared_distance < best.squared_distance) best = point;
    }

    void add_foot(const Wall& piece, Point from, Point to) {
        const Point d = piece.end - piece.begin;
        const double squared = squared_norm(d), t = dot(goal_ - piece.begin, d);
        if (!(t > 0 && t < squared)) return;
        const double area = cross(d, goal_ - piece.begin), near = area * area / squared;
        if (near >= free.squared_distance && near >= blocked.squared_distance) return;
        const Point foot = piece.begin + (t / squared) * d;
        if (is_next_to(foot, piece.begin) || is_next_to(foot, piece.end)) return;
        if (from == to || dot(foot - from, to - from) < 0 || dot(foot - to, from - to) < 0) return;
        const bool is_free = orientation(piece.begin, piece.end, goal_) > 0;
        const Point at = is_free && is_next_to(foot, goal_) ? goal_ : foot;
        offer({{at, piece, piece}, near, length_ + distance(from, foot)}, is_free);
    }

    // The ring encloses the robot unless the free space at its leftmost corner opens to the left.
    void look_outwards(const Touch& corner) {
        const Point p = corner.at;
        if (any_corner_ && (p.x != leftmost_.x ? p.x > leftmost_.x : p.y > leftmost_.y)) return;
        if (!any_corner_ || p != leftmost_) is_outer_ = true;
        any_corner_ = true;
        leftmost_ = p;
        const Point left{p.x - std::max(1.0, std::abs(p.x)), p.y};
        if (way_towards(corner, left) != Way::blocked) is_outer_ = false;
    }
};

}  // namespace cspace::navigation
