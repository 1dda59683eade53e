// A world of polygons, prepared once: triangulated, its free space divided into convex polygons, its walls as
// rings.
#pragma once

#include <memory>

#include "cspace/maps/convex_mesh.hpp"
#include "cspace/maps/free_space.hpp"
#include "cspace/math/interrupts.hpp"
#include "cspace/math/made_once.hpp"

namespace cspace::maps {

// Point location: a raster of the bounds whose cells each name a triangle nearby, and a short walk from
// there.

class Locator {
  public:
    Locator() = default;
    Locator(const Triangulation& mesh, Point low, Point high) : low_(low) {
        const double width = high.x - low.x, height = high.y - low.y;
        const double cells = std::clamp(double(mesh.triangles.size()), 1.0, 1e6);
        side_ = std::max(std::sqrt(width * height / cells), std::max(width, height) / 4096);
        columns_ = 1 + Index(width / side_);
        rows_ = 1 + Index(height / side_);
        near_.resize(std::size_t(columns_) * std::size_t(rows_));
        Index t = 0;
        InterruptPoll poll(256);
        for (Index row = 0; row < rows_; ++row)
            for (Index k = 0; k < columns_; ++k) {
                poll.step();
                const Index column = row % 2 ? columns_ - 1 - k : k;
                const Place place = mesh.locate(center(row, column), t);
                if (place.triangle != none) t = place.triangle;
                near_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)] = t;
            }
    }
    // A triangle near p.
    Index near(Point p) const {
        const auto cell = [&](double offset, Index count) {
            return std::size_t(std::clamp(offset / side_, 0.0, double(count - 1)));
        };
        return near_[cell(p.y - low_.y, rows_) * std::size_t(columns_) + cell(p.x - low_.x, columns_)];
    }

  private:
    Point low_;
    double side_ = 1;
    Index columns_ = 0, rows_ = 0;
    std::vector<Index> near_;

    Point center(Index row, Index column) const {
        return low_ + Point{(column + 0.5) * side_, (row + 0.5) * side_};
    }
};

// A point of a query and the free triangles that contain it. A point that rounding has put into an obstacle,
// no farther from a wall than `tolerance`, is taken to the free side of it.
struct Settled {
    Point at;
    std::vector<Index> triangles;  // none: the point lies in an obstacle or outside the bounds

    bool is_free() const { return !triangles.empty(); }
};

class PolygonWorld {
  public:
    explicit PolygonWorld(Outlines world)
        : outlines(std::move(world)),
          space(make_free_space(outlines)),
          locator(space.complete ? Locator(space.mesh, outlines.low, outlines.high) : Locator()),
          walls(space.complete ? boundary_of(space) : Boundary{}) {}

    const Outlines outlines;
    const FreeSpace space;
    const Locator locator;
    const Boundary walls;

    const ConvexMesh& mesh() const {
        return mesh_.get([&] { return std::make_unique<ConvexMesh>(make_convex_mesh(space)); });
    }
    bool is_inside_bounds(Point p) const {
        return p.x >= outlines.low.x && p.x <= outlines.high.x && p.y >= outlines.low.y &&
               p.y <= outlines.high.y;
    }

    Settled settle(Point p, double tolerance) const {
        Settled settled{p, {}};
        if (!is_inside_bounds(p)) return settled;
        space.triangles_at(p, locator.near(p), settled.triangles);
        if (settled.is_free()) return settled;
        double nearest = tolerance;
        for (Index e = 0; e < Index(walls.size()); ++e) {
            const Point a = walls.begin(e), b = walls.end(e), along = b - a, foot = nearest_on(a, b, p);
            if (!(distance(p, foot) < nearest)) continue;
            const double step = tolerance / norm(along);
            const Point inside = foot + step * Point{-along.y, along.x};
            std::vector<Index> triangles;
            space.triangles_at(inside, locator.near(inside), triangles);
            if (triangles.empty()) continue;
            nearest = distance(p, foot);
            settled = {inside, std::move(triangles)};
        }
        return settled;
    }

    // The component of free space that two settled points share, or none.
    Index shared_component(const Settled& a, const Settled& b) const {
        for (const Index t : a.triangles)
            for (const Index u : b.triangles)
                if (space.component[std::size_t(t)] == space.component[std::size_t(u)])
                    return space.component[std::size_t(t)];
        return none;
    }

  private:
    MadeOnce<ConvexMesh> mesh_;
};

}  // namespace cspace::maps
