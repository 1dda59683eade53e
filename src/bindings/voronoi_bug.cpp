// Voronoi Bug in a polygon world as raw entries.
#include "cspace/navigation/bugs/voronoi_bug.hpp"

#include <chrono>
#include <optional>

#include "cspace/navigation/bugs/contact_robot.hpp"
#include "polygon_world.hpp"
#include "route.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

struct Question {
    PolygonCore* core;
    double range;
    Point start, goal;
};

// Nothing where an end does not lie in free space.
std::optional<Exploration> ask(const Question& q) {
    const Settled from = q.core->world.settle(q.start, q.core->tolerance);
    const Settled to = q.core->world.settle(q.goal, q.core->tolerance);
    if (!from.is_free() || !to.is_free()) return {};
    if (!q.core->felt) q.core->felt = std::make_unique<Walls>(q.core->world.walls);
    if (!q.core->sensed) q.core->sensed = std::make_unique<Surroundings>(q.core->world.walls);
    const nanobind::gil_scoped_release free;
    Exploration trip = voronoi_bug(*q.core->felt, *q.core->sensed, from.at, to.at, q.range);
    trip.route.path.front() = q.start;
    if (trip.route.status != Status::found) return trip;
    trip.route.path.back() = q.goal;
    // Else it went through a gap as narrow as a rounding.
    if (!can_walk(*q.core->felt, trip.route.path)) trip.route.status = Status::undetermined;
    return trip;
}

Trace trace_of(const Exploration& trip) {
    Trace events;
    const std::vector<Point>& path = trip.route.path;
    for (const Leg& leg : trip.legs)
        for (std::size_t i = leg.first; i < leg.last; ++i)
            events.push_back({std::int8_t(leg.move), path[i], path[i + 1], leg.clearance});
    return events;
}

// made(meets, branches, dead_ends, clearance, shut)
PyObject* evidence_of(const Exploration& trip, const Walls& walls, PyObject* made) {
    npy_intp shape[2] = {npy_intp(trip.meets.size()), 2};
    PyObject* meets = PyArray_SimpleNew(2, shape, NPY_DOUBLE);
    if (!meets) return nullptr;
    auto* out = static_cast<double*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(meets)));
    for (const Point p : trip.meets) {
        *out++ = p.x;
        *out++ = p.y;
    }
    const Touch& at = trip.witness;
    PyObject* shut = trip.route.status == Status::unreachable
                         ? Py_BuildValue("(i(dd))", walls.ring(at.in.name), at.at.x, at.at.y)
                         : Py_NewRef(Py_None);
    PyObject* parts = Py_BuildValue("(NLLdN)", meets, static_cast<long long>(trip.branches),
                                    static_cast<long long>(trip.dead_ends), trip.clearance, shut);
    PyObject* evidence = parts ? PyObject_CallObject(made, parts) : nullptr;
    Py_XDECREF(parts);
    return evidence;
}

// (core, range, start, goal); false with an error set, or with start and goal that need a closer look.
bool read_question(PyObject* const* args, Question& q) {
    q.core = polygon_core_of(args[0]);
    q.range = PyFloat_AsDouble(args[1]);
    if (PyErr_Occurred()) return false;
    if (!q.core) return PyErr_SetString(PyExc_TypeError, "the core of a PolygonWorld"), false;
    double ends[4];
    if (!read_point(args[2], ends) || !read_point(args[3], ends + 2)) return false;
    q.start = {ends[0], ends[1]};
    q.goal = {ends[2], ends[3]};
    return true;
}

// _voronoi_bug(world, planner, options, evidence, core, range, start, goal) → route, or None where an end
// needs a closer look. evidence: what evidence is made with.
PyObject* voronoi_bug_route(PyObject*, PyObject* const* args, Py_ssize_t count) {
    if (count != 8) return PyErr_SetString(PyExc_TypeError, "_voronoi_bug takes eight arguments"), nullptr;
    Question q;
    if (!read_question(args + 4, q)) {
        if (PyErr_Occurred()) return nullptr;
        Py_RETURN_NONE;
    }
    const auto begin = std::chrono::steady_clock::now();
    const std::optional<Exploration> trip = ask(q);
    if (!trip) Py_RETURN_NONE;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double ends[] = {q.start.x, q.start.y, q.goal.x, q.goal.y};
    PyObject* made = make_route(args[0], args[1], args[2], ends, ends + 2, trip->route, seconds);
    if (!made) return nullptr;
    reinterpret_cast<RouteObject*>(made)->evidence = evidence_of(*trip, *q.core->felt, args[3]);
    if (!reinterpret_cast<RouteObject*>(made)->evidence) Py_CLEAR(made);
    return made;
}

// _voronoi_bug_trace(core, range, start, goal) → the arrays of its trace
PyObject* voronoi_bug_trace(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Question q;
    std::optional<Exploration> trip;
    if (count == 4 && read_question(args, q)) trip = ask(q);
    if (!trip && !PyErr_Occurred())
        PyErr_SetString(PyExc_TypeError, "_voronoi_bug_trace takes what _voronoi_bug answered");
    return trip ? trace_arrays(trace_of(*trip)) : nullptr;
}

PyCFunction fast(PyObject* (*function)(PyObject*, PyObject* const*, Py_ssize_t)) {
    return reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(function));
}
PyMethodDef methods[] = {{"_voronoi_bug", fast(voronoi_bug_route), METH_FASTCALL, nullptr},
                         {"_voronoi_bug_trace", fast(voronoi_bug_trace), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_voronoi_bug(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
