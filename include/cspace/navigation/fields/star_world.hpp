// Star worlds: a star-shaped room and star-shaped obstacles that do not touch, and the map of such a world to
// a sphere world (Rimon & Koditschek 1992, section 4, with a switch of their own around each star).
//
// Every star is seen whole from a point of its kernel. Around an obstacle lies a collar, between it and a
// copy of it that is a little larger; collars do not meet. The map moves points of a collar along the ray
// from the centre, linearly, so that the obstacle becomes a disc, and leaves all others where they are. It is
// a homeomorphism by construction, so a function of the sphere world has in the star world as many minima as
// there.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "cspace/maps/boundary.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/predicates.hpp"
#include "cspace/navigation/fields/sphere_world.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::navigation {

// A polygon whose corners are all seen from its centre, in their order around it.
class Star {
  public:
    // corners: counter-clockwise.
    Star(std::vector<Point> corners, Point center) : center_(center), corners_(std::move(corners)) {
        const auto angle = [&](Point p) { return std::atan2(p.y - center.y, p.x - center.x); };
        std::size_t first = 0;
        for (std::size_t k = 1; k < corners_.size(); ++k)
            if (angle(corners_[k]) < angle(corners_[first])) first = k;
        std::rotate(corners_.begin(), corners_.begin() + std::ptrdiff_t(first), corners_.end());
        for (std::size_t k = 0; k < corners_.size(); ++k) {
            angles_.push_back(angle(corners_[k]));
            least_ = std::min(least_, distance(center, nearest_on(corners_[k], corner_after(k), center)));
            most_ = std::max(most_, distance(center, corners_[k]));
        }
    }

    Point center() const { return center_; }
    const std::vector<Point>& corners() const { return corners_; }
    Point corner_after(std::size_t k) const { return corners_[k + 1 == corners_.size() ? 0 : k + 1]; }
    double least() const { return least_; }  // radius
    double most() const { return most_; }
    // How far its outline is from the centre, towards d.
    double radius(Point d) const {
        const double angle = std::atan2(d.y, d.x);
        std::size_t k =
            std::size_t(std::upper_bound(angles_.begin(), angles_.end(), angle) - angles_.begin());
        k = (k == 0 ? corners_.size() : k) - 1;
        const Point a = corners_[k] - center_, along = corner_after(k) - corners_[k];
        return norm(d) * cross(a, along) / cross(d, along);
    }
    // From the nearest point of another outline.
    double distance_to(const Star& other) const { return std::min(reach(other), other.reach(*this)); }
    bool meets(Point p, Point q) const {
        for (std::size_t k = 0; k < corners_.size(); ++k) {
            const Point a = corners_[k], b = corner_after(k);
            if (orientation(a, b, p) * orientation(a, b, q) <= 0 &&
                orientation(p, q, a) * orientation(p, q, b) <= 0)
                return true;
        }
        return false;
    }

  private:
    Point center_;
    std::vector<Point> corners_;
    std::vector<double> angles_;
    double least_ = std::numeric_limits<double>::infinity(), most_ = 0;

    double reach(const Star& other) const {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < corners_.size(); ++k)
            for (const Point p : other.corners_)
                nearest = std::min(nearest, distance(p, nearest_on(corners_[k], corner_after(k), p)));
        return nearest;
    }
};

namespace detail {

// What a convex polygon keeps on the left of a line.
inline std::vector<Point> clip_polygon(const std::vector<Point>& shape, Point a, Point b) {
    std::vector<Point> kept;
    const auto side = [&](Point p) { return cross(b - a, p - a); };
    for (std::size_t k = 0; k < shape.size(); ++k) {
        const Point p = shape[k], q = shape[(k + 1) % shape.size()];
        const double u = side(p), v = side(q);
        if (u >= 0) kept.push_back(p);
        if ((u > 0 && v < 0) || (u < 0 && v > 0)) kept.push_back(p + (u / (u - v)) * (q - p));
    }
    return kept;
}
inline Point centroid_of(const std::vector<Point>& shape) {
    Point sum;
    double area = 0;
    for (std::size_t k = 1; k + 1 < shape.size(); ++k) {
        const double twice = cross(shape[k] - shape[0], shape[k + 1] - shape[0]);
        sum = sum + twice * ((shape[k] - shape[0]) + (shape[k + 1] - shape[0]));
        area += twice;
    }
    return shape[0] + (1 / (3 * area)) * sum;
}

}  // namespace detail

// A point that sees all of a polygon, from strictly within all its sides (decided without rounding); false
// where the kernel is empty, or too thin to find one. corners: counter-clockwise.
inline bool kernel_point(const std::vector<Point>& corners, Point& found) {
    const auto [low, high] = bounds_of(corners);
    std::vector<Point> kernel{low, {high.x, low.y}, high, {low.x, high.y}};
    const std::size_t n = corners.size();
    for (std::size_t k = 0; k < n && kernel.size() >= 3; ++k)
        kernel = detail::clip_polygon(kernel, corners[k], corners[(k + 1) % n]);
    if (kernel.size() < 3) return false;
    found = detail::centroid_of(kernel);
    for (std::size_t k = 0; k < n; ++k)
        if (orientation(corners[k], corners[(k + 1) % n], found) <= 0) return false;
    return true;
}

