// How planners' raw entries reach the compiled half of a PolygonWorld.
#pragma once

#include "bindings.hpp"
#include "library/maps_polygon_world.hpp"
#include "navigation_route.hpp"

// The core behind a Python object; null, with an error set, for other objects.
inline const cspace::maps::PolygonCore* polygon_core_of(PyObject* value) {
    using cspace::maps::PolygonCore;
    if (nanobind::isinstance<PolygonCore>(value)) return nanobind::inst_ptr<PolygonCore>(value);
    PyErr_SetString(PyExc_TypeError, "expected the core of a PolygonWorld");
    return nullptr;
}

// What a raw entry of a planner is asked: a way between two points of a world.
struct PolygonQuestion {
    const cspace::maps::PolygonCore* core = nullptr;
    cspace::Point start, goal;

    // False with an error set, or with ends that need a closer look.
    bool read(PyObject* owner, PyObject* start_given, PyObject* goal_given) {
        core = polygon_core_of(owner);
        return core && read_point(start_given, start) && read_point(goal_given, goal);
    }
};

// What a raw entry returns where it has no answer: null if an error is set, else None.
inline PyObject* no_answer() { return PyErr_Occurred() ? nullptr : Py_NewRef(Py_None); }
// The same for the trace of a question that has no answer.
inline PyObject* no_trace() {
    if (!PyErr_Occurred()) PyErr_SetString(PyExc_TypeError, "a trace needs a query with a result");
    return nullptr;
}
