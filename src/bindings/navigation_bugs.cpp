// Robots without a map in a polygon world. Settings end with what the evidence is made with.
#include "library/navigation_bugs.hpp"

#include "maps_points.hpp"
#include "navigation_query.hpp"

namespace nb = nanobind;
using namespace cspace;
using namespace cspace::navigation;

namespace {

// (ring, (x, y)) of where the line to the goal enters the walls that shut it off; None where none do.
nb::object describe_shut(const Walk& walk) {
    if (walk.shut_ring < 0) return nb::none();
    return nb::make_tuple(walk.shut_ring, nb::make_tuple(walk.shut_at.x, walk.shut_at.y));
}

// kind, hand (0 left, 1 right, 2 either), range
struct WallSearch : SearchOf<PolygonCore, WallWalk> {
    static constexpr int settings = 4;
    WallFollower robot;
    PyObject* describe;

    bool read(const Core&, PyObject* const* args) {
        robot = {PyLong_AsLong(args[0]), PyLong_AsLong(args[1]), PyFloat_AsDouble(args[2])};
        describe = args[3];
        return !PyErr_Occurred();
    }
    bool find(const Core& core, Point start, Point goal, Trace* trace) {
        return follow_walls(core, robot, start, goal, found, trace);
    }
    // hits, leaves, walked, rings, shut
    PyObject* evidence() const {
        return nb::handle(describe)(point_table(found.hits), point_table(found.leaves),
                                    table(std::vector(found.walked)), table(std::vector(found.rings)),
                                    describe_shut(found))
            .release()
            .ptr();
    }
};

// range, noise (0 for a sensor without), seed
struct DiagramBugSearch : SearchOf<PolygonCore, DiagramWalk> {
    static constexpr int settings = 4;
    DiagramTracer robot;
    PyObject* describe;

    bool read(const Core&, PyObject* const* args) {
        robot = {PyFloat_AsDouble(args[0]), PyFloat_AsDouble(args[1]), PyLong_AsUnsignedLongLong(args[2])};
        describe = args[3];
        return !PyErr_Occurred();
    }
    bool find(const Core& core, Point start, Point goal, Trace* trace) {
        return trace_diagram(core, robot, start, goal, found, trace);
    }
    // meets, branches, dead_ends, clearance, scans, shut
    PyObject* evidence() const {
        return nb::handle(describe)(point_table(found.meets), found.branches, found.dead_ends,
                                    found.clearance, found.scans, describe_shut(found))
            .release()
            .ptr();
    }
};

PyMethodDef methods[] = {{"_bug", fast(ask<WallSearch>), METH_FASTCALL, nullptr},
                         {"_voronoi_bug", fast(ask<DiagramBugSearch>), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_bugs(nb::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
}
