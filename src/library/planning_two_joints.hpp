// The configuration space of a planar arm with two joints: what the bindings call.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "cspace/math/plane.hpp"
#include "table.hpp"

namespace cspace::planning {

// The angle of a joint in the plane is sign · q + offset; lower and upper limits of q [rad].
struct JointNumbers {
    double sign, offset, lower, upper;
};

// Convex pieces: corners[ends[k − 1]:ends[k]] counterclockwise, grown by a radius [m], of an obstacle.
struct PieceTables {
    std::span<const Point> corners;
    std::span<const std::int32_t> ends;
    std::span<const double> radii;
    std::span<const std::int32_t> obstacles;
};

class TwoJointSpace {
  public:
    // lengths [m] of both links. A joint that wraps has limits one turn apart. Throws std::invalid_argument
    // for tables that do not fit together.
    TwoJointSpace(Point base, std::array<double, 2> lengths, double link_radius,
                  std::array<JointNumbers, 2> joints, std::array<bool, 2> wraps, const PieceTables& pieces);

    // A byte per cell (rows of joint 1, columns of joint 2): 1 where the arm touches an obstacle.
    Table<std::uint8_t> bitmap(int rows, int columns) const;
    // The obstacle that the arm touches in each cell, −1 where it is free.
    Table<std::int32_t> obstacle_map(int rows, int columns) const;
    // The obstacle that the arm touches in each configuration, −1 where it is free. Limits do not count.
    std::vector<std::int32_t> obstacles_at(std::span<const Point> configurations) const;

    // Of the curves: their points, where each ends, its kind (side on corner, tip on corner, tip on side,
    // link 1, limit) and its obstacle, −1 at limits.
    std::tuple<Table<Point>, Table<std::int32_t>, Table<std::int32_t>, Table<std::int32_t>> boundaries()
        const;
    // Of the components: least and greatest area (n, 2) [rad²], a configuration inside, its region. Those of
    // different regions are proved to be separate.
    std::tuple<Table<double>, Table<Point>, Table<std::int32_t>> components() const;
    // The number of a component, −1 in obstacles and beyond limits, −2 where it is not known.
    int component_at(Point configuration) const;
    // A free path; empty where none is known.
    Table<Point> find_path(Point start, Point goal) const;

  private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace cspace::planning
