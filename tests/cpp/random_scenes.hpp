// Random trees of joints with spheres, and random scenes of every primitive, for the tests of collision.
#pragma once

#include <memory>
#include <vector>

#include "cspace/shapes/convex.hpp"
#include "library/collision_checker.hpp"
#include "random.hpp"

namespace check {

struct RandomCell {
    std::vector<cspace::model::Joint> joints;
    std::vector<double> lower, upper;
    std::vector<int> link_bodies;
    std::vector<cspace::collision::Sphere> spheres;
    std::vector<cspace::shapes::Convex> solids;
    std::vector<std::pair<int, int>> pairs;
    std::vector<double> boxes, capsules, cylinders, half_spaces, triangles, points, cloud_radii;
    std::vector<int> mesh_sizes, is_solid, cloud_sizes, owners;
    std::unique_ptr<cspace::collision::Checker> checker;

    std::vector<double> configuration(Random& random) const {
        std::vector<double> q;
        for (std::size_t k = 0; k < lower.size(); ++k) q.push_back(random.uniform(lower[k], upper[k]));
        return q;
    }
};

inline cspace::Mat3d random_rotation(Random& random) {
    const cspace::Vec3d z = random.axis();
    const cspace::Mat3d turned = cspace::frame_along(z);
    const double angle = random.uniform(-3, 3), c = std::cos(angle), s = std::sin(angle);
    return turned * cspace::Mat3d{{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}

// A closed surface around `center`, of rings of corners at random distances: a star of spikes and dents. A
// third of them are surfaces without a solid.
inline void add_mesh(Random& random, RandomCell& cell, const cspace::Vec3d& center) {
    using namespace cspace;
    const int rings = 2 + random.below(5), sectors = 3 + random.below(6);
    const Mat3d R = random_rotation(random);
    const double size = random.uniform(0.02, 0.4), rough = random.uniform(0, 0.8);
    const auto corner = [&](double polar, double angle) {
        const double r = size * (1 - rough * random.uniform(0, 1));
        return center + r * (R * Vec3d{std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                                       std::cos(polar)});
    };
    constexpr double pi = 3.14159265358979323846;
    const Vec3d top = corner(0, 0), bottom = corner(pi, 0);
    std::vector<std::vector<Vec3d>> grid;
    for (int i = 0; i < rings; ++i) {
        grid.emplace_back();
        for (int j = 0; j < sectors; ++j)
            grid.back().push_back(corner(pi * (i + 1) / (rings + 1), 2 * pi * j / sectors));
    }
    int count = 0;
    const auto add = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
        for (const Vec3d& v : {a, b, c}) cell.triangles.insert(cell.triangles.end(), {v.x, v.y, v.z});
        ++count;
    };
    for (int j = 0; j < sectors; ++j) {
        const auto at = [&](int i, int k) { return grid[std::size_t(i)][std::size_t((j + k) % sectors)]; };
        add(top, at(0, 0), at(0, 1));
        add(bottom, at(rings - 1, 1), at(rings - 1, 0));
        for (int i = 0; i + 1 < rings; ++i) {
            add(at(i, 0), at(i + 1, 0), at(i + 1, 1));
            add(at(i, 0), at(i + 1, 1), at(i, 1));
        }
    }
    cell.mesh_sizes.push_back(count);
    cell.is_solid.push_back(random.uniform(0, 1) < 0.67);
}

// A box, cylinder or capsule in the frame of a body, and the ball around it for a cover.
inline void add_solid(Random& random, RandomCell& cell, int link, const cspace::Vec3d& center) {
    using namespace cspace;
    const Posed pose = {random_rotation(random), center};
    const auto size = [&] { return random.uniform(0.01, 0.12); };
    const Vec3d ends[] = {center, pose * Vec3d{0, 0, 2 * size()}};
    const int kind = random.below(3);
    const shapes::Convex solid = kind == 0   ? shapes::make_box(pose, {size(), size(), size()})
                                 : kind == 1 ? shapes::make_cylinder(pose, size(), size())
                                             : shapes::make_points(ends, 2, size() / 2);
    cell.spheres.push_back(
        {shapes::find_center(solid), shapes::bound_size(solid), link, int(cell.solids.size())});
    cell.solids.push_back(solid);
}

// A tree of n joints: some prismatic, some that mimic another, one link or two per body, up to 20 spheres a
// link, and solids if asked for; every pair of bodies that are not neighbours is checked.
inline RandomCell random_cell(Random& random, int n, double margin = 0, bool has_solids = false) {
    using namespace cspace;
    RandomCell cell;
    int coordinates = 0;
    for (int k = 0; k < n; ++k) {
        model::Joint joint = {};
        joint.parent = k == 0 ? -1 : random.uniform(0, 1) < 0.8 ? k - 1 : random.below(k) - 1;
        joint.T_parent_joint = {
            random.uniform(0, 1) < 0.5 ? Mat3d{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}} : random_rotation(random),
            0.3 * random.vector()};
        joint.prismatic = random.uniform(0, 1) < 0.2;
        const bool follows = coordinates > 0 && random.uniform(0, 1) < 0.1;
        joint.coordinate = follows ? random.below(coordinates) : coordinates++;
        joint.ratio = follows ? random.uniform(-1, 1) : 1;
        joint.offset = follows ? random.uniform(-0.1, 0.1) : 0;
        cell.joints.push_back(joint);
    }
    for (int k = 0; k < coordinates; ++k) cell.lower.push_back(-2), cell.upper.push_back(2);
    for (int b = 0; b <= n; ++b)
        for (int l = random.below(3); l > 0; --l) {
            const int link = int(cell.link_bodies.size());
            cell.link_bodies.push_back(b);
            const Vec3d center = 0.15 * random.vector();
            for (int s = has_solids ? random.below(3) : 0; s > 0; --s)
                add_solid(random, cell, link, center + 0.1 * random.vector());
            for (int s = random.uniform(0, 1) < 0.3 ? 20 : 1 + random.below(4); s > 0; --s)
                cell.spheres.push_back({center + 0.1 * random.vector(), random.uniform(0.01, 0.06), link});
        }
    for (std::size_t a = 0; a < cell.link_bodies.size(); ++a)
        for (std::size_t b = a + 1; b < cell.link_bodies.size(); ++b) {
            const int from = cell.link_bodies[a], to = cell.link_bodies[b];
            const bool are_neighbours = from == to || cell.joints[std::size_t(to - 1)].parent + 1 == from;
            if (!are_neighbours) cell.pairs.push_back({int(a), int(b)});
        }
    const auto add = [](std::vector<double>& rows, const Vec3d& v) {
        rows.insert(rows.end(), {v.x, v.y, v.z});
    };
    const auto place = [&] { return 0.5 * random.vector() + random.uniform(0.4, 1.0) * random.axis(); };
    const int many = random.uniform(0, 1) < 0.1 ? 100 : 0;  // the boxes of primitives are in a tree then
    for (int k = random.below(6) + many; k > 0; --k) {
        const Mat3d R = random_rotation(random);
        add(cell.boxes, place());
        for (int r = 0; r < 3; ++r) add(cell.boxes, matrix_row(R, r));
        const double most = many ? 0.06 : 0.3;
        add(cell.boxes,
            {random.uniform(0.02, most), random.uniform(0.02, most), random.uniform(0.001, most)});
    }
    for (int k = random.below(5); k > 0; --k) {
        const Vec3d a = place();
        add(cell.capsules, a);
        add(cell.capsules, random.uniform(0, 1) < 0.3 ? a : a + 0.3 * random.vector());
        cell.capsules.push_back(random.uniform(0.01, 0.1));
    }
    for (int k = random.below(4); k > 0; --k) {
        add(cell.cylinders, place());
        add(cell.cylinders, random.axis());
        cell.cylinders.insert(cell.cylinders.end(), {random.uniform(0.01, 0.3), random.uniform(0.01, 0.2)});
    }
    if (random.uniform(0, 1) < 0.5) {
        add(cell.half_spaces, random.axis());
        cell.half_spaces.push_back(-random.uniform(0.5, 1.0));
    }
    for (int k = random.below(3); k > 0; --k) add_mesh(random, cell, place());
    for (int k = random.below(2); k > 0; --k) {
        const Vec3d center = place();
        cell.cloud_sizes.push_back(1 + random.below(100));
        cell.cloud_radii.push_back(random.uniform(0, 0.03));
        for (int i = 0; i < cell.cloud_sizes.back(); ++i) add(cell.points, center + 0.2 * random.vector());
    }
    const std::size_t count = cell.boxes.size() / 15 + cell.capsules.size() / 7 + cell.cylinders.size() / 8 +
                              cell.half_spaces.size() / 4 + cell.mesh_sizes.size() + cell.cloud_sizes.size();
    for (std::size_t i = 0; i < count; ++i) cell.owners.push_back(int(i));
    std::vector<std::pair<int, int>> allowed;  // the base stands where it stands
    for (std::size_t l = 0; l < cell.link_bodies.size(); ++l)
        for (std::size_t i = 0; i < count; ++i)
            if (cell.link_bodies[l] == 0 || random.uniform(0, 1) < 0.02) allowed.push_back({int(l), int(i)});
    cell.checker = std::make_unique<collision::Checker>(
        std::make_shared<collision::RobotData>(cell.joints, coordinates, cell.lower, cell.upper,
                                               cell.link_bodies, cell.spheres, cell.pairs, cell.solids),
        std::make_shared<collision::SceneData>(collision::Primitives{
            cell.boxes, cell.capsules, cell.cylinders, cell.half_spaces, cell.triangles, cell.points,
            cell.cloud_radii, cell.mesh_sizes, cell.is_solid, cell.cloud_sizes, cell.owners}),
        margin, allowed);
    return cell;
}

}  // namespace check
