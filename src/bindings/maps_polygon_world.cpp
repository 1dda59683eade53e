// The compiled half of cspace.maps.PolygonWorld.
#include "library/maps_polygon_world.hpp"

#include <nanobind/stl/pair.h>
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

nb::tuple crossings(const PolygonCore& core) {
    std::vector<Point> at;
    nb::list pairs;
    for (const auto& crossing : core.crossings()) {
        at.push_back(crossing.at);
        pairs.append(nb::make_tuple(crossing.obstacles.first, crossing.obstacles.second));
    }
    return nb::make_tuple(point_table(at), pairs);
}

nb::tuple walls(const PolygonCore& core) {
    maps::Boundary b = core.walls();
    return nb::make_tuple(point_table(b.points), table(std::move(b.next)), table(std::move(b.ring)),
                          table(std::move(b.component)));
}

nb::list tables(const std::vector<std::vector<Point>>& polygons) {
    nb::list all;
    for (const auto& corners : polygons) all.append(point_table(corners));
    return all;
}

nb::tuple nearest_wall(const PolygonCore& core, double x, double y) {
    const auto [far, at] = core.nearest_wall({x, y});
    return nb::make_tuple(far, at.x, at.y);
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
        .def("crossings", crossings,
             nb::sig("def crossings(self) -> tuple[NDArray[numpy.float64], list[tuple[int, int]]]"),
             "Where outlines cross (k, 2), and the two obstacles of each.")
        .def("walls", walls,
             nb::sig("def walls(self) -> tuple[NDArray[numpy.float64], NDArray[numpy.int32], "
                     "NDArray[numpy.int32], NDArray[numpy.int32]]"),
             "Points (k, 2), next (k,), ring (k,), component of each ring.")
        .def(
            "triangles", [](const PolygonCore& core) { return tables(core.triangles()); },
            nb::sig("def triangles(self) -> list[NDArray[numpy.float64]]"),
            "The free triangles, (3, 2) each.")
        .def(
            "convex_polygons", [](const PolygonCore& core) { return tables(core.convex_polygons()); },
            nb::sig("def convex_polygons(self) -> list[NDArray[numpy.float64]]"),
            "Free space as convex polygons, (n, 2) each.")
        .def(
            "components_at",
            [](const PolygonCore& core, double x, double y) { return core.components_at({x, y}); }, "x"_a,
            "y"_a, "The components whose closures hold a point.")
        .def(
            "obstacle_at",
            [](const PolygonCore& core, double x, double y) { return core.obstacle_at({x, y}); }, "x"_a,
            "y"_a, "An obstacle that covers a point, or -1.")
        .def("nearest_wall", nearest_wall,
             nb::sig("def nearest_wall(self, x: float, y: float) -> tuple[float, float, float]"), "x"_a,
             "y"_a, "Distance to the nearest wall, and its point.")
        .def("path_clearance", path_least, "path"_a, "The least distance from a path to a wall.");
}