// A star world and its map to a sphere world.
class StarWorld {
  public:
    enum Fault { none, no_star, contact };
    Fault fault = none;
    Point where;  // a corner of the ring that is no star, or touches another

    StarWorld() = default;
    StarWorld(const maps::Boundary& walls, std::int32_t component) {
        for (const std::vector<Point>& ring : rings(walls, component)) add(ring);
        if (fault == none) lay_collars();
    }

    SphereWorld model() const {
        SphereWorld made;
        for (const Star& star : stars_) {
            const Disc disc{star.center(), &star == &stars_[0] ? star.most() : star.least()};
            if (&star == &stars_[0])
                made.room = disc;
            else
                made.obstacles.push_back(disc);
        }
        return made;
    }
    Point to_model(Point p) const {
        return move_along_ray(p, [](const Collar& c, double rho) {
            return c.disc + (rho - c.wall) * (c.edge - c.disc) / (c.edge - c.wall);
        });
    }
    Point from_model(Point p) const {
        return move_along_ray(p, [](const Collar& c, double rho) {
            return c.wall + (rho - c.disc) * (c.edge - c.wall) / (c.edge - c.disc);
        });
    }
    // Whether the way from p to q touches no wall; exact.
    bool is_open(Point p, Point q) const {
        const Point middle = 0.5 * (p + q);
        const double half = 0.5 * distance(p, q);
        for (std::size_t k = 0; k < stars_.size(); ++k) {
            const double away = distance(middle, stars_[k].center());
            const bool is_far = k ? away > (stars_[k].most() + half) * (1 + tolerance::widening)
                                  : away + half < stars_[k].least() * (1 - tolerance::widening);
            if (!is_far && stars_[k].meets(p, q)) return false;
        }
        return true;
    }

  private:
    struct Collar {  // along a ray: where the wall is, its disc, and the far edge, which stays
        double wall, disc, edge;
    };
    std::vector<Star> stars_;    // the room, then obstacles
    std::vector<double> grown_;  // the size of the far edge of a collar, over that of the star

    static std::vector<std::vector<Point>> rings(const maps::Boundary& walls, std::int32_t component) {
        std::vector<std::vector<Point>> found(walls.component.size());
        std::vector<char> seen(walls.component.size(), 0);
        for (std::int32_t e = 0; e < std::int32_t(walls.size()); ++e) {
            const std::size_t ring = std::size_t(walls.ring[std::size_t(e)]);
            if (seen[ring] || walls.component[ring] != component) continue;
            seen[ring] = 1;
            std::int32_t at = e;
            do found[ring].push_back(walls.begin(at));
            while ((at = walls.next[std::size_t(at)]) != e);
        }
        std::erase_if(found, [](const auto& ring) { return ring.empty(); });
        return found;
    }
    // Walls have free space on their left, so the room comes counter-clockwise and obstacles clockwise.
    void add(std::vector<Point> ring) {
        double twice = 0;
        for (std::size_t k = 0; k < ring.size(); ++k)
            twice += cross(ring[k] - ring[0], ring[(k + 1) % ring.size()] - ring[0]);
        const bool is_room = twice > 0;
        if (!is_room) std::reverse(ring.begin(), ring.end());
        Point center;
        if (fault == none && !kernel_point(ring, center)) fault = no_star, where = ring[0];
        if (fault != none) return;
        stars_.insert(is_room ? stars_.begin() : stars_.end(), Star(std::move(ring), center));
    }
    void lay_collars() {
        std::vector<double> gap(stars_.size(), std::numeric_limits<double>::infinity());
        InterruptPoll poll(16);
        for (std::size_t i = 1; i < stars_.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                poll.step();
                const double least =
                    distance(stars_[i].center(), stars_[j].center()) - stars_[i].most() - stars_[j].most();
                if (j && least >= std::max(gap[i], gap[j])) continue;
                const double away = stars_[i].distance_to(stars_[j]);
                if (away <= tolerance::exact * stars_[0].most())
                    fault = contact, where = stars_[i].corners()[0];
                gap[i] = std::min(gap[i], away), gap[j] = std::min(gap[j], away);
            }
        for (std::size_t i = 0; i < stars_.size(); ++i) {
            const double share = 0.45 * gap[i] / stars_[i].most();
            grown_.push_back(i ? 1 + std::min(share, 1.0) : 1 - std::min(share, 0.5));
        }
    }
    template <class Move>
    Point move_along_ray(Point p, const Move& move) const {
        for (std::size_t k = 0; k < stars_.size(); ++k) {
            const Star& star = stars_[k];
            const Point d = p - star.center();
            const double rho = norm(d);
            if (rho == 0 || (k ? rho >= grown_[k] * star.most() : rho <= grown_[k] * star.least())) continue;
            const double wall = star.radius((1 / rho) * d), edge = grown_[k] * wall;
            if (k ? rho >= edge : rho <= edge) continue;
            const Collar collar{wall, k ? star.least() : star.most(), edge};
            return star.center() + (move(collar, rho) / rho) * d;
        }
        return p;
    }
};

}  // namespace cspace::navigation
