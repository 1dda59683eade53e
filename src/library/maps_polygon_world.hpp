// Worlds of polygons: what the bindings call.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "maps_grid.hpp"

namespace cspace::maps {

class PolygonCore {
  public:
    struct State;  // maps_polygon_state.hpp, for the library

    // The closed rings points[ends[r − 1]:ends[r]], each owned by an obstacle, and two corners of the bounds.
    // tolerance: how deep in an obstacle rounding may have put a point that lies on a wall [m]. Throws
    // std::invalid_argument for ends that do not increase.
    PolygonCore(std::span<const Point> points, std::span<const std::int32_t> ends,
                std::span<const std::int32_t> owners, Point low, Point high, double tolerance);
    // The blocked cells of a grid.
    PolygonCore(CellBytes blocked, double side, Point origin, double tolerance);

    bool complete() const;   // false where the outlines cross too often
    int components() const;  // of free space
    // Of the boundary: its points, the next of each, the ring of each, and the component of each ring.
    std::tuple<Table<Point>, Table<std::int32_t>, Table<std::int32_t>, Table<std::int32_t>> walls() const;
    // Where outlines cross, and the two obstacles.
    std::pair<Table<Point>, std::vector<std::pair<int, int>>> crossings() const;
    // The corners of the free triangles, and of the convex polygons that they make.
    std::vector<Table<Point>> triangles() const;
    std::vector<Table<Point>> convex_polygons() const;

    // The components of free space whose closures hold a point; none inside obstacles.
    std::vector<int> components_at(Point p) const;
    // An obstacle that covers a point, or −1.
    int obstacle_at(Point p) const;
    // The distance from a point to the nearest wall [m], and the wall's point.
    std::tuple<double, double, double> nearest_wall(Point p) const;
    // The least distance from a path to a wall [m].
    double path_clearance(std::span<const Point> path) const;
    // A byte per cell: whether obstacles reach into it.
    Table<std::uint8_t> rasterize(double side, int rows, int columns) const;

    State& state() const { return *state_; }

  private:
    std::shared_ptr<State> state_;
};

}  // namespace cspace::maps
