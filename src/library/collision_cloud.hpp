// The owner of a point cloud as an obstacle: its points in double and rounded to float, and their tree.
#pragma once

#include <span>
#include <vector>

#include "collision_tree.hpp"
#include "cspace/shapes/distance.hpp"

namespace cspace::collision {

class CloudData {
  public:
    // points: three numbers [m] each; radius [m]: of the balls around them.
    CloudData(std::span<const double> points, double radius);

    Cloud view() const;
    const Bounds& bounds() const { return bounds_; }
    double grown() const { return grown_; }  // [m], for the rounding of its numbers
    // The distance of a point from the nearest ball, up to `limit`; some distance beyond it elsewhere.
    shapes::Distance distance(const Vec3d& point, double limit) const;

  private:
    std::vector<Vec3d> points_;
    std::vector<float> x_, y_, z_;
    std::vector<TreeNode> nodes_;
    Bounds bounds_;
    double radius_, grown_;
};

}  // namespace cspace::collision
