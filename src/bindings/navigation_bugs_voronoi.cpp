// Voronoi Bug in a polygon world as raw entries.
#include "cspace/navigation/bugs/voronoi_bug.hpp"
#include "navigation_bugs.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

// Options: range, noise (0 for a sensor without), seed.
struct DiagramTracer {
    using Answer = Exploration;
    static constexpr int options = 3;
    double range;
    Noise noise;

    bool read(PyObject* const* args) {
        range = PyFloat_AsDouble(args[0]);
        noise = {PyFloat_AsDouble(args[1]), PyLong_AsUnsignedLongLong(args[2])};
        return !PyErr_Occurred();
    }

    Exploration answer(PolygonCore& core, Point start, Point goal) const {
        if (!core.sensed) core.sensed = std::make_unique<Surroundings>(core.world.walls);
        const nanobind::gil_scoped_release free;
        Exploration trip = noise.deviation > 0 ? voronoi_bug(*core.felt, start, goal, range, noise)
                                               : voronoi_bug(*core.felt, *core.sensed, start, goal, range);
        // Else it went through a gap as narrow as a rounding.
        if (trip.route.status == Status::found && !can_walk(*core.felt, trip.route.path))
            trip.route.status = Status::undetermined;
        return trip;
    }

    static Trace trace(const Exploration& trip, Point) {
        Trace events;
        const std::vector<Point>& path = trip.route.path;
        for (const Leg& leg : trip.legs)
            for (std::size_t i = leg.first; i < leg.last; ++i)
                events.push_back({std::int8_t(leg.move), path[i], path[i + 1], leg.clearance});
        return events;
    }

    // meets, branches, dead_ends, clearance, scans, shut
    static PyObject* evidence(const Exploration& trip, const Walls& walls) {
        std::vector<double> meets;
        for (const Point p : trip.meets) meets.insert(meets.end(), {p.x, p.y});
        return Py_BuildValue("(NLLdLN)", rows(meets, 2, NPY_DOUBLE), static_cast<long long>(trip.branches),
                             static_cast<long long>(trip.dead_ends), trip.clearance,
                             static_cast<long long>(trip.scans), shut_of(trip, walls));
    }
};

// _voronoi_bug(world, planner, options, evidence, core, range, noise, seed, start, goal)
PyMethodDef methods[] = {{"_voronoi_bug", fast(Walk<DiagramTracer>::route), METH_FASTCALL, nullptr},
                         {"_voronoi_bug_trace", fast(Walk<DiagramTracer>::trace), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_bugs_voronoi(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
