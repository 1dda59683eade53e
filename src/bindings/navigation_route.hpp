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
    PyObject* planner;   // with the options in force
    PyObject* evidence;  // what backs the verdict beyond the numbers here; or null
    cspace::Point start, goal;
    double length, seconds;
    cspace::navigation::Stats stats;
    int count;
    cspace::navigation::Status status;
    cspace::Point path[1];
};

// A whole route from what a planner returned. evidence: taken over, also on failure; null for none.
PyObject* make_route(PyObject* world, PyObject* planner, cspace::Point start, cspace::Point goal,
                     const cspace::navigation::Route& route, double seconds, PyObject* evidence);

// The arrays of a Trace: kinds (k,), from (k, 2), to (k, 2), values (k,).
PyObject* trace_arrays(const cspace::navigation::Trace& trace);

// The time since it was made.
class Watch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    }

  private:
    std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};
