// The answer of a planner as a raw Python type: cspace.navigation.Route is its subclass.
#pragma once

#include "cspace/navigation/route.hpp"
#include "numpy_api.hpp"

// Followed in memory by count points.
struct RouteObject {
    PyObject_VAR_HEAD PyObject* world;
    PyObject* planner;   // its name
    PyObject* options;   // the options it was called with, a dict; or null
    PyObject* evidence;  // what backs the verdict beyond the numbers here; or null
    double start[2], goal[2];
    double length, seconds;
    cspace::navigation::Stats stats;
    int count;
    cspace::navigation::Status status;
    double path[1];
};

// A route whose path, length, price and seconds are still to be written; null with an error set. `options`
// may be null.
RouteObject* new_route(PyObject* world, PyObject* planner, PyObject* options, const double* start,
                       const double* goal, cspace::navigation::Status status, int count);

// A whole route from what a planner returned.
PyObject* make_route(PyObject* world, PyObject* planner, PyObject* options, const double* start,
                     const double* goal, const cspace::navigation::Route& route, double seconds);

// Two numbers read from a tuple, a list or an array of two finite numbers; false (without error) for others,
// which the caller hands to the checks in Python.
bool read_point(PyObject* value, double* point);

// The arrays of a Trace: kinds (k,), from (k, 2), to (k, 2), values (k,).
PyObject* trace_arrays(const cspace::navigation::Trace& trace);
