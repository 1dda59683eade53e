// The owner of the cells in front of a point cloud: how far away every place in a cell is from all points.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "collision_tree.hpp"

namespace cspace::collision {

class GridData {
  public:
    GridData() = default;
    // Coordinates of points, rounded, and the box around them. No points, no cells.
    GridData(std::span<const float> x, std::span<const float> y, std::span<const float> z, const Bounds& all);

    DistanceGrid view() const;

  private:
    std::array<float, 3> low_ = {};
    float cells_per_metre_ = 0;
    std::array<int, 3> n_ = {};
    std::vector<unsigned char> steps_;
    std::array<std::vector<signed char>, 3> ways_;
    std::vector<int> points_;
    std::vector<float> least_;

    void choose_cells(std::size_t count, const Bounds& all);
    void mark_points(const std::array<std::span<const float>, 3>& points);
    void spread_steps();
    void measure_steps(float largest);
};

}  // namespace cspace::collision
