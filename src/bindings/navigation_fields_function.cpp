// Navigation functions of star and sphere worlds, and descents in them.
#include <limits>
#include <optional>

#include "cspace/navigation/fields/navigation_function.hpp"
#include "maps_polygon_world.hpp"
#include "navigation_fields.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

using Points = Array<const double, nb::shape<-1, 2>>;
using Discs = Array<const double, nb::shape<-1, 3>>;
using Function = NavigationFunction;

constexpr double infinity = std::numeric_limits<double>::infinity();

Point point_of(const fields::PointRow& row) { return {row.data()[0], row.data()[1]}; }
Function::Limits limits_of(std::int64_t squares, std::int64_t steps) {
    Function::Limits limits;
    limits.squares = squares, limits.steps = steps;
    return limits;
}

// What stands in the way of a star world around a point: (kind, x, y), kind 1 for a ring that is no star and
// 2 for one that touches another; None for nothing.
nb::object fault_of(const PolygonCore& core, fields::PointRow goal) {
    const maps::Settled at = core.world.settle(point_of(goal), core.tolerance);
    const StarWorld stars(core.world.walls, core.world.space.component[std::size_t(at.triangles.at(0))]);
    if (stars.fault == StarWorld::none) return nb::none();
    return nb::make_tuple(int(stars.fault), stars.where.x, stars.where.y);
}
Function* of_polygons(const PolygonCore& core, fields::PointRow goal, double kappa, std::int64_t squares,
                      std::int64_t steps) {
    nb::gil_scoped_release free;
    const maps::Settled at = core.world.settle(point_of(goal), core.tolerance);
    StarWorld stars(core.world.walls, core.world.space.component[std::size_t(at.triangles.at(0))]);
    SphereWorld model = stars.model();
    return new Function(std::move(model), std::move(stars), at.at, kappa, limits_of(squares, steps));
}
// The first disc is the room.
Function* of_discs(Discs discs, fields::PointRow goal, double kappa, std::int64_t squares,
                   std::int64_t steps) {
    const double* d = discs.data();
    SphereWorld world{{{d[0], d[1]}, d[2]}, {}};
    for (std::size_t k = 1; k < discs.shape(0); ++k)
        world.obstacles.push_back({{d[3 * k], d[3 * k + 1]}, d[3 * k + 2]});
    const Point to = point_of(goal);
    nb::gil_scoped_release free;
    return new Function(std::move(world), std::nullopt, to, kappa, limits_of(squares, steps));
}

// V at points of free space; infinite elsewhere.
nb::object log_odds(const Function& function, const PolygonCore* core, Points points) {
    std::vector<double> found;
    {
        nb::gil_scoped_release free;
        const auto* p = reinterpret_cast<const Point*>(points.data());
        for (std::size_t k = 0; k < points.shape(0); ++k) {
            const bool is_free = !core || core->world.settle(p[k], core->tolerance).is_free();
            found.push_back(is_free ? function.log_odds(p[k]) : infinity);
        }
    }
    const std::size_t count = found.size();
    return fields::table(std::move(found), count, 0);
}
nb::object phi(const Function& function, Row logs) {
    std::vector<double> found(logs.data(), logs.data() + logs.shape(0));
    for (double& v : found) v = function.phi(v);
    const std::size_t count = found.size();
    return fields::table(std::move(found), count, 0);
}
nb::object saddles(const Function& function) {
    std::vector<double> found;
    for (const Point p : function.proof().saddles) {
        const Point at = function.from_model(p);
        found.push_back(at.x), found.push_back(at.y);
    }
    const std::size_t count = found.size() / 2;
    return fields::table(std::move(found), count, 2);
}

