#include "collision_solids.hpp"

#include <initializer_list>

namespace cspace::collision {

namespace {

void append(SolidRows& rows, int owner, std::initializer_list<double> row) {
    rows.numbers.insert(rows.numbers.end(), row);
    rows.owners.push_back(owner);
}

}  // namespace

void SolidPacker::add_box(int owner, const Posed& T_world_box, const double* size) {
    const auto [R, p] = T_base_world_ * T_world_box;
    append(boxes, owner,
           {p.x, p.y, p.z, R.m[0][0], R.m[0][1], R.m[0][2], R.m[1][0], R.m[1][1], R.m[1][2], R.m[2][0],
            R.m[2][1], R.m[2][2], size[0] / 2, size[1] / 2, size[2] / 2});
}
void SolidPacker::add_sphere(int owner, const Posed& T_world_sphere, double radius) {
    const Vec3d p = T_base_world_ * T_world_sphere.t;
    append(capsules, owner, {p.x, p.y, p.z, p.x, p.y, p.z, radius});
}
void SolidPacker::add_capsule(int owner, const Posed& T_world_capsule, double radius, double length) {
    const auto [R, p] = T_base_world_ * T_world_capsule;
    const Vec3d half = (length / 2) * matrix_column(R, 2), a = p - half, b = p + half;
    append(capsules, owner, {a.x, a.y, a.z, b.x, b.y, b.z, radius});
}
void SolidPacker::add_cylinder(int owner, const Posed& T_world_cylinder, double radius, double length) {
    const auto [R, p] = T_base_world_ * T_world_cylinder;
    append(cylinders, owner, {p.x, p.y, p.z, R.m[0][2], R.m[1][2], R.m[2][2], length / 2, radius});
}
void SolidPacker::add_half_space(int owner, const Posed& T_world_shape, const double* normal, double offset) {
    const auto [R, p] = T_base_world_ * T_world_shape;
    const Vec3d n = R * Vec3d{normal[0], normal[1], normal[2]};
    append(half_spaces, owner, {n.x, n.y, n.z, offset + dot(n, p)});
}

Primitives SolidPacker::primitives() {
    owners_.clear();
    for (const SolidRows* rows : {&boxes, &capsules, &cylinders, &half_spaces})
        owners_.insert(owners_.end(), rows->owners.begin(), rows->owners.end());
    Primitives all = {};
    all.boxes = boxes.numbers, all.capsules = capsules.numbers;
    all.cylinders = cylinders.numbers, all.half_spaces = half_spaces.numbers;
    all.owners = owners_;
    return all;
}

}  // namespace cspace::collision
