// Robots without a map in a polygon world as raw entries: a run is worth a few microseconds.
#include <chrono>
#include <optional>

#include "cspace/navigation/bugs/bug_1.hpp"
#include "cspace/navigation/bugs/bug_2.hpp"
#include "cspace/navigation/bugs/range_robot.hpp"
#include "cspace/navigation/bugs/tangent_bug.hpp"
#include "polygon_world.hpp"
#include "route.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

enum Kind { bug_1_kind, bug_2_kind, tangent_bug_kind };
enum Word : std::int8_t { go_word, hit_word, follow_word, leave_word };

struct Question {
    PolygonCore* core;
    int kind, hand;  // hand: 0 left, 1 right, 2 either
    double range;
    Point start, goal;
};

Trip answer(const Question& q, Point start, Point goal) {
    const nanobind::gil_scoped_release free;
    const Walls& walls = *q.core->felt;
    const Hand hand = q.hand == 0 ? Hand::left : Hand::right;
    if (q.kind == tangent_bug_kind) {
        RangeRobot robot(walls, start, q.range);
        return tangent_bug(robot, goal, q.hand == 2 ? std::optional<Hand>() : hand);
    }
    ContactRobot robot(walls, start);
    return q.kind == bug_1_kind ? bug_1(robot, goal, hand) : bug_2(robot, goal, hand);
}

// Nothing where an end does not lie in free space.
std::optional<Trip> ask(const Question& q) {
    const Settled from = q.core->world.settle(q.start, q.core->tolerance);
    const Settled to = q.core->world.settle(q.goal, q.core->tolerance);
    if (!from.is_free() || !to.is_free()) return {};
    if (!q.core->felt) q.core->felt = std::make_unique<Walls>(q.core->world.walls);
    Trip trip = answer(q, from.at, to.at);
    trip.route.path.front() = q.start;
    if (trip.route.status == Status::found) trip.route.path.back() = q.goal;
    return trip;
}

// What the walk was made of, in its order: straight ways between stretches along walls.
Trace trace_of(const Trip& trip, Point goal) {
    Trace events;
    const std::vector<Point>& path = trip.route.path;
    std::size_t at = 0;
    const auto steps = [&](std::int8_t word, std::size_t end) {
        for (double walked = 0; at < end; ++at) {
            walked += distance(path[at], path[at + 1]);
            events.push_back(
                {word, path[at], path[at + 1], word == follow_word ? walked : distance(path[at + 1], goal)});
        }
    };
    const auto point = [&](std::int8_t word) {
        events.push_back({word, path[at], path[at], distance(path[at], goal)});
    };
    for (const Follow& follow : trip.follows) {
        steps(go_word, follow.first);
        point(hit_word);
        steps(follow_word, follow.last);
        point(leave_word);
    }
    steps(go_word, path.size() - 1);
    return events;
}

template <class T>
PyObject* rows(const std::vector<T>& values, int columns, int type) {
    npy_intp shape[2] = {npy_intp(values.size()) / columns, columns};
    PyObject* array = PyArray_SimpleNew(columns == 1 ? 1 : 2, shape, type);
    if (!array) return nullptr;
    std::copy(values.begin(), values.end(),
              static_cast<T*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array))));
    return array;
}

// made(hits, leaves, walked, rings, shut): the stretches along walls, and where the goal is shut off.
PyObject* evidence_of(const Trip& trip, const Walls& walls, PyObject* made) {
    std::vector<double> hits, leaves, walked;
    std::vector<std::int64_t> rings;
    for (const Follow& f : trip.follows) {
        const Point hit = trip.route.path[f.first], leave = trip.route.path[f.last];
        hits.insert(hits.end(), {hit.x, hit.y});
        leaves.insert(leaves.end(), {leave.x, leave.y});
        walked.push_back(f.walked);
        rings.push_back(walls.ring(f.hit.in.name));
    }
    const Touch& at = trip.witness;
    PyObject* shut = trip.route.status == Status::unreachable
                         ? Py_BuildValue("(i(dd))", walls.ring(at.in.name), at.at.x, at.at.y)
                         : Py_NewRef(Py_None);
    PyObject* parts = Py_BuildValue("(NNNNN)", rows(hits, 2, NPY_DOUBLE), rows(leaves, 2, NPY_DOUBLE),
                                    rows(walked, 1, NPY_DOUBLE), rows(rings, 1, NPY_INT64), shut);
    PyObject* evidence = parts ? PyObject_CallObject(made, parts) : nullptr;
    Py_XDECREF(parts);
    return evidence;
}

// (core, kind, hand, range, start, goal); null with an error set, or with start and goal that need a closer
// look.
bool read_question(PyObject* const* args, Question& q) {
    q.core = polygon_core_of(args[0]);
    q.kind = int(PyLong_AsLong(args[1]));
    q.hand = int(PyLong_AsLong(args[2]));
    q.range = PyFloat_AsDouble(args[3]);
    if (PyErr_Occurred()) return false;
    if (!q.core) return PyErr_SetString(PyExc_TypeError, "the core of a PolygonWorld"), false;
    double ends[4];
    if (!read_point(args[4], ends) || !read_point(args[5], ends + 2)) return false;
    q.start = {ends[0], ends[1]};
    q.goal = {ends[2], ends[3]};
    return true;
}

// _bug(world, planner, options, evidence, core, kind, hand, range, start, goal) → route, or None where an end
// needs a closer look. evidence: what evidence is made with.
PyObject* bug(PyObject*, PyObject* const* args, Py_ssize_t count) {
    if (count != 10) return PyErr_SetString(PyExc_TypeError, "_bug takes ten arguments"), nullptr;
    Question q;
    if (!read_question(args + 4, q)) {
        if (PyErr_Occurred()) return nullptr;
        Py_RETURN_NONE;
    }
    const auto begin = std::chrono::steady_clock::now();
    const std::optional<Trip> trip = ask(q);
    if (!trip) Py_RETURN_NONE;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double ends[] = {q.start.x, q.start.y, q.goal.x, q.goal.y};
    PyObject* made = make_route(args[0], args[1], args[2], ends, ends + 2, trip->route, seconds);
    if (!made) return nullptr;
    reinterpret_cast<RouteObject*>(made)->evidence = evidence_of(*trip, *q.core->felt, args[3]);
    if (!reinterpret_cast<RouteObject*>(made)->evidence) Py_CLEAR(made);
    return made;
}

// _bug_trace(core, kind, hand, range, start, goal) → the arrays of its trace
PyObject* bug_trace(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Question q;
    std::optional<Trip> trip;
    if (count == 6 && read_question(args, q)) trip = ask(q);
    if (!trip && !PyErr_Occurred()) PyErr_SetString(PyExc_TypeError, "_bug_trace takes what _bug answered");
    return trip ? trace_arrays(trace_of(*trip, q.goal)) : nullptr;
}

PyCFunction fast(PyObject* (*function)(PyObject*, PyObject* const*, Py_ssize_t)) {
    return reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(function));
}
PyMethodDef methods[] = {{"_bug", fast(bug), METH_FASTCALL, nullptr},
                         {"_bug_trace", fast(bug_trace), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_bugs(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
