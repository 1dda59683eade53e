// Robots without a map in a polygon world, as raw entries: a run is worth a few microseconds.
#include "library/navigation_bugs.hpp"

#include "maps_polygon_world.hpp"

using namespace cspace;
using namespace cspace::navigation;

namespace {

// (ring, (x, y)) of where the line to the goal enters the walls that shut it off; None where none do.
PyObject* tuple_of(const ShutOff& shut) {
    if (shut.ring < 0) return Py_NewRef(Py_None);
    return Py_BuildValue("(i(dd))", shut.ring, shut.at.x, shut.at.y);
}

// kind, hand (0 left, 1 right, 2 either), range
struct WallBug {
    WallFollower robot{};
    WallWalk walk;

    bool read(PyObject* const* args) {
        robot = {int(PyLong_AsLong(args[0])), int(PyLong_AsLong(args[1])), PyFloat_AsDouble(args[2])};
        return !PyErr_Occurred();
    }
    bool run(const PolygonQuestion& q, Trace* trace) {
        return follow_walls(*q.core, robot, q.start, q.goal, walk, trace);
    }
    // hits, leaves, walked, rings, shut
    PyObject* evidence() const {
        return Py_BuildValue("(NNNNN)", rows_of(walk.hits), rows_of(walk.leaves),
                             rows_of(walk.walked, 1, NPY_DOUBLE), rows_of(walk.rings, 1, NPY_INT64),
                             tuple_of(walk.shut));
    }
};

// range, noise (0 for a sensor without), seed
struct VoronoiBug {
    DiagramTracer robot{};
    DiagramWalk walk;

    bool read(PyObject* const* args) {
        robot = {PyFloat_AsDouble(args[0]), PyFloat_AsDouble(args[1]), PyLong_AsUnsignedLongLong(args[2])};
        return !PyErr_Occurred();
    }
    bool run(const PolygonQuestion& q, Trace* trace) {
        return trace_diagram(*q.core, robot, q.start, q.goal, walk, trace);
    }
    // meets, branches, dead_ends, clearance, scans, shut
    PyObject* evidence() const {
        return Py_BuildValue("(NLLdLN)", rows_of(walk.meets), static_cast<long long>(walk.branches),
                             static_cast<long long>(walk.dead_ends), walk.clearance,
                             static_cast<long long>(walk.scans), tuple_of(walk.shut));
    }
};

// (core, three options, start, goal); false with an error set, or where an end needs a closer look.
template <class Bug>
bool run(Bug& bug, PolygonQuestion& q, PyObject* const* args, Py_ssize_t count, Trace* trace) {
    if (count != 6) return PyErr_SetString(PyExc_TypeError, "wrong number of arguments"), false;
    if (!bug.read(args + 1) || !q.read(args[0], args[4], args[5])) return false;
    const nanobind::gil_scoped_release free;
    return bug.run(q, trace);
}

// (world, planner, options, evidence, core, …, start, goal) → route, or None where an end needs a closer
// look. evidence: what evidence is made with.
template <class Bug>
PyObject* route(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Bug bug;
    PolygonQuestion q;
    const Watch watch;
    if (!run(bug, q, args + 4, count - 4, nullptr)) return no_answer();
    PyObject* made = make_route(args[0], args[1], args[2], q.start, q.goal, bug.walk.route, watch.seconds());
    PyObject* parts = made ? bug.evidence() : nullptr;
    PyObject* evidence = parts ? PyObject_CallObject(args[3], parts) : nullptr;
    Py_XDECREF(parts);
    return add_evidence(made, evidence);
}

// (core, …, start, goal) → the arrays of its trace
template <class Bug>
PyObject* trace(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Bug bug;
    PolygonQuestion q;
    Trace events;
    return run(bug, q, args, count, &events) ? trace_arrays(events) : no_trace();
}

PyMethodDef methods[] = {{"_bug", fast(route<WallBug>), METH_FASTCALL, nullptr},
                         {"_bug_trace", fast(trace<WallBug>), METH_FASTCALL, nullptr},
                         {"_voronoi_bug", fast(route<VoronoiBug>), METH_FASTCALL, nullptr},
                         {"_voronoi_bug_trace", fast(trace<VoronoiBug>), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_bugs(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
