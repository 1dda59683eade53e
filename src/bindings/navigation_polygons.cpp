// Planners in polygon worlds, robots without a map among them, and what they make of the worlds.
#include "library/navigation_polygons.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "library/navigation_bugs.hpp"
#include "library/navigation_fields_polygons.hpp"
#include "navigation_query.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

bool never(const PolygonCore&) { return false; }

PyMethodDef methods[] = {{"_polygon_route", as_method(ask<plan_in_polygons, never>), METH_FASTCALL, nullptr},
                         {"_approximate_cells", as_method(ask<plan_quadtree>), METH_FASTCALL, nullptr},
                         {"_sampling", as_method(ask<plan_samples>), METH_FASTCALL, nullptr},
                         {"_voronoi", as_method(ask<plan_voronoi>), METH_FASTCALL, nullptr},
                         {"_bug", as_method(ask<plan_bug>), METH_FASTCALL, nullptr},
                         {"_voronoi_bug", as_method(ask<plan_voronoi_bug>), METH_FASTCALL, nullptr},
                         {"_potential_field", as_method(ask<plan_descent>), METH_FASTCALL, nullptr},
                         {"_navigation_function", as_method(ask<plan_star>), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_polygons(nb::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
    m.def("_visibility_graph", list_visibility_graph, "core"_a, "Nodes (n, 2) and edges (k, 2), each once.");
    m.def("_exact_cells_all", list_exact_cells, "core"_a,
          "The corners of each cell (k, 8), and the doors as pairs of cells (d, 2).");
    m.def("_approximate_cells_all", list_cell_leaves, "core"_a, "settings"_a, WithoutLock(),
          "Squares (k, 4) and kinds (k,) of the leaves.");
    m.def("_voronoi_diagram", list_voronoi_arcs, "core"_a, "tolerance"_a,
          "Vertices, their clearance, ends of arcs, (polyline, clearance) of each, whether all are there.");
    nb::class_<RepellingWalls>(m, "NearWalls", "The walls of a PolygonWorld, sorted by where they repel.")
        .def(nb::init<const PolygonCore&, double>(), "core"_a, "reach"_a)
        .def_ro("reach", &RepellingWalls::reach, "How far walls repel [m].")
        .def("values", &RepellingWalls::values, "core"_a, "goal"_a, "points"_a, "settings"_a, WithoutLock(),
             "The potential at points (n, 2).");
    using Discs = std::span<const StarFunction::Disc>;
    nb::class_<StarFunction>(m, "NavigationCore", "A navigation function of a star or sphere world.")
        .def_static(
            "fault", find_star_fault, "core"_a, "goal"_a,
            "An obstacle that is not star-shaped (1) or touches another (2): (1 or 2, x, y), a corner of it.")
        .def(nb::init<const PolygonCore&, Point, double, std::int64_t, std::int64_t>(), "core"_a, "goal"_a,
             "kappa"_a, "squares"_a, "steps"_a, WithoutLock(), "Of a world without fault.")
        .def(nb::init<Discs, Point, double, std::int64_t, std::int64_t>(), "discs"_a, "goal"_a, "kappa"_a,
             "squares"_a, "steps"_a, WithoutLock(), "Of discs (n, 3): x, y, radius; the first is the room.")
        .def_ro("kappa", &StarFunction::kappa, "The power; zero where none was proven.")
        .def_ro("is_proven", &StarFunction::is_proven, "Whether the goal is proven to be the only minimum.")
        .def_ro("obstacles", &StarFunction::obstacles, "How many.")
        .def("saddles", &StarFunction::saddles, "Where they are (k, 2).")
        .def("log_odds", &StarFunction::log_odds, "core"_a.none(), "points"_a, WithoutLock(),
             "V at points (n, 2).")
        .def("phi", &StarFunction::phi, "logs"_a, "φ of V (n,).")
        .def("path", &StarFunction::find_path, "start"_a, WithoutLock(), "The way down from a free point.");
}
