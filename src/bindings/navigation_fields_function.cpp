// Navigation functions of star and sphere worlds, and descents in them.
#include "library/navigation_fields_polygons.hpp"
#include "navigation_fields.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

using Discs = Array<const double, nb::shape<-1, 3>>;
using Function = StarFunction;

// What stands in the way of a star world around a point: (kind, x, y), kind 1 for a ring that is no star and
// 2 for one that touches another; None for nothing.
nb::object fault_of(const PolygonCore& core, PointRow goal) {
    const StarFault fault = find_star_fault(core, point_of(goal));
    if (fault.kind == 0) return nb::none();
    return nb::make_tuple(fault.kind, fault.where.x, fault.where.y);
}
Function* of_polygons(const PolygonCore& core, PointRow goal, double kappa, std::int64_t squares,
                      std::int64_t steps) {
    const nb::gil_scoped_release free;
    return new Function(core, point_of(goal), kappa, squares, steps);
}
// The first disc is the room.
Function* of_discs(Discs discs, PointRow goal, double kappa, std::int64_t squares, std::int64_t steps) {
    const nb::gil_scoped_release free;
    return new Function({reinterpret_cast<const Function::Disc*>(discs.data()), discs.shape(0)},
                        point_of(goal), kappa, squares, steps);
}

nb::object log_odds(const Function& function, const PolygonCore* core, Points points) {
    std::vector<double> found;
    {
        const nb::gil_scoped_release free;
        found = function.log_odds(core, points_of(points));
    }
    return table(std::move(found));
}
nb::object phi(const Function& function, Row logs) {
    std::vector<double> found(logs.data(), logs.data() + logs.shape(0));
    for (double& v : found) v = function.phi(v);
    return table(std::move(found));
}

// seconds: what making the function took.
nb::object route(const Function& function, const PolygonCore& core, nb::handle world, nb::handle planner,
                 nb::handle options, PointRow start, PointRow goal, double seconds, nb::handle evidence) {
    const Watch watch;
    Route found;
    std::int64_t saddles;
    {
        const nb::gil_scoped_release free;
        found = function.find_route(core, point_of(start), point_of(goal), saddles);
    }
    nb::object made =
        fields::made_route(world, planner, options, start, goal, found, watch.seconds() + seconds);
    fields::set_evidence(made, evidence(saddles));
    return made;
}
nb::object trace(const Function& function, const PolygonCore& core, PointRow start) {
    Trace events;
    function.trace_descent(core, point_of(start), events);
    return fields::arrays_of(events);
}
nb::object path(const Function& function, PointRow start) {
    std::vector<Point> found;
    {
        const nb::gil_scoped_release free;
        found = function.find_path(point_of(start));
    }
    return found.empty() ? nb::none() : point_table(found);
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
        .def_prop_ro("obstacles", &Function::obstacles, "How many.")
        .def(
            "saddles", [](const Function& function) { return point_table(function.saddles()); },
            nb::sig("def saddles(self) -> NDArray[numpy.float64]"), "Where they are (k, 2).")
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
