// Points drawn evenly from a component of free space, or from an ellipse in it.
#pragma once

#include <numbers>

#include "cspace/maps/polygon_world.hpp"
#include "cspace/navigation/sampling/sight.hpp"
#include "cspace/search/draws.hpp"
#include "cspace/search/portable_log.hpp"

namespace cspace::navigation::sampling {

class Samples {
  public:
    Samples(const maps::PolygonWorld& world, Index component, std::uint64_t seed)
        : world_(world), component_(component), draws_(seed) {
        const FreeSpace& space = world.space;
        for (Index t = 0; t < Index(space.mesh.triangles.size()); ++t) {
            if (space.component[std::size_t(t)] != component) continue;
            const auto [a, b, c] = corners(t);
            triangles_.push_back(t);
            area_ += 0.5 * cross(b - a, c - a);
            up_to_.push_back(area_);
            if (triangles_.size() == 1) box_ = {a, a};
            for (const Point p : {a, b, c}) box_.include(p);
        }
    }
    double area() const { return area_; }
    const Box& box() const { return box_; }  // around the component
    double uniform() { return draws_.uniform(); }

    // A point inside a triangle of the component; its triangle is none in the rare case that it fell on an
    // edge.
    Located draw() {
        const double place = draws_.uniform() * area_;
        const auto found = std::upper_bound(up_to_.begin(), up_to_.end(), place);
        const Index t = triangles_[std::min(std::size_t(found - up_to_.begin()), triangles_.size() - 1)];
        const auto [a, b, c] = corners(t);
        double u = draws_.uniform(), v = draws_.uniform();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        return placed(a + u * (b - a) + v * (c - a), t);
    }

    // A point of the component whose distances to the two points add up to less than `sum`: no other point
    // can be on a shorter way (Gammell, Srinivasa & Barfoot 2014, "Informed RRT*"). Its triangle is none
    // where the draw fell outside.
    Located draw_within(Point a, Point b, double sum) {
        const double apart = distance(a, b), minor = std::sqrt(std::max(sum * sum - apart * apart, 0.0));
        const Point along = apart > 0 ? (1 / apart) * (b - a) : Point{1, 0};
        Located drawn;
        if (ellipse_area(apart, sum) >= area_) {
            drawn = draw();
        } else {
            double u, v;
            do u = 2 * draws_.uniform() - 1, v = 2 * draws_.uniform() - 1;
            while (u * u + v * v > 1);
            u *= 0.5 * sum, v *= 0.5 * minor;
            const Point p = 0.5 * (a + b) + Point{u * along.x - v * along.y, u * along.y + v * along.x};
            if (!world_.is_inside_bounds(p)) return {p, none};
            const maps::Place place = world_.space.mesh.locate(p, world_.locator.near(p));
            drawn = {p, place.kind == maps::Place::inside ? place.triangle : none};
            if (drawn.triangle != none && world_.space.component[std::size_t(drawn.triangle)] != component_)
                drawn.triangle = none;
        }
        if (distance(a, drawn.at) + distance(drawn.at, b) >= sum) drawn.triangle = none;
        return drawn;
    }
    static double ellipse_area(double apart, double sum) {
        return std::numbers::pi / 4 * sum * std::sqrt(std::max(sum * sum - apart * apart, 0.0));
    }

  private:
    const maps::PolygonWorld& world_;
    Index component_;
    search::Draws draws_;
    double area_ = 0;
    Box box_;
    std::vector<Index> triangles_;
    std::vector<double> up_to_;  // areas of the triangles up to and with each

    std::array<Point, 3> corners(Index t) const {
        const maps::Triangle& tri = world_.space.mesh[t];
        return {world_.space.mesh.point(tri.corner[0]), world_.space.mesh.point(tri.corner[1]),
                world_.space.mesh.point(tri.corner[2])};
    }
    Located placed(Point p, Index t) const { return {p, is_within(world_.space, t, p) ? t : none}; }
};

// The radius within which n evenly drawn points of an area must be joined for shortest ways to be found in
// the limit: above 2 (1 + 1/2)^½ (area / π)^½ (log n / n)^½ (Karaman & Frazzoli 2011, "Sampling-based
// algorithms for optimal motion planning", theorem 34).
inline double joining_radius(double area, std::size_t n) {
    const double log = search::portable_log(n);
    return 1.01 * std::sqrt(6 * area / std::numbers::pi * std::max(log, 0.5) / double(n));
}

}  // namespace cspace::navigation::sampling
