// The compiled halves of cspace.maps.OccupancyGrid and cspace.maps.PolygonWorld.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "library/maps_polygon_world.hpp"
#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using cspace::Point;
using namespace cspace::maps;

void bind_maps(nb::module_& m) {
    nb::class_<GridWorld>(m, "GridBase", "The compiled half of cspace.maps.OccupancyGrid.")
        .def(nb::init<CellBytes, double, Point>(), "blocked"_a, "resolution"_a, "origin"_a)
        .def(nb::init<const GridWorld&, double, bool>(), "other"_a, "radius"_a, "from_centers"_a,
             WithoutLock())
        .def("_unpack", &GridWorld::unpack, "A byte per cell (rows, columns).")
        .def("_free", &GridWorld::find_free, "points"_a, "A byte per point: 1 in free cells.")
        .def("_path_clearance", &GridWorld::path_clearance, "path"_a, WithoutLock(),
             "The least distance from a path to a blocked cell.")
        .def("_locate", &GridWorld::locate, "point"_a, "Place, row and column of a point.")
        .def_ro("rows", &GridWorld::rows, "Number of rows.")
        .def_ro("columns", &GridWorld::columns, "Number of columns.")
        .def_ro("resolution", &GridWorld::resolution, "Side of a cell [m].")
        .def_ro("_x", &GridWorld::x)
        .def_ro("_y", &GridWorld::y)
        .def_prop_ro("blocked_cells", &GridWorld::count_blocked, "How many cells are blocked.")
        .def_prop_ro("_corners", &GridWorld::count_corners)
        .def_prop_ro("nbytes", &GridWorld::bytes,
                     "Memory that the cells, and their parts if a search has asked for them, take [bytes].");
    using Integers = std::span<const std::int32_t>;
    nb::class_<PolygonCore>(m, "PolygonCore", "The compiled half of cspace.maps.PolygonWorld.")
        .def(nb::init<std::span<const Point>, Integers, Integers, Point, Point, double>(), "points"_a,
             "ends"_a, "owners"_a, "low"_a, "high"_a, "tolerance"_a, WithoutLock(),
             "Closed rings (n, 2), the end of each, the obstacle of each; the corners of the bounds.")
        .def(nb::init<CellBytes, double, Point, double>(), "blocked"_a, "side"_a, "origin"_a, "tolerance"_a,
             WithoutLock(), "The blocked cells (rows, columns) of a grid as polygons.")
        .def("rasterize", &PolygonCore::rasterize, "side"_a, "rows"_a, "columns"_a, WithoutLock(),
             "A byte per cell (rows, columns): 1 where obstacles reach into it.")
        .def_prop_ro("complete", &PolygonCore::complete, "False where the outlines cross too often.")
        .def_prop_ro("components", &PolygonCore::components, "How many components free space has.")
        .def("crossings", &PolygonCore::crossings,
             "Where outlines cross (k, 2), and the two obstacles of each.")
        .def("walls", &PolygonCore::walls, "Points (k, 2), next (k,), ring (k,), component of each ring.")
        .def("triangles", &PolygonCore::triangles, "The free triangles, (3, 2) each.")
        .def("convex_polygons", &PolygonCore::convex_polygons, "Free space as convex polygons, (n, 2) each.")
        .def("components_at", &PolygonCore::components_at, "point"_a,
             "The components whose closures hold a point.")
        .def("obstacle_at", &PolygonCore::obstacle_at, "point"_a, "An obstacle that covers a point, or -1.")
        .def("nearest_wall", &PolygonCore::nearest_wall, "point"_a,
             "Distance to the nearest wall, and its point: x, y.")
        .def("path_clearance", &PolygonCore::path_clearance, "path"_a, WithoutLock(),
             "The least distance from a path to a wall.");
}
