#include "collision_solids.hpp"

#include <initializer_list>

namespace cspace::collision {

namespace {

void append(SolidRows& rows, std::int64_t owner, std::initializer_list<double> row) {
    rows.numbers.insert(rows.numbers.end(), row);
    rows.owners.push_back(owner);
}

}  // namespace

void SolidPacker::add_box(std::int64_t owner, const Posed& T_world_box, const double* size) {
    const auto [R, p] = T_base_world_ * T_world_box;
    append(boxes, owner, {p.x,         p.y,         p.z,         R.m[0][0],   R.m[0][1],
                          R.m[0][2],   R.m[1][0],   R.m[1][1],   R.m[1][2],   R.m[2][0],
                          R.m[2][1],   R.m[2][2],   size[0] / 2, size[1] / 2, size[2] / 2});
}
void SolidPacker::add_sphere(std::int64_t owner, const Posed& T_world_sphere, double radius) {
    const Vec3d p = T_base_world_ * T_world_sphere.t;
    append(capsules, owner, {p.x, p.y, p.z, p.x, p.y, p.z, radius});
}
void SolidPacker::add_capsule(std::int64_t owner, const Posed& T_world_capsule, double radius,
                              double length) {
    const auto [R, p] = T_base_world_ * T_world_capsule;
    const Vec3d half = (length / 2) * column(R, 2), a = p - half, b = p + half;
    append(capsules, owner, {a.x, a.y, a.z, b.x, b.y, b.z, radius});
}
void SolidPacker::add_cylinder(std::int64_t owner, const Posed& T_world_cylinder, double radius,
                               double length) {
    const auto [R, p] = T_base_world_ * T_world_cylinder;
    append(cylinders, owner, {p.x, p.y, p.z, R.m[0][2], R.m[1][2], R.m[2][2], length / 2, radius});
}
void SolidPacker::add_half_space(std::int64_t owner, const Posed& T_world_shape, const double* normal,
                                 double offset) {
    const auto [R, p] = T_base_world_ * T_world_shape;
    const Vec3d n = R * Vec3d{normal[0], normal[1], normal[2]};
    append(half_spaces, owner, {n.x, n.y, n.z, offset + dot(n, p)});
}

}  // namespace cspace::collision
