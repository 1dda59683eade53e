// A point robot among walls that sees them up to a distance: the range sensor of a polygon world.
#pragma once

#include "cspace/navigation/bugs/contact_robot.hpp"
#include "cspace/navigation/bugs/range_sensor.hpp"
#include "cspace/navigation/bugs/skyline.hpp"

namespace cspace::navigation {

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
        const double ahead = distance(at_, ray.at), free = ahead - (1 - 1e-6) * range_;
        if (ray.arrived) return advance({at_, target}, touched);
        return free > 0 && advance({at_, at_ + (free / ahead) * (ray.at - at_)}, touched) && at_ == target;
    }

    void look(std::vector<Seen>& seen) const {
        seen.clear();
        const bool knows = Skyline::pays(*walls_);
        if (knows) skyline_.look(*walls_, at_);
        for (int wall = 0; wall < walls_->size(); ++wall) {
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
        const auto [at, place] = moved({at_, target}, at_, place_, touched_);
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
        const auto [at, place] = moved({corner, beyond}, corner, ray.place, touched_);
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
            if (distance(cast(p).at, p) <= 1e-9 * range_) seen.push_back({p, wall, true});
        }
    }
};

}  // namespace cspace::navigation
