// Descents in the potentials of polygon worlds, and the potentials.
#include "library/navigation_fields_polygons.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include "maps_points.hpp"
#include "navigation_query.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

// k, k_r, rho_0, cone, the longest step, the most evaluations of the potential.
using Gains = Array<const double, nb::shape<6>>;
using Discs = Array<const double, nb::shape<-1, 3>>;

// The walls, the gains; the evidence is made with the last, called with rest, force and saddles.
struct DescentSearch : SearchOf<PolygonCore, DescentRoute> {
    static constexpr int settings = 8;
    RepellingWalls* walls;
    std::array<double, 6> gains;
    PyObject* describe;

    bool read(const Core&, PyObject* const* args) {
        describe = args[7];
        return (walls = core_of<RepellingWalls>(args[0])) && read_settings(args + 1, gains);
    }
    bool find(const Core& core, Point start, Point goal, Trace* trace) {
        return walls->descend(core, start, goal, gains.data(), found, trace);
    }
    PyObject* evidence() const {
        return PyObject_CallFunction(describe, "idi", int(found.rest), found.force, found.saddles);
    }
};

// The function, and the seconds that making it took; the evidence is made with the last, called with the
// saddles.
struct FunctionSearch : SearchOf<PolygonCore, DescentRoute> {
    static constexpr int settings = 3;
    StarFunction* function;
    PyObject* describe;

    bool read(const Core&, PyObject* const* args) {
        spent = PyFloat_AsDouble(args[1]), describe = args[2];
        return (function = core_of<StarFunction>(args[0])) && !PyErr_Occurred();
    }
    bool find(const Core& core, Point start, Point goal, Trace* trace) {
        return function->find_route(core, start, goal, found, trace);
    }
    PyObject* evidence() const { return PyObject_CallFunction(describe, "i", found.saddles); }
};

PyMethodDef methods[] = {{"_potential_field", fast(ask<DescentSearch>), METH_FASTCALL, nullptr},
                         {"_navigation_function", fast(ask<FunctionSearch>), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

Numbers<double> potential_values(const RepellingWalls& walls, const PolygonCore& core, PointRow goal,
                                 Points points, Gains gains) {
    std::vector<double> found;
    {
        const nb::gil_scoped_release free;
        found = walls.values(core, point_of(goal), points_of(points), gains.data());
    }
    return table(std::move(found));
}

std::optional<std::tuple<int, double, double>> fault_of(const PolygonCore& core, PointRow goal) {
    const StarFault fault = find_star_fault(core, point_of(goal));
    if (fault.kind == 0) return std::nullopt;
    return std::tuple(fault.kind, fault.where.x, fault.where.y);
}
StarFunction* of_polygons(const PolygonCore& core, PointRow goal, double kappa, std::int64_t squares,
                          std::int64_t steps) {
    const nb::gil_scoped_release free;
    return new StarFunction(core, point_of(goal), kappa, squares, steps);
}
StarFunction* of_discs(Discs discs, PointRow goal, double kappa, std::int64_t squares, std::int64_t steps) {
    const nb::gil_scoped_release free;
    return new StarFunction({reinterpret_cast<const StarFunction::Disc*>(discs.data()), discs.shape(0)},
                            point_of(goal), kappa, squares, steps);
}
Numbers<double> log_odds(const StarFunction& function, const PolygonCore* core, Points points) {
    std::vector<double> found;
    {
        const nb::gil_scoped_release free;
        found = function.log_odds(core, points_of(points));
    }
    return table(std::move(found));
}
Numbers<double> phi(const StarFunction& function, Row logs) {
    std::vector<double> found(logs.data(), logs.data() + logs.shape(0));
    for (double& v : found) v = function.phi(v);
    return table(std::move(found));
}
std::optional<Numbers<double>> path(const StarFunction& function, PointRow start) {
    std::vector<Point> found;
    {
        const nb::gil_scoped_release free;
        found = function.find_path(point_of(start));
    }
    if (found.empty()) return std::nullopt;
    return point_table(std::move(found));
}

}  // namespace

void bind_navigation_fields_polygons(nb::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
    nb::class_<RepellingWalls>(m, "NearWalls", "The walls of a PolygonWorld, sorted by where they repel.")
        .def(nb::init<const PolygonCore&, double>(), "core"_a, "reach"_a)
        .def_prop_ro("reach", &RepellingWalls::reach, "How far walls repel [m].")
        .def("values", potential_values, "core"_a, "goal"_a, "points"_a, "settings"_a,
             "The potential at points (n, 2).");
    nb::class_<StarFunction>(m, "NavigationCore", "A navigation function of a star or sphere world.")
        .def_static(
            "fault", fault_of, "core"_a, "goal"_a,
            "An obstacle that is not star-shaped (1) or touches another (2): (1 or 2, x, y), a corner of it.")
        .def_static("of_polygons", of_polygons, nb::rv_policy::take_ownership, "core"_a, "goal"_a, "kappa"_a,
                    "squares"_a, "steps"_a, "Of a world without fault.")
        .def_static("of_discs", of_discs, nb::rv_policy::take_ownership, "discs"_a, "goal"_a, "kappa"_a,
                    "squares"_a, "steps"_a, "Of discs (n, 3): x, y, radius; the first is the room.")
        .def_prop_ro("kappa", &StarFunction::kappa, "The power; zero where none was proven.")
        .def_prop_ro("is_proven", &StarFunction::is_proven,
                     "Whether the goal is proven to be the only minimum.")
        .def_prop_ro("obstacles", &StarFunction::obstacles, "How many.")
        .def(
            "saddles", [](const StarFunction& function) { return point_table(function.saddles()); },
            "Where they are (k, 2).")
        .def("log_odds", log_odds, "core"_a.none(), "points"_a, "V at points (n, 2).")
        .def("phi", phi, "logs"_a, "φ of V (n,).")
        .def("path", path, "start"_a, "The way down from a free point.");
}
