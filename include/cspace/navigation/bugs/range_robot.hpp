// A point robot among walls that sees them up to a distance: the range sensor of a polygon world.
#pragma once

#include "cspace/math/interrupts.hpp"
#include "cspace/navigation/bugs/contact_robot.hpp"
#include "cspace/navigation/bugs/sensors.hpp"
#include "cspace/navigation/bugs/walls.hpp"

namespace cspace::navigation {

// The largest visible distance from a robot's position in each direction: what lies beyond is hidden for
// sure, so no ray need be cast there.

class Skyline {
  public:
    // Of a world of so few walls casting every ray is faster.
    static bool pays(const Walls& walls) { return walls.size() > 256; }

    void look(const Walls& walls, Point from) {
        from_ = from;
        nearest_ = 1e6 * rounding_of(walls.largest());
        ends_.assign(std::size_t(bins), std::numeric_limits<double>::infinity());
        corners_.resize(std::size_t(walls.size()));
        for (int k = 0; k < walls.size(); ++k) corners_[std::size_t(k)] = seen(walls.begin(k));
        for (int k = 0; k < walls.size(); ++k)
            hide_behind(corners_[std::size_t(k)], corners_[std::size_t(walls.next(k))]);
    }

    bool hides_corner(int wall) const { return hides(corners_[std::size_t(wall)]); }
    bool hides(Point p) const { return hides(seen(p)); }

  private:
    // Around the square |x| + |y| = 1, whose sides are divided evenly: no angle need be computed.
    static constexpr int quarter = 512, bins = 4 * quarter;
    static constexpr double margin = 1e-3;  // of a bin: more than rounding turns a direction
    static constexpr double beyond = 1 + 1e-5;

    // A point by its direction, in bins, and its distance.
    struct Mark {
        Point off;
        double bin, away;
    };
    Point from_;
    double nearest_ = 0;  // walls nearer than this may lie elsewhere by rounding
    std::vector<double> ends_;
    std::vector<Mark> corners_;

    Mark seen(Point p) const {
        const Point off = p - from_;
        const double across = std::abs(off.x) + std::abs(off.y), up = across > 0 ? off.y / across : 0;
        const double quarters = off.x < 0 ? 2 - up : up < 0 ? 4 + up : up;
        return {off, quarters * quarter, norm(off)};
    }
    bool hides(const Mark& mark) const {
        return mark.away > beyond * ends_[std::size_t(std::min(int(mark.bin), bins - 1))];
    }
    // All bins that a wall fills whole end behind it.
    void hide_behind(const Mark& a, const Mark& b) {
        const double span = b.bin < a.bin ? b.bin + bins - a.bin : b.bin - a.bin;
        if (span <= 1 || span >= 0.5 * bins - 1) return;  // too short, or seen from behind
        if (a.away < nearest_ || b.away < nearest_) return;
        const int first = int(std::ceil(a.bin + margin)), last = int(std::floor(a.bin + span - margin));
        const Point d = b.off - a.off;
        const double area = cross(a.off, d);
        if (first >= last || !(area > nearest_ * norm(d))) return;
        double before = reach(first, area, d);
        for (int k = first; k < last; ++k) {
            const double after = reach(k + 1, area, d);
            double& end = ends_[std::size_t(k % bins)];
            end = std::min(end, std::max(before, after));
            before = after;
        }
    }
    static const std::vector<Point>& sides() {
        static const std::vector<Point> all = [] {
            std::vector<Point> made;
            for (int k = 0; k < bins; ++k) {
                const double along = double(k % quarter) / quarter, rest = 1 - along;
                const Point sides[] = {{rest, along}, {-along, rest}, {-rest, -along}, {along, -rest}};
                const Point side = sides[k / quarter];
                made.push_back((1 / norm(side)) * side);
            }
            return made;
        }();
        return all;
    }
    // How far a wall is along the side of a bin.
    static double reach(int side, double area, Point d) {
        const double turned = cross(sides()[std::size_t(side % bins)], d);
        return turned > 0 ? area / turned : std::numeric_limits<double>::infinity();
    }
};

class RangeRobot : public ContactRobot {
  public:
    RangeRobot(const Walls& walls, Point start, double range) : ContactRobot(walls, start), range_(range) {}