Function::Descent descend(const Function& function, const PolygonCore& core, Point start) {
    Function::Descent made = function.descend(core.world.settle(start, core.tolerance).at);
    made.route.path.front() = start;
    return made;
}
// seconds: what making the function took.
nb::object route(const Function& function, const PolygonCore& core, nb::handle world, nb::handle planner,
                 nb::handle options, fields::PointRow start, fields::PointRow goal, double seconds,
                 nb::handle evidence) {
    const fields::Watch watch;
    const auto from = core.world.settle(point_of(start), core.tolerance);
    const auto to = core.world.settle(point_of(goal), core.tolerance);
    Function::Descent made;
    if (core.world.shared_component(from, to) == maps::none) {
        made.route.status = Status::unreachable;
    } else if (function.kappa() > 0) {
        nb::gil_scoped_release free;
        made = descend(function, core, point_of(start));
        if (made.route.status == Status::found) made.route.path.back() = point_of(goal);
    }
    made.route.stats.edges += function.proof().squares;
    nb::object route =
        fields::made_route(world, planner, options, start, goal, made.route, watch.seconds() + seconds);
    fields::set_evidence(route, evidence(made.saddles));
    return route;
}
nb::object trace(const Function& function, const PolygonCore& core, fields::PointRow start) {
    const Function::Descent made = descend(function, core, point_of(start));
    Trace events;
    const std::vector<Point>& path = made.route.path;
    for (std::size_t k = 1; k < path.size(); ++k)
        events.push_back({0, path[k - 1], path[k], function.phi(made.values[k])});
    return fields::arrays_of(events);
}
nb::object path(const Function& function, fields::PointRow start) {
    Function::Descent made;
    {
        nb::gil_scoped_release free;
        made = function.descend(point_of(start));
    }
    if (made.route.status != Status::found) return nb::none();
    std::vector<double> found;
    for (const Point p : made.route.path) found.push_back(p.x), found.push_back(p.y);
    const std::size_t count = found.size() / 2;
    return fields::table(std::move(found), count, 2);
}

constexpr const char* trace_type =
    "def trace(self, core: PolygonCore, start: ArrayLike) -> tuple[NDArray[numpy.int8], "
    "NDArray[numpy.float64], "
    "NDArray[numpy.float64], NDArray[numpy.float64]]";

}  // namespace

void bind_navigation_fields_function(nb::module_& m) {
    nb::class_<Function>(m, "NavigationCore", "A navigation function of a star or sphere world.")
        .def_static(
            "fault", fault_of,
            nb::sig("def fault(core: PolygonCore, goal: ArrayLike) -> tuple[int, float, float] | None"),
            "core"_a, "goal"_a, "What is no star, or touches: (1 or 2, x, y) of a corner of it.")
        .def_static(
            "of_polygons", of_polygons, nb::rv_policy::take_ownership,
            nb::sig("def of_polygons(core: PolygonCore, goal: ArrayLike, kappa: float, squares: int, steps: "
                    "int) -> NavigationCore"),
            "core"_a, "goal"_a, "kappa"_a, "squares"_a, "steps"_a, "Of a world without fault.")
        .def_static(
            "of_discs", of_discs, nb::rv_policy::take_ownership,
            nb::sig("def of_discs(discs: ArrayLike, goal: ArrayLike, kappa: float, squares: int, steps: int) "
                    "-> NavigationCore"),
            "discs"_a, "goal"_a, "kappa"_a, "squares"_a, "steps"_a,
            "Of discs (n, 3): x, y, radius; the first is the room.")
        .def_prop_ro("kappa", &Function::kappa, "The power; zero where none was proven.")
        .def_prop_ro("is_proven", &Function::is_proven, "Whether the goal is proven to be the only minimum.")
        .def_prop_ro(
            "obstacles", [](const Function& f) { return f.discs().obstacles.size(); }, "How many.")
        .def("saddles", saddles, nb::sig("def saddles(self) -> NDArray[numpy.float64]"),
             "Where they are (k, 2).")
        .def("log_odds", log_odds,
             nb::sig(
                 "def log_odds(self, core: PolygonCore | None, points: ArrayLike) -> NDArray[numpy.float64]"),
             "core"_a.none(), "points"_a, "V at points (n, 2).")
        .def("phi", phi, nb::sig("def phi(self, logs: ArrayLike) -> NDArray[numpy.float64]"), "logs"_a,
             "φ of V (n,).")
        .def("path", path, nb::sig("def path(self, start: ArrayLike) -> NDArray[numpy.float64] | None"),
             "start"_a, "The way down from a free point.")
        .def("route", route,
             nb::sig("def route(self, core: PolygonCore, world: Any, planner: str, options: dict[str, Any], "
                     "start: "
                     "ArrayLike, goal: ArrayLike, seconds: float, evidence: Any) -> Any"),
             "core"_a, "world"_a, "planner"_a, "options"_a, "start"_a, "goal"_a, "seconds"_a, "evidence"_a,
             "A descent; its evidence is made by evidence(saddles).")
        .def("trace", trace, nb::sig(trace_type), "core"_a, "start"_a, "The steps of a descent.");
}
