// The owner of the cells in front of a point cloud: how far away every place in a cell is from all points,
// and in which order the points are stored.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "collision_tree.hpp"

namespace cspace::collision {

class GridData {
  public:
    // Cells for so many points in a box. No points, no cells.
    GridData(std::size_t count, const Bounds& all);

    // Marks the cells of points and returns the points in the order of their cells: those of
    // an eighth of a block of cells before those of the next (Morton 1966, "A computer oriented geodetic data
    // base"), and those of a crowded cell by halves. Neighbours in this order are near each other.
    std::vector<Vec3d> sort_points(std::span<const Vec3d> points);
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
    int find_cell(const Vec3d& point) const;
    std::vector<int> count_points(std::span<const Vec3d> points, std::vector<int>& cells) const;
    void mark_cells(const std::vector<int>& counts);
    void spread_steps();
    void measure_steps(float largest);
};

}  // namespace cspace::collision
