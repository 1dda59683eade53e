// The answer of a planner as a raw Python type: cspace.navigation.Route is its subclass.
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

#include "cspace/navigation/route.hpp"
#include "numpy_api.hpp"

// Followed in memory by the points of the path.
struct RouteObject {
    PyObject_VAR_HEAD PyObject* world;
    PyObject* planner;   // its name
    PyObject* options;   // the options it was called with, a dict; or null
    PyObject* evidence;  // what backs the verdict beyond the numbers here; or null
    cspace::Point start, goal;
    double length, seconds;
    cspace::navigation::Stats stats;
    int count;
    cspace::navigation::Status status;
    cspace::Point path[1];
};

// A route whose path, length, stats and seconds are still to be written; null with an error set. `options`
// may be null or None.
RouteObject* new_route(PyObject* world, PyObject* planner, PyObject* options, cspace::Point start,
                       cspace::Point goal, cspace::navigation::Status status, int count);

// A whole route from what a planner returned.
PyObject* make_route(PyObject* world, PyObject* planner, PyObject* options, cspace::Point start,
                     cspace::Point goal, const cspace::navigation::Route& route, double seconds);

// The route with its evidence, both taken over; null with an error set if either is null.
PyObject* add_evidence(PyObject* route, PyObject* evidence);

// Two numbers read from a tuple, a list or an array of two finite numbers; false (without error) for others,
// which the caller hands to the checks in Python.
bool read_point(PyObject* value, cspace::Point& point);

// The arrays of a Trace: kinds (k,), from (k, 2), to (k, 2), values (k,).
PyObject* trace_arrays(const cspace::navigation::Trace& trace);

// An array (k, width), or (k,) for a width of one; and (k, 2 · each) of so many points a row.
template <class T>
PyObject* rows_of(const std::vector<T>& values, int width, int type) {
    npy_intp shape[2] = {npy_intp(values.size()) / width, width};
    PyObject* array = PyArray_SimpleNew(width == 1 ? 1 : 2, shape, type);
    if (array)
        std::copy(values.begin(), values.end(),
                  static_cast<T*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array))));
    return array;
}
PyObject* rows_of(const std::vector<cspace::Point>& points, int each = 1);

// The time since it was made.
class Watch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    }

  private:
    std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

// A raw entry for a table of methods.
inline PyCFunction fast(PyObject* (*function)(PyObject*, PyObject* const*, Py_ssize_t)) {
    return reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(function));
}
