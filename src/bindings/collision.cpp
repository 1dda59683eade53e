// The compiled half of cspace.collision: robots made of spheres, scenes, and checks of one in the other.
#include "collision.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include "bindings.hpp"
#include "cspace/kinematics/pose_matrix.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::collision;

namespace {

using Integers = Plain<const std::int64_t>;

std::vector<std::pair<int, int>> read_pairs(const Integers& given) {
    require(given.ndim() == 2 && given.shape(1) == 2, "pairs must be an array (n, 2)");
    std::vector<std::pair<int, int>> pairs;
    for (npy_intp k = 0; k < given.size; k += 2)
        pairs.emplace_back(int(given.data[k]), int(given.data[k + 1]));
    return pairs;
}

// joints (n, 21): the pose T_parent_joint by rows, parent, coordinate, ratio, offset, prismatic.
std::shared_ptr<RobotData> make_robot(const ConstDoubles& joints, const ConstDoubles& bounds,
                                      const Integers& link_bodies, const ConstDoubles& spheres,
                                      const Integers& sphere_links, const Integers& pairs,
                                      const ConstDoubles& solids, const Integers& sphere_solids) {
    constexpr npy_intp solid_width = 16;
    require(solids.ndim() == 2 && solids.shape(1) == solid_width && sphere_solids.size == sphere_links.size,
            "solids must be an array (n, 16), with the solid of each sphere");
    constexpr npy_intp joint_width = 21;
    require(joints.ndim() == 2 && joints.shape(1) == joint_width, "joints must be an array (n, 21)");
    require(bounds.ndim() == 2 && bounds.shape(0) == 2, "bounds must be an array (2, n)");
    require(spheres.ndim() == 2 && spheres.shape(1) == 4 && spheres.shape(0) == sphere_links.size,
            "spheres must be an array (n, 4), with the link of each");
    std::vector<model::Joint> read;
    for (const double* row = joints.data; row < joints.data + joints.size; row += joint_width)
        read.push_back({kinematics::read_matrix(row), int(row[16]), int(row[17]), row[18], row[19],
                        row[20] != 0.0, 0.0});
    std::vector<Sphere> balls;
    for (npy_intp k = 0; k < sphere_links.size; ++k) {
        const double* row = spheres.data + 4 * k;
        balls.push_back(
            {{row[0], row[1], row[2]}, row[3], int(sphere_links.data[k]), int(sphere_solids.data[k])});
    }
    std::vector<shapes::Convex> exact;
    for (npy_intp k = 0; k < solids.shape(0); ++k)
        exact.push_back(collision::read_solid(solids.data + solid_width * k));
    const std::vector<int> bodies(link_bodies.data, link_bodies.data + link_bodies.size);
    const std::size_t n = std::size_t(bounds.shape(1));
    return std::make_shared<RobotData>(read, int(n), std::span(bounds.data, n), std::span(bounds.data + n, n),
                                       bodies, balls, read_pairs(pairs), exact);
}

std::vector<int> read_integers(const Integers& given) { return {given.data, given.data + given.size}; }

// Whether parts of these sizes, none of them empty, have so many items in all.
bool are_parts(const std::vector<int>& sizes, npy_intp items) {
    for (const int size : sizes) {
        if (size <= 0) return false;
        items -= size;
    }
    return items == 0;
}

std::shared_ptr<SceneData> make_scene(const ConstDoubles& boxes, const ConstDoubles& capsules,
                                      const ConstDoubles& cylinders, const ConstDoubles& half_spaces,
                                      const ConstDoubles& triangles, const Integers& mesh_sizes,
                                      const Integers& is_solid, const ConstDoubles& points,
                                      const Integers& cloud_sizes, const ConstDoubles& cloud_radii,
                                      const Integers& owners) {
    const auto rows = [](const ConstDoubles& given, npy_intp width) {
        require(given.ndim() == 2 && given.shape(1) == width, "primitives have rows of another width");
        return std::span(given.data, std::size_t(given.size));
    };
    const std::vector<int> meshes = read_integers(mesh_sizes), solid = read_integers(is_solid),
                           clouds = read_integers(cloud_sizes), numbers = read_integers(owners);
    const Primitives given = {rows(boxes, 15),
                              rows(capsules, 7),
                              rows(cylinders, 8),
                              rows(half_spaces, 4),
                              rows(triangles, 9),
                              rows(points, 3),
                              std::span(cloud_radii.data, std::size_t(cloud_radii.size)),
                              meshes,
                              solid,
                              clouds,
                              numbers};
    require(are_parts(meshes, triangles.shape(0)) && solid.size() == meshes.size(),
            "every triangle needs a mesh");
    require(are_parts(clouds, points.shape(0)) && cloud_radii.size == cloud_sizes.size,
            "every point needs a cloud");
    require(boxes.shape(0) + capsules.shape(0) + cylinders.shape(0) + half_spaces.shape(0) + mesh_sizes.size +
                    cloud_sizes.size ==
                owners.size,
            "every primitive needs an owner");
    return std::make_shared<SceneData>(given);
}

void require_configuration(const Checker& checker, const ConstDoubles& q) {
    require(q.ndim() == 1 && q.size == checker.dof(), "a configuration must be an array (dof,)");
}

std::optional<NamedContact> find_contact(const Checker& checker, const ConstDoubles& q) {
    require_configuration(checker, q);
    const Checker::Borrowed memory = checker.borrow_workspace();
    if (checker.is_free(q.data, *memory)) return std::nullopt;
    return name_contact(checker, memory->w.contact);
}

Plain<std::uint8_t> check_rows(const Checker& checker, const ConstDoubles& q, int threads) {
    require(q.ndim() == 2 && q.shape(1) == checker.dof(), "configurations must be an array (n, dof)");
    Plain<std::uint8_t> found({q.shape(0)});
    const nb::gil_scoped_release release;
    checker.check_rows(q.data, std::size_t(q.shape(0)), found.data, threads);
    return found;
}

Plain<std::int32_t> find_objects(const Checker& checker, const ConstDoubles& q, int threads) {
    require(q.ndim() == 2 && q.shape(1) == checker.dof(), "configurations must be an array (n, dof)");
    Plain<std::int32_t> found({q.shape(0)});
    const nb::gil_scoped_release release;
    checker.find_objects(q.data, std::size_t(q.shape(0)), found.data, threads);
    return found;
}

// Of cells q ± half, as the checker numbers them.
Plain<std::uint8_t> check_cells(const Checker& checker, const ConstDoubles& q, const ConstDoubles& half,
                                int threads) {
    require(q.ndim() == 2 && q.shape(1) == checker.dof(), "configurations must be an array (n, dof)");
    require(half.ndim() == 1 && half.size == checker.dof(), "half must be an array (dof,)");
    Plain<std::uint8_t> found({q.shape(0)});
    const nb::gil_scoped_release release;
    checker.check_cells(q.data, std::size_t(q.shape(0)), half.data, found.data, threads);
    return found;
}

// Verdict, contact and its place on the edge, 0 … 1. A resolution of zero: the edge is proved.
std::tuple<int, std::optional<NamedContact>, double> check_edge(const Checker& checker,
                                                                const ConstDoubles& from,
                                                                const ConstDoubles& to, double resolution) {
    require_configuration(checker, from);
    require_configuration(checker, to);
    const Checker::Borrowed memory = checker.borrow_workspace();
    const Verdict verdict = resolution > 0 ? checker.sample_edge(from.data, to.data, resolution, *memory)
                                           : checker.prove_edge(from.data, to.data, *memory);
    if (verdict != Verdict::blocked) return {int(verdict), std::nullopt, 0.0};
    const Contact& contact = memory->w.contact;
    return {int(verdict), name_contact(checker, contact), 0.5 + 0.5 * double(contact.at)};
}

// Distance, gradient, whether another pair is as near, and the nearest pair.
std::tuple<double, Doubles, bool, std::optional<NamedContact>> find_clearance(const Checker& checker,
                                                                              const ConstDoubles& q) {
    require_configuration(checker, q);
    const Clearance found = checker.clearance(q.data);
    const Doubles gradient({npy_intp(found.gradient.size())}, found.gradient.data());
    return {found.distance, gradient, found.is_crease, name_contact(checker, found.nearest)};
}

}  // namespace

