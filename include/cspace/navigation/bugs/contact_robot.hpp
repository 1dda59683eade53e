// A point robot among walls and what it feels: the contact sensor of a polygon world.
//
// Where it stands is known as a place, not as a rounded point, so it passes where a line only touches a wall,
// and never through a point where two obstacles meet.
#pragma once

#include <compare>

#include "cspace/navigation/bugs/sensors.hpp"
#include "cspace/navigation/bugs/walls.hpp"

namespace cspace::navigation {

// Straight through open space up to what a robot touches first: a wall, a corner, or the end of the line.

// The position of a robot: in the open (−1, −1), inside a piece of wall (the same twice), at the corner of
// two.
struct Place {
    int in = -1, out = -1;

    bool is_open() const { return in < 0; }
    bool is_corner() const { return in != out; }
    friend auto operator<=>(const Place&, const Place&) = default;
};

class RayCast {
  public:
    Place met;
    Point at;

    // behind: the piece of wall inside which the robot stands and that it leaves, or −1. The robot's position
    // is then a rounded one, and which walls lie ahead is decided by that wall.
    RayCast(const Walls& walls, const Line& line, Point position, int behind)
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
        return met.is_corner() ? comes_after(line_, p, at) : order_on_line(1, p, hit_) <= 0;
    }
    bool comes_first(const Wall& wall) const {
        if (met.is_open()) return true;
        return met.is_corner() ? order_on_line(1, at, wall) > 0 : order_on_line(line_, wall, hit_) < 0;
    }
};

// A point on a wall as far as rounding lets it be: the corner next to it, or moved so that it does not lie
// behind.
inline Point settle_point(const Wall& wall, Point p) {
    if (orientation(wall.begin, wall.end, p) == 0) return p;
    if (is_next_to(p, wall.begin)) return wall.begin;
    if (is_next_to(p, wall.end)) return wall.end;
    const Point d = wall.end - wall.begin;
    double step = std::numeric_limits<double>::epsilon() * std::max(std::abs(p.x), std::abs(p.y));
    for (int k = 0; k < 8 && orientation(wall.begin, wall.end, p) < 0; ++k, step *= 2) {
        if (std::abs(d.x) > std::abs(d.y))
            p.y += d.x > 0 ? step : -step;
        else
            p.x += d.y > 0 ? -step : step;
    }
    return p;
}

class ContactRobot {
  public:
    ContactRobot(const Walls& walls, Point start) : walls_(&walls), start_(start) {
        walls.at(start, [&](int name) {
            const Wall wall = walls.wall(name);
            if (wall.begin == start)
                places_.push_back(corner_before(name));
            else if (wall.end != start && orientation(wall.begin, wall.end, start) == 0 &&
                     is_between(wall.begin, start, wall.end))
                places_.push_back({name, name});
        });
        std::sort(places_.begin(), places_.end());
        places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
        if (places_.empty()) places_.push_back({});
        stand(0);
    }

    std::size_t sides() const { return places_.size(); }
    void stand(std::size_t side) {
        at_ = start_;
        place_ = places_[side];
    }
    // In the open.
    void stand_at(Point p) {
        at_ = p;
        place_ = {};
    }
    Point position() const { return at_; }
    Touch touch() const {
        if (place_.is_open()) return {at_, {}, {}};
        return {at_, walls_->wall(place_.in), walls_->wall(place_.out)};
    }

    bool advance(const Line& line, std::vector<Point>& touched) {
        const Position end = follow_line(line, at_, place_, touched);
        at_ = end.at;
        place_ = end.place;
        return at_ == line.to;
    }

    void walk(Hand hand) {
        place_ = hand == Hand::right ? Place{place_.out, walls_->next(place_.out)} : corner_before(place_.in);
        at_ = walls_->begin(place_.out);
    }

    void stop(Hand hand, Point at) {
        const Wall piece = walls_->wall(hand == Hand::right ? place_.out : place_.in);
        place_ = {piece.name, piece.name};
        at_ = settle_point(piece, at);
    }

