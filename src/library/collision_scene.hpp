// The owner of a scene's primitives, rounded to float in the frame of the robot's base.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "collision_cloud.hpp"
#include "collision_mesh.hpp"
#include "cspace/collision/scene.hpp"
#include "cspace/shapes/plain.hpp"

namespace cspace::collision {

// Rows of numbers [m]: boxes (15): centre, rotation row-major (columns: the axes), half sizes; capsules (7):
// two ends, radius; cylinders (8): centre, unit axis, half length, radius; half spaces (4): outward unit
// normal n, offset o (solid where n · x ≤ o); triangles (9): three corners, counter-clockwise from outside.
// Mesh i has the next mesh_sizes[i] triangles; is_solid[i]: they enclose a solid, and corners that meet are
// equal bit for bit. Cloud i has the next cloud_sizes[i] points (3), and the radius cloud_radii[i]. owners:
// the object of each box, capsule, cylinder, half space, mesh and cloud, in this order.
struct Primitives {
    std::span<const double> boxes, capsules, cylinders, half_spaces, triangles, points, cloud_radii;
    std::span<const int> mesh_sizes, is_solid, cloud_sizes, owners;
};

class SceneData {
  public:
    explicit SceneData(const Primitives& given);
    const Scene& view() const { return view_; }  // without margins, and nothing allowed
    int owner(int primitive) const { return owners_[std::size_t(primitive)]; }
    bool is_convex(int primitive) const { return primitive < view_.n - view_.n_meshes - view_.n_clouds; }
    // The distance of a point from a primitive, in double; some distance beyond `limit` where it is larger.
    shapes::Distance distance(int primitive, const Vec3d& point, double limit) const;
    // Whether a convex solid comes within a gap of a primitive.
    bool is_within(int primitive, const shapes::Convex& solid, double gap) const;
    // The distance of a convex solid, in double, up to `limit`; none where it touches a mesh.
    std::optional<shapes::ConvexDistance> distance(int primitive, const shapes::Convex& solid,
                                                   double limit) const;

  private:
    std::vector<double> box_rows_, capsule_rows_, cylinder_rows_, half_space_rows_;
    Scene view_ = {};
    std::vector<Box> boxes_;
    std::vector<Capsule> capsules_;
    std::vector<Cylinder> cylinders_;
    std::vector<HalfSpace> half_spaces_;
    std::vector<MeshData> mesh_data_;
    std::vector<Mesh> meshes_;
    std::vector<CloudData> cloud_data_;
    std::vector<Cloud> clouds_;
    Tree tree_;  // of the boxes; empty where they are few
    std::vector<int> owners_;
    std::vector<float> low_[3], high_[3];

    // What primitive i is: calls one of them with it.
    template <class OnConvex, class OnHalfSpace, class OnMesh, class OnCloud>
    auto visit_primitive(int primitive, const OnConvex& on_convex, const OnHalfSpace& on_half_space,
                         const OnMesh& on_mesh, const OnCloud& on_cloud) const;
    void add_meshes(const Primitives& given);
    void add_clouds(const Primitives& given);
    void build_boxes();
    void pad_bounds();
    void add_bounds(const Bounds& box, double grown);
    void add_bounds(const double (&low)[3], const double (&high)[3], double grown);
};

}  // namespace cspace::collision