    double range() const { return range_; }

    double sees(Point target) const {
        const double far = distance(at_, target);
        const Cast ray = cast(far <= range_ ? target : at_ + (range_ / far) * (target - at_));
        const double seen = std::min(far, distance(at_, ray.at));
        return ray.arrived ? seen : std::min(seen, std::nextafter(far, 0));
    }

    bool approach(Point target, std::vector<Point>& touched) {
        const Cast ray = cast(target);
        constexpr double within = 1e-6;  // of the range: from here it sees the wall that it approaches
        const double ahead = distance(at_, ray.at), free = ahead - (1 - within) * range_;
        if (ray.arrived) return advance({at_, target}, touched);
        return free > 0 && advance({at_, at_ + (free / ahead) * (ray.at - at_)}, touched) && at_ == target;
    }

    void look(std::vector<Seen>& seen) const {
        seen.clear();
        const bool knows = Skyline::pays(*walls_);
        if (knows) skyline_.look(*walls_, at_);
        InterruptPoll poll(256);
        for (int wall = 0; wall < walls_->size(); ++wall) {
            poll.step();
            if (!knows || !skyline_.hides_corner(wall)) look_at_corner(wall, seen);
            if (range_ < std::numeric_limits<double>::infinity())
                look_at_horizon(walls_->wall(wall), seen, knows);
        }
    }

  private:
    struct Cast {
        Point at;
        Place place;
        bool arrived;
    };
    double range_;
    mutable std::vector<Point> touched_;
    mutable Skyline skyline_;

    // Where a ray towards a point ends.
    Cast cast(Point target) const {
        touched_.clear();
        const auto [at, place] = follow_line({at_, target}, at_, place_, touched_);
        return {at, place, at == target};
    }

    // A corner in view; where the view goes past it, what lies behind as well.
    void look_at_corner(int wall, std::vector<Seen>& seen) const {
        const Point corner = walls_->begin(wall);
        const double away = distance(at_, corner);
        if (corner == at_ || away > range_) return;
        const Point before = walls_->begin(walls_->previous(wall)), after = walls_->end(wall);
        if (way_towards(before, corner, after, at_) == Way::blocked) return;  // it faces away
        const Cast ray = cast(corner);
        if (!ray.arrived || ray.place != Place{walls_->previous(wall), wall}) return;
        const Wall in = walls_->wall(ray.place.in), out = walls_->wall(wall);
        const double reach = std::min(range_, 4 * walls_->extent());
        const Point beyond = at_ + (std::max(reach, 2 * away) / away) * (corner - at_);
        const bool passes = way_towards({corner, in, out}, beyond) != Way::blocked;
        seen.push_back({corner, in, passes});
        seen.push_back({corner, out, passes});
        if (!passes || away >= range_) return;
        touched_.clear();
        const auto [at, place] = follow_line({corner, beyond}, corner, ray.place, touched_);
        if (at != beyond && distance(at_, at) <= range_) seen.push_back({at, walls_->wall(place.in), false});
    }

    // Where a wall leaves the range, if it is in view there.
    void look_at_horizon(const Wall& wall, std::vector<Seen>& seen, bool knows) const {
        if (orientation(wall.begin, wall.end, at_) < 0) return;
        const Point d = wall.end - wall.begin, from = wall.begin - at_;
        const double a = squared_norm(d), b = dot(from, d), c = squared_norm(from) - range_ * range_;
        const double root = b * b - a * c;
        if (!(root > 0)) return;
        for (const double t : {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a}) {
            if (!(t > 0 && t < 1)) continue;
            const Point p = wall.begin + t * d;
            if (knows && skyline_.hides(p)) continue;
            if (distance(cast(p).at, p) <= tolerance::widening * range_) seen.push_back({p, wall, true});
        }
    }
};

}  // namespace cspace::navigation