void bind_collision(nb::module_& m) {
    nb::class_<RobotData>(m, "CollisionRobot", "A robot made of spheres and solids.")
        .def(nb::new_(&make_robot), "joints"_a, "bounds"_a, "link_bodies"_a, "spheres"_a, "sphere_links"_a,
             "pairs"_a, "solids"_a, "sphere_solids"_a)
        .def("__repr__", [](const RobotData& robot) {
            return "<CollisionRobot of " + std::to_string(robot.given_spheres().size()) + " spheres, " +
                   std::to_string(robot.given_solids().size()) + " solids, " +
                   std::to_string(robot.given_joints().size()) + " joints>";
        });
    nb::class_<SceneData>(m, "CollisionScene", "Obstacles in the frame of a robot's base.")
        .def(nb::new_(&make_scene), "boxes"_a, "capsules"_a, "cylinders"_a, "half_spaces"_a, "triangles"_a,
             "mesh_sizes"_a, "is_solid"_a, "points"_a, "cloud_sizes"_a, "cloud_radii"_a, "owners"_a);
    nb::class_<Checker>(m, "CollisionChecker", "A robot among obstacles.")
        .def(nb::new_([](std::shared_ptr<const RobotData> robot, std::shared_ptr<const SceneData> scene,
                         double margin, const Integers& allowed) {
                 return std::make_shared<Checker>(robot, scene, margin, read_pairs(allowed));
             }),
             "robot"_a, "scene"_a, "margin"_a, "allowed"_a)
        .def("__repr__",
             [](const Checker& checker) {
                 return "<CollisionChecker of configurations with " + std::to_string(checker.dof()) +
                        " joints>";
             })
        .def("find_contact", &find_contact, "q"_a, "What touches at a configuration (dof,), None if nothing.")
        .def("check_rows", &check_rows, "q"_a, "threads"_a,
             "A byte per configuration (n, dof): 1 where something touches.")
        .def("find_objects", &find_objects, "q"_a, "threads"_a,
             "What touches at configurations (n, dof): the number of an obstacle, -1 for nothing, -2 for the "
             "robot itself.")
        .def("check_cells", &check_cells, "q"_a, "half"_a, "threads"_a,
             "A byte per cell q ± half, q (n, dof): 1 where its middle touches something, and 2 more where "
             "all "
             "of it is so.")
        .def("check_edge", &check_edge, "start"_a, "end"_a, "resolution"_a, "Verdict, contact and its place.")
        .def("find_clearance", &find_clearance, "q"_a,
             "Distance, gradient, whether another pair is as near, the nearest pair.");
}
