// The largest visible distance from a robot's position in each direction: what lies beyond is hidden for
// sure, so no ray need be cast there.
#pragma once

#include "cspace/navigation/bugs/walls.hpp"

namespace cspace::navigation {

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

}  // namespace cspace::navigation