  protected:
    struct Position {
        Point at;
        Place place;
    };
    const Walls* walls_;
    Point at_;
    Place place_;

    // Where a robot comes to that follows a line from a position on it.
    Position follow_line(Line line, Point at, Place place, std::vector<Point>& touched) const {
        if (line.from == at) place = exactly(at, place);
        while (at != line.to) {
            if (place.is_corner()) line.from = at;
            const Way way = way_ahead(at, place, line.to);
            if (way == Way::blocked) break;
            const Position next =
                way == Way::free ? flown(line, at, place, touched)
                                 : slid(place, way == Way::along_out ? Hand::right : Hand::left, line.to);
            at = next.at;
            place = next.place;
            if (place.is_corner()) touched.push_back(at);
        }
        return {at, place};
    }

  private:
    std::vector<Place> places_;  // those of the start
    Point start_;

    Place corner_before(int wall) const { return {walls_->previous(wall), wall}; }

    // Where a robot inside a piece of wall stands if its position is taken as it is: on an end of the piece,
    // in the open in front of it, or on it. So it is taken where a line of its own begins there.
    Place exactly(Point at, const Place& place) const {
        if (place.is_open() || place.is_corner()) return place;
        const Wall wall = walls_->wall(place.in);
        if (at == wall.begin) return corner_before(place.in);
        if (at == wall.end) return {place.in, walls_->next(place.in)};
        return orientation(wall.begin, wall.end, at) > 0 && is_in_front(at, place.in) ? Place{} : place;
    }

    // Whether no other wall is so near that rounding may have set the point behind it.
    bool is_in_front(Point at, int wall) const {
        bool in_front = true;
        const double off = rounding_of(walls_->largest());
        walls_->at(at, [&](int other) {
            const Point a = walls_->begin(other), b = walls_->end(other);
            if (other != wall && orientation(a, b, at) <= 0 && distance(at, nearest_on(a, b, at)) <= off)
                in_front = false;
        });
        return in_front;
    }

    Way way_ahead(Point at, const Place& place, Point target) const {
        if (place.is_open()) return Way::free;
        const Wall in = walls_->wall(place.in);
        if (place.is_corner()) return way_towards(in.begin, at, walls_->end(place.out), target);
        const int side = orientation(in.begin, in.end, target);
        if (side != 0) return side > 0 ? Way::free : Way::blocked;
        const Point d = in.end - in.begin, ahead = target - at;
        const bool same =
            std::abs(d.x) >= std::abs(d.y) ? (d.x > 0) == (ahead.x > 0) : (d.y > 0) == (ahead.y > 0);
        return same ? Way::along_out : Way::along_in;
    }

    Position slid(const Place& place, Hand hand, Point target) const {
        const Wall piece = walls_->wall(hand == Hand::right ? place.out : place.in);
        const Point end = far_end(piece, hand);
        if (target != end && is_between(piece.begin, target, piece.end))
            return {target, {piece.name, piece.name}};
        return {end, hand == Hand::right ? Place{piece.name, walls_->next(piece.name)}
                                         : corner_before(piece.name)};
    }

    Position flown(const Line& line, Point at, const Place& place, std::vector<Point>& touched) const {
        const RayCast ray(*walls_, line, at, place.is_corner() ? -1 : place.in);
        ray.write_grazed(touched);
        const bool on_wall = !ray.met.is_open() && !ray.met.is_corner();
        return {on_wall ? settle_point(ray.wall(), ray.at) : ray.at, ray.met};
    }
};

// Whether a robot that touches walls and never enters them can walk along a path, decided exactly.
inline bool can_walk(const Walls& walls, const std::vector<Point>& path) {
    ContactRobot robot(walls, path.front());
    std::vector<Point> touched;
    for (std::size_t side = 0; side < robot.sides(); ++side) {
        robot.stand(side);
        std::size_t leg = 1;
        while (leg < path.size() && robot.advance({path[leg - 1], path[leg]}, touched)) ++leg;
        if (leg == path.size()) return true;
    }
    return false;
}

}  // namespace cspace::navigation
