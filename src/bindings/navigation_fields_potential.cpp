// The potential of a polygon world, and descents in it.
#include "library/navigation_fields_polygons.hpp"
#include "navigation_fields.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

// k, k_r, rho_0, cone, the longest step, the most evaluations of the potential.
using GainRow = Array<const double, nb::shape<6>>;

// The evidence is what evidence(rest, force, saddles) makes of how it ended.
nb::object route(const RepellingWalls& walls, const PolygonCore& core, nb::handle world, nb::handle planner,
                 nb::handle options, PointRow start, PointRow goal, GainRow settings, nb::handle evidence) {
    const Watch watch;
    DescentFinding made;
    {
        const nb::gil_scoped_release free;
        made = walls.descend(core, point_of(start), point_of(goal), settings.data(), nullptr);
    }
    nb::object route = fields::made_route(world, planner, options, start, goal, made.route, watch.seconds());
    fields::set_evidence(route, evidence(made.rest, made.force, made.saddles));
    return route;
}

nb::object trace(const RepellingWalls& walls, const PolygonCore& core, PointRow start, PointRow goal,
                 GainRow settings) {
    Trace events;
    walls.descend(core, point_of(start), point_of(goal), settings.data(), &events);
    return fields::arrays_of(events);
}

nb::object values(const RepellingWalls& walls, const PolygonCore& core, PointRow goal, Points points,
                  GainRow settings) {
    std::vector<double> found;
    {
        const nb::gil_scoped_release free;
        found = walls.values(core, point_of(goal), points_of(points), settings.data());
    }
    return table(std::move(found));
}

}  // namespace

void bind_navigation_fields_potential(nb::module_& m) {
    nb::class_<RepellingWalls>(m, "NearWalls", "The walls of a PolygonWorld, sorted by where they repel.")
        .def(nb::init<const PolygonCore&, double>(), "core"_a, "reach"_a)
        .def_prop_ro("reach", &RepellingWalls::reach, "How far walls repel [m].")
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
