#include "maps_polygon_world.hpp"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "cspace/maps/grid_outlines.hpp"
#include "cspace/maps/path_clearance.hpp"
#include "cspace/maps/rasterize.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::maps;

namespace {

using Points = Array<const double, nb::shape<-1, 2>>;
using Integers = Array<const std::int32_t, nb::ndim<1>>;
using PointPair = Array<const double, nb::shape<2, 2>>;
using Numbers = nb::ndarray<nb::numpy, double>;

Numbers points_array(const std::vector<Point>& points) {
    auto* copy = new std::vector<Point>(points);
    nb::capsule owner(copy, [](void* p) noexcept { delete static_cast<std::vector<Point>*>(p); });
    return Numbers(copy->data(), {points.size(), 2}, owner);
}

// The closed rings points[ends[r − 1]:ends[r]], each owned by an obstacle.
void make(PolygonCore* self, Points points, Integers ends, Integers owners, PointPair bounds,
          double tolerance) {
    if (ends.size() != owners.size()) throw nb::value_error("as many ends as owners");
    Outlines world;
    world.low = {bounds.data()[0], bounds.data()[1]};
    world.high = {bounds.data()[2], bounds.data()[3]};
    const auto* all = reinterpret_cast<const Point*>(points.data());
    std::size_t begin = 0;
    for (std::size_t r = 0; r < ends.size(); ++r) {
        const auto end = std::size_t(ends.data()[r]);
        if (end < begin || end > points.shape(0) || owners.data()[r] < 0)
            throw nb::value_error("ends that grow");
        world.add_ring({all + begin, end - begin}, owners.data()[r]);
        begin = end;
    }
    nb::gil_scoped_release free;
    new (self) PolygonCore(std::move(world));
    self->tolerance = tolerance;
}

// Where outlines cross: points (k, 2) and the two obstacles of each.
nb::tuple crossings(const PolygonCore& core) {
    const FreeSpace& space = core.world.space;
    std::vector<Point> at;
    nb::list pairs;
    const auto first_owner = [&](Index list) { return space.owners[std::size_t(list)].id; };
    const auto shared_owner = [&](Index one, Index other) {
        for (Index a = one; a != none; a = space.owners[std::size_t(a)].next)
            for (Index b = other; b != none; b = space.owners[std::size_t(b)].next)
                if (space.owners[std::size_t(a)].id == space.owners[std::size_t(b)].id)
                    return space.owners[std::size_t(a)].id;
        return none;
    };
    for (const auto& crossing : space.crossings) {
        const Index shared = shared_owner(crossing.one, crossing.other);
        at.push_back(crossing.at);
        pairs.append(shared != none ? nb::make_tuple(shared, shared)
                                    : nb::make_tuple(first_owner(crossing.one), first_owner(crossing.other)));
    }
    return nb::make_tuple(points_array(at), pairs);
}

// The walls: points (k, 2) where each edge begins, the edge after it (k), its ring (k), each ring's
// component.
nb::tuple walls(const PolygonCore& core) {
    const Boundary& b = core.world.walls;
    const auto list = [](const std::vector<Index>& numbers) {
        auto* copy = new std::vector<Index>(numbers);
        nb::capsule owner(copy, [](void* p) noexcept { delete static_cast<std::vector<Index>*>(p); });
        return nb::ndarray<nb::numpy, Index>(copy->data(), {numbers.size()}, owner);
    };
    return nb::make_tuple(points_array(b.points), list(b.next), list(b.ring), list(b.component));
}

// The free triangles or the convex polygons as lists of corners.
nb::list triangles(const PolygonCore& core) {
    const FreeSpace& space = core.world.space;
    nb::list all;
    for (Index t = 0; t < Index(space.mesh.triangles.size()); ++t) {
        if (!space.is_free(t)) continue;
        std::vector<Point> corners;
        for (const Index v : space.mesh[t].corner) corners.push_back(space.mesh.point(v));
        all.append(points_array(corners));
    }
    return all;
}
nb::list convex_polygons(const PolygonCore& core) {
    const ConvexMesh& mesh = core.world.mesh();
    nb::list all;
    for (Index p = 0; p < mesh.size(); ++p) {
        std::vector<Point> corners;
        for (Index e = mesh.begin(p); e < mesh.end(p); ++e)
            corners.push_back(mesh.point(mesh.corner[std::size_t(e)]));
        all.append(points_array(corners));
    }
    return all;
}

// The components of free space whose closures hold a point; none inside obstacles.
std::vector<Index> components_at(const PolygonCore& core, double x, double y) {
    const Settled settled = core.world.settle({x, y}, core.tolerance);
    std::vector<Index> found;
    for (const Index t : settled.triangles) {
        const Index c = core.world.space.component[std::size_t(t)];
        if (std::find(found.begin(), found.end(), c) == found.end()) found.push_back(c);
    }
    return found;
}

// An obstacle that covers a point, or −1.
Index obstacle_at(const PolygonCore& core, double x, double y) {
    if (!core.world.is_inside_bounds({x, y})) return none;
    const Place place = core.world.space.mesh.locate({x, y}, core.world.locator.near({x, y}));
    return place.triangle == none ? none : core.world.space.obstacle[std::size_t(place.triangle)];
}

// The distance from a point to the nearest wall [m], and the wall's point.
nb::tuple nearest_wall(const PolygonCore& core, double x, double y) {
    const Boundary& walls = core.world.walls;
    double best = std::numeric_limits<double>::infinity();
    Point at{};
    for (Index e = 0; e < Index(walls.size()); ++e) {
        const Point a = walls.begin(e), along = walls.end(e) - a;
        const double t = std::clamp(dot(Point{x, y} - a, along) / squared_norm(along), 0.0, 1.0);
        const Point foot = a + t * along;
        if (const double d = distance({x, y}, foot); d < best) best = d, at = foot;
    }
    return nb::make_tuple(best, at.x, at.y);
}

// The least distance from a path (m, 2) to a wall [m].
double path_least(const PolygonCore& core, Array<const double, nb::shape<-1, 2>> path) {
    nb::gil_scoped_release free;
    return path_clearance({reinterpret_cast<const Point*>(path.data()), path.shape(0)}, core.world.walls);
}

void rasterize_into(const PolygonCore& core, double side, Array<std::uint8_t, nb::ndim<2>> blocked) {
    nb::gil_scoped_release free;
    rasterize(core.world.space, core.world.outlines.low, side, int(blocked.shape(0)), int(blocked.shape(1)),
              core.tolerance, blocked.data());
}

// The world of a grid's blocked cells (rows, columns), moved to where the grid lies.
PolygonCore* from_cells(Array<const std::uint8_t, nb::ndim<2>> blocked, double side, double x, double y,
                        double tolerance) {
    nb::gil_scoped_release free;
    const BitGrid grid(blocked.data(), int(blocked.shape(0)), int(blocked.shape(1)));
    Outlines world = outlines_of(grid);
    const auto moved = [&](Point p) { return Point{x + side * p.x, y + side * p.y}; };
    for (Point& p : world.points) p = moved(p);
    world.low = moved(world.low), world.high = moved(world.high);
    auto* core = new PolygonCore(std::move(world));
    core->tolerance = tolerance;
    return core;
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
        .def_prop_ro(
            "complete", [](const PolygonCore& c) { return c.world.space.complete; },
            "False where the outlines cross too often.")
        .def_prop_ro(
            "components", [](const PolygonCore& c) { return c.world.space.components; },
            "How many components free space has.")
        .def("crossings", crossings,
             nb::sig("def crossings(self) -> tuple[NDArray[numpy.float64], list[tuple[int, int]]]"),
             "Where outlines cross (k, 2), and the two obstacles of each.")
        .def("walls", walls,
             nb::sig("def walls(self) -> tuple[NDArray[numpy.float64], NDArray[numpy.int32], "
                     "NDArray[numpy.int32], NDArray[numpy.int32]]"),
             "Points (k, 2), next (k,), ring (k,), component of each ring.")
        .def("triangles", triangles, nb::sig("def triangles(self) -> list[NDArray[numpy.float64]]"),
             "The free triangles, (3, 2) each.")
        .def("convex_polygons", convex_polygons,
             nb::sig("def convex_polygons(self) -> list[NDArray[numpy.float64]]"),
             "Free space as convex polygons, (n, 2) each.")
        .def("components_at", components_at, "x"_a, "y"_a, "The components whose closures hold a point.")
        .def("obstacle_at", obstacle_at, "x"_a, "y"_a, "An obstacle that covers a point, or -1.")
        .def("nearest_wall", nearest_wall,
             nb::sig("def nearest_wall(self, x: float, y: float) -> tuple[float, float, float]"), "x"_a,
             "y"_a, "Distance to the nearest wall, and its point.")
        .def("path_clearance", path_least, "path"_a, "The least distance from a path to a wall.");
}
