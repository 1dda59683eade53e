// The rows that a scene holds of its solids of a few numbers, from their poses and sizes.
#pragma once

#include <vector>

#include "collision_scene.hpp"
#include "cspace/math/vec.hpp"

namespace cspace::collision {

// Rows of one kind as Primitives have them, one below the other, and the object of each.
struct SolidRows {
    std::vector<double> numbers;
    std::vector<int> owners;
};

// Places solids in the frame of a robot's base. Every pose is that of the shape in the world; lengths in [m].
class SolidPacker {
  public:
    explicit SolidPacker(const Posed& T_base_world) : T_base_world_(T_base_world) {}

    SolidRows boxes, capsules, cylinders, half_spaces;

    void add_box(int owner, const Posed& T_world_box, const double* size);
    void add_sphere(int owner, const Posed& T_world_sphere, double radius);
    // length: of the segment along z.
    void add_capsule(int owner, const Posed& T_world_capsule, double radius, double length);
    void add_cylinder(int owner, const Posed& T_world_cylinder, double radius, double length);
    // Solid where normal · x ≤ offset in the frame of the shape.
    void add_half_space(int owner, const Posed& T_world_shape, const double* normal, double offset);

    // Of a scene of these solids alone; a view that more solids void.
    Primitives primitives();

  private:
    const Posed T_base_world_;
    std::vector<int> owners_;
};

}  // namespace cspace::collision
