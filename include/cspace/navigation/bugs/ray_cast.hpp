// Straight through open space up to what a robot touches first: a wall, a corner, or the end of the line.
#pragma once

#include <compare>

#include "cspace/navigation/bugs/walls.hpp"

namespace cspace::navigation {

// The position of a robot: in the open (−1, −1), inside a piece of wall (the same twice), at the corner of
// two.
struct Place {
    int in = -1, out = -1;

    bool is_open() const { return in < 0; }
    bool is_corner() const { return in != out; }
    friend auto operator<=>(const Place&, const Place&) = default;
};

class Flight {
  public:
    Place met;
    Point at;

    // behind: the piece of wall inside which the robot stands and that it leaves, or −1. The robot's position
    // is then a rounded one, and which walls lie ahead is decided by that wall.
    Flight(const Walls& walls, const Line& line, Point position, int behind)
        : at(line.to),
          walls_(walls),
          line_(line),
          leaves_(behind >= 0),
          position_(position),
          near_(rounding_of(walls.largest()) * norm(line.to - line.from)) {
        if (leaves_) behind_ = walls.wall(behind);
        walls.along(
            line, [&](int wall) { look_at(wall); },
            [&](auto covered) { return !met.is_open() && covered(at); });
    }

    const Wall& wall() const { return hit_; }

    // Corners that the line passes so near that a path with rounded points might cut them: they belong into
    // it.
    void write_grazed(std::vector<Point>& path) const {
        for (const Point& p : grazed_)
            if (is_before(p, at)) path.push_back(p);
    }

  private:
    const Walls& walls_;
    const Line& line_;
    bool leaves_;
    Point position_;
    double near_;
    Wall behind_, hit_;
    std::vector<Point> grazed_;  // in their order along the line

    void look_at(int name) {
        const Point begin = walls_.begin(name);
        const int side = side_of(line_, begin);
        if (side == 0) return look_at_corner(name, begin);
        if (std::abs(cross(line_.to - line_.from, begin - line_.from)) <= near_) graze(begin);
        if (side > 0) return;
        const Wall wall = walls_.wall(name);
        if (side_of(line_, wall.end) <= 0 || !is_ahead(wall)) return;
        const int target = orientation(wall.begin, wall.end, line_.to);
        if (target > 0 || !comes_first(wall)) return;
        met = {name, name};
        hit_ = wall;
        at = target == 0 ? line_.to : crossing_point(line_, wall);
    }

    bool is_before(Point a, Point b) const { return dot(line_.to - line_.from, b - a) > 0; }

    void graze(Point corner) {
        if (!is_before(position_, corner) || !is_before(corner, line_.to)) return;
        const auto next =
            std::find_if(grazed_.begin(), grazed_.end(), [&](Point p) { return !is_before(p, corner); });
        if (next == grazed_.end() || *next != corner) grazed_.insert(next, corner);
    }

    void look_at_corner(int name, Point corner) {
        if (!is_ahead(corner) || !comes_first(corner)) return;
        const Point before = walls_.begin(walls_.previous(name)), after = walls_.end(name);
        if (way_towards(before, corner, after, line_.from) != Way::free) return;
        met = {walls_.previous(name), name};
        at = corner;
    }

    bool is_ahead(Point p) const {
        if (p != line_.to && !comes_after(line_, p, line_.to)) return false;
        if (!leaves_) return comes_after(line_, line_.from, p);
        return orientation(behind_.begin, behind_.end, p) > 0 && is_no_further_back(p);
    }
    bool is_ahead(const Wall& wall) const {
        if (!leaves_) return orientation(wall.begin, wall.end, line_.from) > 0;
        const int side = side_of(behind_, wall);
        return (side == 2 ? side_of(wall, behind_) == 1 : side == 1) &&
               is_no_further_back(crossing_point(line_, wall));
    }
    // A line that begins at the rounded position may cross the wall left behind elsewhere, and others before
    // that.
    bool is_no_further_back(Point p) const {
        return line_.from != position_ || dot(line_.to - line_.from, p - position_) >= -near_;
    }

    bool comes_first(Point p) const {
        if (met.is_open()) return true;
        return met.is_corner() ? comes_after(line_, p, at) : order(1, p, hit_) <= 0;
    }
    bool comes_first(const Wall& wall) const {
        if (met.is_open()) return true;
        return met.is_corner() ? order(1, at, wall) > 0 : order(line_, wall, hit_) < 0;
    }
};

}  // namespace cspace::navigation
