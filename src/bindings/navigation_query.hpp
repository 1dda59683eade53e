// The entry of a planner, called from Python as (traced, world, core, planner, start, goal, settings…) → the
// Route, or of a traced search the arrays of its trace. A question may be worth a microsecond, so these are
// raw entries.
#pragma once

#include <nanobind/nanobind.h>

#include <array>
#include <optional>

#include "library/maps_grid.hpp"
#include "library/maps_polygon_world.hpp"
#include "navigation_route.hpp"

using cspace::maps::GridWorld;
using cspace::maps::PolygonCore;

// The object of the core behind a Python object; null, with an error set, for other objects.
template <class T>
T* core_of(PyObject* value) {
    if (nanobind::isinstance<T>(value) && nanobind::inst_ready(value)) return nanobind::inst_ptr<T>(value);
    PyErr_Format(PyExc_TypeError, "expected the core of a world or a field, got an object of type %s",
                 Py_TYPE(value)->tp_name);
    return nullptr;
}

// Settings as numbers; false with an error set for others.
template <std::size_t count>
bool read_settings(PyObject* const* args, std::array<double, count>& numbers) {
    for (double& number : numbers) number = PyFloat_AsDouble(*args++);
    return !PyErr_Occurred();
}
template <std::size_t count>
bool read_settings(PyObject* const* args, std::array<std::int64_t, count>& numbers) {
    for (std::int64_t& number : numbers) number = PyLong_AsLongLong(*args++);
    return !PyErr_Occurred();
}

// Start and goal. Objects other than a plain point go to world.check_free, which converts them or raises.
bool read_ends(PyObject* world, PyObject* const* given, cspace::Point (&ends)[2]);
// Null, with the error of world.check_free for the end that is not free.
PyObject* refuse_ends(PyObject* world, const cspace::Point (&ends)[2]);
// In a handler: null, with the error of Python for what was thrown.
PyObject* translate_exception(PyObject* world);

// What most searches of a core C have in common: each replaces what differs, and has
//   bool find(const C&, start, goal, Trace*)  false where an end is not free; the trace may be null
template <class C, class Found = cspace::navigation::Route>
struct SearchOf {
    using Core = C;
    using Point = cspace::Point;
    using Trace = cspace::navigation::Trace;
    static constexpr int settings = 0;  // how many there are
    Found found;
    double spent = 0;  // [s] by Python for this search

    bool read(const C&, PyObject* const*) { return true; }  // false with an error set
    bool is_concurrent(const C&) const { return true; }     // whether the interpreter is free meanwhile
    PyObject* evidence() const { return nullptr; }          // what backs the verdict; null for nothing
    const cspace::navigation::Route& route() const {
        if constexpr (requires { found.route; })
            return found.route;
        else
            return found;
    }
};

template <class Search>
PyObject* ask(PyObject*, PyObject* const* args, Py_ssize_t count) try {
    constexpr int ends_at = 4, settings_at = 6;
    if (count != settings_at + Search::settings)
        return PyErr_Format(PyExc_TypeError, "expected %d arguments", settings_at + Search::settings);
    const bool is_traced = args[0] == Py_True;
    PyObject* world = args[1];
    auto* core = core_of<typename Search::Core>(args[2]);
    Search search;
    cspace::Point ends[2];
    if (!core || !search.read(*core, args + settings_at) || !read_ends(world, args + ends_at, ends))
        return nullptr;
    cspace::navigation::Trace trace;
    const Watch watch;
    std::optional<nanobind::gil_scoped_release> released;
    if (search.is_concurrent(*core)) released.emplace();
    const bool is_free = search.find(*core, ends[0], ends[1], is_traced ? &trace : nullptr);
    released.reset();
    if (!is_free) return refuse_ends(world, ends);
    if (is_traced) return trace_arrays(trace);
    const double seconds = watch.seconds() + search.spent;
    return make_route(world, args[3], ends[0], ends[1], search.route(), seconds, search.evidence());
} catch (...) {
    return translate_exception(args[1]);
}
