// The potential of a polygon world, and descents in it.
#include <limits>
#include <optional>

#include "cspace/navigation/fields/descent.hpp"
#include "cspace/navigation/fields/start_directions.hpp"
#include "maps_polygon_world.hpp"
#include "navigation_fields.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

using GainRow = Array<const double, nb::shape<6>>;
using Points = Array<const double, nb::shape<-1, 2>>;

// k, k_r, rho_0, cone, the longest step, the most looks at the potential.
struct Settings {
    Gains gains;
    double longest;
    std::int64_t budget;
};
Settings settings_of(const GainRow& row) {
    const double* s = row.data();
    return {{s[0], s[1], s[2], s[3]}, s[4], std::int64_t(s[5])};
}
Point point_of(const fields::PointRow& row) { return {row.data()[0], row.data()[1]}; }

void make(NearWalls* at, const PolygonCore& core, double reach) {
    new (at) NearWalls(core.world.walls, reach);
}

Descent descend(const NearWalls& walls, const PolygonCore& core, Point start, Point goal,
                const Settings& settings) {
    const maps::Settled from = core.world.settle(start, core.tolerance);
    const Potential potential(walls, settings.gains, start == goal ? from.at : goal);
    const double near = std::max(2 * core.tolerance, 1e-7 * settings.gains.rho_0);
    const std::vector<Point> inward = find_start_directions(core.world.space, from, walls, near);
    Descent made = DescentRun(walls, potential, settings.longest, settings.budget).run(from.at, inward);
    made.route.path.front() = start;
    return made;
}

// The evidence is what evidence(rest, force, saddles) makes of how it ended.
nb::object route(const NearWalls& walls, const PolygonCore& core, nb::handle world, nb::handle planner,
                 nb::handle options, fields::PointRow start, fields::PointRow goal, GainRow row,
                 nb::handle evidence) {
    const fields::Watch watch;
    Descent made;
    {
        nb::gil_scoped_release free;
        made = descend(walls, core, point_of(start), point_of(goal), settings_of(row));
    }
    nb::object route = fields::made_route(world, planner, options, start, goal, made.route, watch.seconds());
    fields::set_evidence(route, evidence(int(made.rest), made.force, made.saddles));
    return route;
}

nb::object trace(const NearWalls& walls, const PolygonCore& core, fields::PointRow start,
                 fields::PointRow goal, GainRow row) {
    const Descent made = descend(walls, core, point_of(start), point_of(goal), settings_of(row));
    Trace events;
    const std::vector<Point>& path = made.route.path;
    for (std::size_t k = 1; k < path.size(); ++k) events.push_back({0, path[k - 1], path[k], made.values[k]});
    if (made.rest != Rest::goal) events.push_back({1, path.back(), path.back(), made.values.back()});
    return fields::arrays_of(events);
}

nb::object values(const NearWalls& walls, const PolygonCore& core, fields::PointRow goal, Points points,
                  GainRow row) {
    std::vector<double> found;
    {
        nb::gil_scoped_release free;
        const Potential potential(walls, settings_of(row).gains, point_of(goal));
        const auto* p = reinterpret_cast<const Point*>(points.data());
        for (std::size_t k = 0; k < points.shape(0); ++k)
            found.push_back(core.world.settle(p[k], core.tolerance).is_free()
                                ? potential.value(p[k])
                                : std::numeric_limits<double>::infinity());
    }
    const std::size_t count = found.size();
    return fields::table(std::move(found), count, 0);
}

}  // namespace

void bind_navigation_fields_potential(nb::module_& m) {
    nb::class_<NearWalls>(m, "NearWalls", "The walls of a PolygonWorld, sorted by where they repel.")
        .def("__init__", make, "core"_a, "reach"_a)
        .def_prop_ro("reach", &NearWalls::reach, "How far walls repel [m].")
        .def("route", route,
             nb::sig("def route(self, core: PolygonCore, world: Any, planner: str, options: dict[str, Any], "
                     "start: ArrayLike, goal: ArrayLike, settings: ArrayLike, evidence: Any) -> Any"),
             "core"_a, "world"_a, "planner"_a, "options"_a, "start"_a, "goal"_a, "settings"_a, "evidence"_a,
             "A descent; its evidence is made by evidence(rest, force, saddles).")
        .def("trace", trace,
             nb::sig(
                 "def trace(self, core: PolygonCore, start: ArrayLike, goal: ArrayLike, settings: ArrayLike) "
                 "-> tuple[NDArray[numpy.int8], NDArray[numpy.float64], NDArray[numpy.float64], "
                 "NDArray[numpy.float64]]"),
             "core"_a, "start"_a, "goal"_a, "settings"_a, "The steps of a descent.")
        .def("values", values,
             nb::sig("def values(self, core: PolygonCore, goal: ArrayLike, points: ArrayLike, settings: "
                     "ArrayLike) "
                     "-> NDArray[numpy.float64]"),
             "core"_a, "goal"_a, "points"_a, "settings"_a, "The potential at points (n, 2).");
}
