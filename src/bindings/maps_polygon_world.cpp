// The compiled half of cspace.maps.PolygonWorld.
#include "library/maps_polygon_world.hpp"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using maps::PolygonCore;

namespace {

using Integers = Array<const std::int32_t, nb::ndim<1>>;
using PointPair = Array<const double, nb::shape<2, 2>>;

void make(PolygonCore* at, Points points, Integers ends, Integers owners, PointPair bounds,
          double tolerance) {
    const double* b = bounds.data();
    const nb::gil_scoped_release free;
    new (at) PolygonCore(points_of(points), {ends.data(), ends.size()}, {owners.data(), owners.size()},
                         {b[0], b[1]}, {b[2], b[3]}, tolerance);
}

PolygonCore* from_cells(Array<const std::uint8_t, nb::ndim<2>> blocked, double side, double x, double y,
                        double tolerance) {
    const nb::gil_scoped_release free;
    return new PolygonCore(blocked.data(), int(blocked.shape(0)), int(blocked.shape(1)), side, {x, y},
                           tolerance);
}

auto crossings(const PolygonCore& core) {
    std::vector<Point> at;
    std::vector<std::pair<int, int>> pairs;
    for (const auto& crossing : core.crossings()) {
        at.push_back(crossing.at);
        pairs.push_back(crossing.obstacles);
    }
    return std::tuple(point_table(std::move(at)), std::move(pairs));
}

auto walls(const PolygonCore& core) {
    maps::Boundary b = core.walls();
    return std::tuple(point_table(std::move(b.points)), table(std::move(b.next)), table(std::move(b.ring)),
                      table(std::move(b.component)));
}

template <auto polygons>
std::vector<Numbers<double>> tables_of(const PolygonCore& core) {
    std::vector<Numbers<double>> all;
    for (auto& corners : (core.*polygons)()) all.push_back(point_table(std::move(corners)));
    return all;
}

std::tuple<double, double, double> nearest_wall(const PolygonCore& core, double x, double y) {
    const auto [far, at] = core.nearest_wall({x, y});
    return {far, at.x, at.y};
}

double path_least(const PolygonCore& core, Points path) {
    const nb::gil_scoped_release free;
    return core.path_clearance(points_of(path));
}

void rasterize_into(const PolygonCore& core, double side, Array<std::uint8_t, nb::ndim<2>> blocked) {
    const nb::gil_scoped_release free;
    core.rasterize(side, int(blocked.shape(0)), int(blocked.shape(1)), blocked.data());
}

}  // namespace

void bind_maps_polygon_world(nb::module_& m) {
    nb::class_<PolygonCore>(m, "PolygonCore", "The compiled half of cspace.maps.PolygonWorld.")
        .def("__init__", make, "points"_a, "ends"_a, "owners"_a, "bounds"_a, "tolerance"_a,
             "Closed rings (n, 2), the end of each, the obstacle of each; the low and high corner of the "
             "bounds.")
        .def_static("from_cells", from_cells, "blocked"_a, "side"_a, "x"_a, "y"_a, "tolerance"_a,
                    nb::rv_policy::take_ownership, "The blocked cells (rows, columns) of a grid as polygons.")
        .def("rasterize", rasterize_into, "side"_a, "blocked"_a,
             "Marks in blocked (rows, columns) the cells that obstacles reach into.")
        .def_prop_ro("complete", &PolygonCore::complete, "False where the outlines cross too often.")
        .def_prop_ro("components", &PolygonCore::components, "How many components free space has.")
        .def("crossings", crossings, "Where outlines cross (k, 2), and the two obstacles of each.")
        .def("walls", walls, "Points (k, 2), next (k,), ring (k,), component of each ring.")
        .def("triangles", tables_of<&PolygonCore::triangles>, "The free triangles, (3, 2) each.")
        .def("convex_polygons", tables_of<&PolygonCore::convex_polygons>,
             "Free space as convex polygons, (n, 2) each.")
        .def(
            "components_at",
            [](const PolygonCore& core, double x, double y) { return core.components_at({x, y}); }, "x"_a,
            "y"_a, "The components whose closures hold a point.")
        .def(
            "obstacle_at",
            [](const PolygonCore& core, double x, double y) { return core.obstacle_at({x, y}); }, "x"_a,
            "y"_a, "An obstacle that covers a point, or -1.")
        .def("nearest_wall", nearest_wall, "x"_a, "y"_a, "Distance to the nearest wall, and its point.")
        .def("path_clearance", path_least, "path"_a, "The least distance from a path to a wall.");
}
