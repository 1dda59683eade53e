// The owner of a point cloud as an obstacle: its points in double and rounded to float, and their tree.
#pragma once

#include <span>
#include <vector>

#include "collision_grid.hpp"
#include "collision_tree.hpp"
#include "cspace/shapes/plain.hpp"

namespace cspace::collision {

// The slack of robots covers the rounding of points: those that a ball touches are no farther away than it.
class CloudData {
  public:
    // points [m]; radius [m]: of the balls around them.
    CloudData(std::span<const Vec3d> points, double radius);

    Cloud view() const;
    const Bounds& bounds() const { return bounds_; }
    // The distance of a point from the nearest ball, up to `limit`; some distance beyond it elsewhere.
    shapes::Distance distance(const Vec3d& point, double limit) const;
    // Whether a convex solid comes within a gap of a ball; and its distance, up to `limit`.
    bool is_within(const shapes::Convex& solid, double gap) const;
    shapes::ConvexDistance distance(const shapes::Convex& solid, double limit) const;

  private:
    Bounds bounds_;  // of the points, at last of the balls
    GridData grid_;
    std::vector<Vec3d> points_;
    std::vector<TreeNode> nodes_;
    std::vector<float> x_, y_, z_;
    double radius_;

    // Calls visit(ball) for the balls that may be within limit() of a solid, until it returns true.
    template <class Limit, class Visit>
    bool visit_balls(const shapes::Convex& solid, const Limit& limit, const Visit& visit) const;
};

}  // namespace cspace::collision
