// Worlds of polygons: what the bindings call.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "cspace/maps/boundary.hpp"

namespace cspace::maps {

class PolygonCore {
  public:
    struct State;  // maps_polygon_state.hpp, for the library

    // The closed rings points[ends[r − 1]:ends[r]], each owned by an obstacle, and two corners of the bounds.
    // tolerance: how deep in an obstacle rounding may have put a point that lies on a wall [m]. Throws
    // std::invalid_argument for ends that do not increase.
    PolygonCore(std::span<const Point> points, std::span<const std::int32_t> ends,
                std::span<const std::int32_t> owners, Point low, Point high, double tolerance);
    // The blocked cells of a grid, a byte each by rows.
    PolygonCore(const std::uint8_t* blocked, int rows, int columns, double side, Point origin,
                double tolerance);
    PolygonCore(PolygonCore&&) noexcept;
    ~PolygonCore();

    bool complete() const;   // false where the outlines cross too often
    int components() const;  // of free space
    const Boundary& walls() const;

    // Where outlines cross, and the two obstacles.
    struct Crossing {
        Point at;
        std::pair<int, int> obstacles;
    };
    std::vector<Crossing> crossings() const;
    // The corners of the free triangles, and of the convex polygons that they make.
    std::vector<std::vector<Point>> triangles() const;
    std::vector<std::vector<Point>> convex_polygons() const;

    // The components of free space whose closures hold a point; none inside obstacles.
    std::vector<int> components_at(Point p) const;
    // An obstacle that covers a point, or −1.
    int obstacle_at(Point p) const;
    // The distance from a point to the nearest wall [m], and the wall's point.
    std::pair<double, Point> nearest_wall(Point p) const;
    // The least distance from a path to a wall [m].
    double path_clearance(std::span<const Point> path) const;
    // Marks the cells that obstacles reach into, a byte each by rows.
    void rasterize(double side, int rows, int columns, std::uint8_t* blocked) const;

    State& state() const { return *state_; }

  private:
    std::unique_ptr<State> state_;
};

}  // namespace cspace::maps
