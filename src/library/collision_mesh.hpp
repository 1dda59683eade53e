// The owner of a mesh as an obstacle: its triangles in double and rounded to float, and their tree.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "collision_tree.hpp"
#include "cspace/shapes/plain.hpp"

namespace cspace::collision {

class MeshData {
  public:
    // triangles: nine numbers [m] each, counter-clockwise from outside; is_solid: they enclose a solid, and
    // equal corners of different triangles are equal bit for bit.
    MeshData(std::span<const double> triangles, bool is_solid);

    Mesh view() const;
    const Bounds& bounds() const { return bounds_; }
    double grown() const { return grown_; }  // [m], for the rounding of its numbers
    // The signed distance of a point. Outside the solid it is exact up to `limit` and beyond it elsewhere.
    shapes::Distance distance(const Vec3d& point, double limit) const;
    // Whether a convex solid comes within a gap of the surface, or has its centre inside.
    bool is_within(const shapes::Convex& solid, double gap) const;
    // The distance of a convex solid, up to `limit`; none where they touch.
    std::optional<shapes::ConvexDistance> distance(const shapes::Convex& solid, double limit) const;

  private:
    std::vector<shapes::Corners> corners_;
    std::vector<TreeNode> nodes_;
    std::vector<Triangle> triangles_;
    std::vector<Facet<float>> facets_;  // none where the surface alone counts
    Bounds bounds_;
    double grown_;

    bool contains(const Vec3d& point) const;
    shapes::Convex triangle_at(int k) const;
};

}  // namespace cspace::collision
