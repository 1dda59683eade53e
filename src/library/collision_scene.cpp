#include "collision_scene.hpp"

#include <algorithm>
#include <cmath>

#include "cspace/shapes/distance.hpp"
#include "cspace/tolerances.hpp"
#include "shapes_distance.hpp"

namespace cspace::collision {

namespace {

// What rounding the numbers of a primitive to float may move its surface by: half a unit in the last place of
// each coordinate, twice over.
double rounding_of(std::initializer_list<double> lengths) {
    double largest = 0;
    for (const double length : lengths) largest = std::max(largest, std::fabs(length));
    return largest * tolerance::float_rounding / 2;
}
template <std::size_t n>
void copy_rounded(const double* from, float (&to)[n]) {
    for (std::size_t k = 0; k < n; ++k) to[k] = float(from[k]);
}
double norm(const double* v) { return std::hypot(v[0], v[1], v[2]); }

}  // namespace

SceneData::SceneData(const Primitives& given)
    : box_rows_(given.boxes.begin(), given.boxes.end()),
      capsule_rows_(given.capsules.begin(), given.capsules.end()),
      cylinder_rows_(given.cylinders.begin(), given.cylinders.end()),
      half_space_rows_(given.half_spaces.begin(), given.half_spaces.end()),
      owners_(given.owners.begin(), given.owners.end()) {
    for (std::size_t at = 0; at < given.boxes.size(); at += 15) {
        const double *c = &given.boxes[at], *R = c + 3, *half = c + 12;
        Box box = {};
        copy_rounded(c, box.center);
        copy_rounded(half, box.half);
        double low[3], high[3];
        for (int k = 0; k < 3; ++k) {
            for (int r = 0; r < 3; ++r) box.axes[3 * k + r] = float(R[3 * r + k]);
            const double extent = std::fabs(R[3 * k]) * half[0] + std::fabs(R[3 * k + 1]) * half[1] +
                                  std::fabs(R[3 * k + 2]) * half[2];
            low[k] = c[k] - extent, high[k] = c[k] + extent;
        }
        const float* axes = box.axes;
        box.is_upright =
            axes[2] == 0 && axes[5] == 0 && axes[6] == 0 && axes[7] == 0 && std::fabs(axes[8]) == 1;
        const double grown = rounding_of({norm(c), norm(half)});
        box.radius = float(grown);
        boxes_.push_back(box);
        add_bounds(low, high, grown);
    }
    for (std::size_t at = 0; at < given.capsules.size(); at += 7) {
        const double *a = &given.capsules[at], *b = a + 3, r = a[6];
        Capsule capsule = {};
        copy_rounded(a, capsule.start);
        double low[3], high[3], square = 0;
        for (int k = 0; k < 3; ++k) {
            capsule.along[k] = float(b[k] - a[k]);
            square += double(capsule.along[k]) * capsule.along[k];
            low[k] = std::min(a[k], b[k]) - r, high[k] = std::max(a[k], b[k]) + r;
        }
        capsule.inverse_square = square > 0 ? float(1 / square) : 0.0f;
        const double grown = rounding_of({norm(a), norm(b), r});
        capsule.radius = float(r + grown);
        capsules_.push_back(capsule);
        add_bounds(low, high, grown);
    }
    for (std::size_t at = 0; at < given.cylinders.size(); at += 8) {
        const double *c = &given.cylinders[at], *n = c + 3, half = c[6], r = c[7];
        Cylinder cylinder = {};
        copy_rounded(c, cylinder.center);
        copy_rounded(n, cylinder.axis);
        cylinder.half = float(half), cylinder.rim = float(r);
        double low[3], high[3];
        for (int k = 0; k < 3; ++k) {
            const double extent = half * std::fabs(n[k]) + r * std::sqrt(std::max(0.0, 1 - n[k] * n[k]));
            low[k] = c[k] - extent, high[k] = c[k] + extent;
        }
        const double grown = rounding_of({norm(c), half, r});
        cylinder.radius = float(grown);
        cylinders_.push_back(cylinder);
        add_bounds(low, high, grown);
    }
    for (std::size_t at = 0; at < given.half_spaces.size(); at += 4) {
        const double* n = &given.half_spaces[at];
        HalfSpace half_space = {};
        copy_rounded(n, half_space.normal);
        half_space.offset = float(n[3]);
        half_space.radius = float(rounding_of({n[3]}));
        half_spaces_.push_back(half_space);
        constexpr double everywhere = 1e30;
        double low[3] = {-everywhere, -everywhere, -everywhere},
               high[3] = {everywhere, everywhere, everywhere};
        for (int k = 0; k < 3; ++k) {  // a half space along an axis has one side
            if (n[k] == 1) high[k] = n[3];
            if (n[k] == -1) low[k] = -n[3];
        }
        add_bounds(low, high, half_space.radius);
    }
    add_meshes(given);
    add_clouds(given);
    build_boxes();
    const int n = int(low_[0].size());
    pad_bounds();
    view_ = {boxes_.data(),
             capsules_.data(),
             cylinders_.data(),
             half_spaces_.data(),
             meshes_.data(),
             clouds_.data(),
             int(boxes_.size()),
             int(capsules_.size()),
             int(cylinders_.size()),
             int(half_spaces_.size()),
             int(meshes_.size()),
             int(clouds_.size()),
             n,
             {low_[0].data(), low_[1].data(), low_[2].data()},
             {high_[0].data(), high_[1].data(), high_[2].data()},
             tree_.nodes.data(),
             tree_.order.data(),
             int(tree_.nodes.size()),
             nullptr,
             0,
             0,
             {}};
}

shapes::Distance SceneData::distance(int primitive, const Vec3d& point, double limit) const {
    const auto vector = [](const double* v) { return Vec3d{v[0], v[1], v[2]}; };
    std::size_t i = std::size_t(primitive);
    if (i < boxes_.size()) {
        const double* row = &box_rows_[15 * i];
        const Mat3d R = {{{row[3], row[4], row[5]}, {row[6], row[7], row[8]}, {row[9], row[10], row[11]}}};
        return shapes::distance_from_box(point, vector(row), R, vector(row + 12));
    }
    i -= boxes_.size();
    if (i < capsules_.size()) {
        const double* row = &capsule_rows_[7 * i];
        return shapes::distance_from_capsule(point, vector(row), vector(row + 3), row[6]);
    }
    i -= capsules_.size();
    if (i < cylinders_.size()) {
        const double* row = &cylinder_rows_[8 * i];
        return shapes::distance_from_cylinder(point, vector(row), vector(row + 3), row[6], row[7]);
    }
    i -= cylinders_.size();
    if (i < half_spaces_.size()) {
        const double* row = &half_space_rows_[4 * i];
        return shapes::distance_from_half_space(point, vector(row), row[3]);
    }
    i -= half_spaces_.size();
    if (i < mesh_data_.size()) return mesh_data_[i].distance(point, limit);
    return cloud_data_[i - mesh_data_.size()].distance(point, limit);
}

template <class OnConvex, class OnHalfSpace, class OnMesh, class OnCloud>
auto SceneData::visit_primitive(int primitive, const OnConvex& on_convex, const OnHalfSpace& on_half_space,
                                const OnMesh& on_mesh, const OnCloud& on_cloud) const {
    const auto vector = [](const double* v) { return Vec3d{v[0], v[1], v[2]}; };
    std::size_t i = std::size_t(primitive);
    if (i < boxes_.size()) {
        const double* row = &box_rows_[15 * i];
        const Mat3d R = {{{row[3], row[4], row[5]}, {row[6], row[7], row[8]}, {row[9], row[10], row[11]}}};
        return on_convex(shapes::make_box({R, vector(row)}, vector(row + 12)));
    }
    i -= boxes_.size();
    if (i < capsules_.size()) {
        const double* row = &capsule_rows_[7 * i];
        const Vec3d ends[] = {vector(row), vector(row + 3)};
        return on_convex(shapes::make_points(ends, 2, row[6]));
    }
    i -= capsules_.size();
    if (i < cylinders_.size()) {
        const double* row = &cylinder_rows_[8 * i];
        return on_convex(shapes::make_cylinder({frame_along(vector(row + 3)), vector(row)}, row[7], row[6]));
    }
    i -= cylinders_.size();
    if (i < half_spaces_.size()) {
        const double* row = &half_space_rows_[4 * i];
        return on_half_space(vector(row), row[3]);
    }
    i -= half_spaces_.size();
    if (i < mesh_data_.size()) return on_mesh(mesh_data_[i]);
    return on_cloud(cloud_data_[i - mesh_data_.size()]);
}

bool SceneData::is_within(int primitive, const shapes::Convex& solid, double gap) const {
    const auto is_near = [&](const auto& data) { return data.is_within(solid, gap); };
    return visit_primitive(
        primitive, [&](const shapes::Convex& other) { return shapes::is_within(solid, other, gap); },
        [&](const Vec3d& normal, double offset) {
            return shapes::measure_above(solid, normal, offset).value <= gap;
        },
        is_near, is_near);
}

std::optional<shapes::ConvexDistance> SceneData::distance(int primitive, const shapes::Convex& solid,
                                                          double limit) const {
    using Found = std::optional<shapes::ConvexDistance>;
    const auto measure = [&](const auto& data) -> Found { return data.distance(solid, limit); };
    return visit_primitive(
        primitive,
        [&](const shapes::Convex& other) -> Found { return shapes::measure_distance(solid, other); },
        [&](const Vec3d& normal, double offset) -> Found {
            return shapes::measure_above(solid, normal, offset);
        },
        measure, measure);
}

void SceneData::add_meshes(const Primitives& given) {
    std::size_t first = 0;
    for (std::size_t i = 0; i < given.mesh_sizes.size(); ++i) {
        const std::size_t count = 9 * std::size_t(given.mesh_sizes[i]);
        mesh_data_.emplace_back(given.triangles.subspan(first, count), given.is_solid[i] != 0);
        first += count;
    }
    for (const MeshData& mesh : mesh_data_) {
        meshes_.push_back(mesh.view());
        add_bounds(mesh.bounds(), mesh.grown());
    }
}
void SceneData::add_clouds(const Primitives& given) {
    const std::span points(reinterpret_cast<const Vec3d*>(given.points.data()), given.points.size() / 3);
    std::size_t first = 0;
    for (std::size_t i = 0; i < given.cloud_sizes.size(); ++i) {
        const std::size_t count = std::size_t(given.cloud_sizes[i]);
        cloud_data_.emplace_back(points.subspan(first, count), given.cloud_radii[i]);
        first += count;
    }
    for (const CloudData& cloud : cloud_data_) {
        clouds_.push_back(cloud.view());
        add_bounds(cloud.bounds(), 0);
    }
}

void SceneData::build_boxes() {
    constexpr std::size_t most_without_tree = 64;
    constexpr int leaf_size = 4;  // boxes: a test of one costs what that of a node does
    if (low_[0].size() <= most_without_tree) return;
    std::vector<Bounds> boxes(low_[0].size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) boxes[i].low[k] = low_[k][i], boxes[i].high[k] = high_[k][i];
    tree_ = build_tree(boxes, leaf_size, 0);
}

void SceneData::pad_bounds() {
    constexpr std::size_t lanes = 8;
    constexpr float beyond = 3e38f;
    const std::size_t padded = (low_[0].size() + lanes - 1) / lanes * lanes;
    for (int k = 0; k < 3; ++k) low_[k].resize(padded, beyond), high_[k].resize(padded, -beyond);
}
void SceneData::add_bounds(const Bounds& box, double grown) {
    add_bounds({box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}, grown);
}
void SceneData::add_bounds(const double (&low)[3], const double (&high)[3], double grown) {
    for (int k = 0; k < 3; ++k) {
        low_[k].push_back(round_low(low[k] - grown));
        high_[k].push_back(round_high(high[k] + grown));
    }
}

}  // namespace cspace::collision
