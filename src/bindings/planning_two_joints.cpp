// The compiled half of cspace.planning.ConfigurationSpace.
#include "library/planning_two_joints.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using cspace::Point;
using namespace cspace::planning;

using Four = std::array<double, 4>;

static TwoJointSpace make_space(Point base, Point lengths, double link_radius, Four joint_1, Four joint_2,
                                bool wraps_1, bool wraps_2, std::span<const Point> corners,
                                std::span<const std::int32_t> ends, std::span<const double> radii,
                                std::span<const std::int32_t> obstacles) {
    const auto joint = [](const Four& j) { return JointNumbers{j[0], j[1], j[2], j[3]}; };
    return {base,
            {lengths.x, lengths.y},
            link_radius,
            {joint(joint_1), joint(joint_2)},
            {wraps_1, wraps_2},
            {corners, ends, radii, obstacles}};
}

void bind_planning_two_joints(nb::module_& m) {
    nb::class_<TwoJointSpace>(m, "TwoJointSpace", "The compiled half of cspace.planning.ConfigurationSpace.")
        .def(nb::new_(&make_space), "base"_a, "lengths"_a, "link_radius"_a, "joint_1"_a, "joint_2"_a,
             "wraps_1"_a, "wraps_2"_a, "corners"_a, "ends"_a, "radii"_a, "obstacles"_a,
             "Joints as sign, offset, lower, upper; convex pieces as corners (n, 2), the end, the radius and "
             "the obstacle of each.")
        .def("bitmap", &TwoJointSpace::bitmap, "rows"_a, "columns"_a, WithoutLock(),
             "A byte per cell (rows, columns): 1 where the arm touches.")
        .def("obstacle_map", &TwoJointSpace::obstacle_map, "rows"_a, "columns"_a, WithoutLock(),
             "The obstacle in each cell (rows, columns), -1 where it is free.")
        .def(
            "obstacles_at",
            [](const TwoJointSpace& space, std::span<const Point> q) {
                return cspace::Table<std::int32_t>{space.obstacles_at(q)};
            },
            "q"_a, "The obstacle at each configuration (n, 2), -1 where it is free.")
        .def("boundaries", &TwoJointSpace::boundaries, WithoutLock(),
             "Points (k, 2) of all curves; the end, the kind and the obstacle of each.")
        .def("components", &TwoJointSpace::components, WithoutLock(),
             "Least and greatest area (n, 2), a configuration (n, 2) and the region (n,) of each.")
        .def("component_at", &TwoJointSpace::component_at, "q"_a, WithoutLock(),
             "The component of a configuration; -1 where it is not free, -2 where it is not known.")
        .def("find_path", &TwoJointSpace::find_path, "start"_a, "goal"_a, WithoutLock(),
             "A free path (m, 2); empty where none is known.");
}
