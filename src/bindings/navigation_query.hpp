// The entry of a planner, called from Python as (traced, world, core, planner, start, goal, settings…,
// describe) → the Route, or of a traced query the arrays of its trace. `describe`, for queries with evidence,
// makes what the route keeps of it. A query may be worth a microsecond, so these are raw entries.
#pragma once

#include <array>

#include "library/navigation_query.hpp"
#include "maps_points.hpp"
#include "navigation_route.hpp"

// The object of the core behind a Python object; null, with an error set, for other objects.
template <class T>
T* core_of(PyObject* value) {
    if (nanobind::isinstance<T>(value) && nanobind::inst_ready(value)) return nanobind::inst_ptr<T>(value);
    PyErr_Format(PyExc_TypeError, "expected the core of a world or a field, got an object of type %s",
                 Py_TYPE(value)->tp_name);
    return nullptr;
}

// A setting from the next arguments; false with an error set for others. It may hold a reference to them.
template <class T>
    requires std::is_arithmetic_v<T>
bool read_setting(PyObject* const*& args, T& number) {
    PyObject* given = *args++;
    if constexpr (std::is_same_v<T, bool>)
        return number = given == Py_True, true;
    else if constexpr (std::is_floating_point_v<T>)
        number = PyFloat_AsDouble(given);
    else
        number = std::is_signed_v<T> ? T(PyLong_AsLongLong(given)) : T(PyLong_AsUnsignedLongLong(given));
    return number != T(-1) || !PyErr_Occurred();
}
template <class T, std::size_t n>
bool read_setting(PyObject* const*& args, std::array<T, n>& numbers) {
    for (T& number : numbers)
        if (!read_setting(args, number)) return false;
    return true;
}
// A contiguous array of numbers, or None.
inline bool read_setting(PyObject* const*& args, std::span<const double>& numbers) {
    ConstDoubles array;
    PyObject* given = *args++;
    if (given != Py_None && !array.read(given))
        return PyErr_SetString(PyExc_TypeError, "costs must be a contiguous float64 array"), false;
    numbers = {array.data, std::size_t(array.size)};
    return true;
}
template <class T>
bool read_setting(PyObject* const*& args, const T*& core) {
    return (core = core_of<T>(*args++));
}

template <class T>
inline constexpr int arguments_for = 1;
template <class T, std::size_t n>
inline constexpr int arguments_for<std::array<T, n>> = int(n);

// Settings from as many arguments.
template <class... T>
bool read_settings(PyObject* const* args, Py_ssize_t count, std::tuple<T...>& settings) {
    if (count != (arguments_for<T> + ... + 0))
        return PyErr_SetString(PyExc_TypeError, "the number of arguments does not fit the planner"), false;
    return std::apply([&args](T&... each) { return (read_setting(args, each) && ...); }, settings);
}

// Start and goal. Objects other than a plain point go to world.check_free, which converts them or raises.
bool read_ends(PyObject* world, PyObject* const* given, cspace::Point (&ends)[2]);
// Null, with the error of world.check_free for the end that is not free.
PyObject* refuse_ends(PyObject* world, const cspace::Point (&ends)[2]);
// In a handler: null, with the error of Python for what was thrown.
PyObject* translate_exception(PyObject* world);

// is_concurrent(core): whether others may ask the world meanwhile; null: always.
template <class World, class Found, class... Settings>
PyObject* ask_planner(bool (*plan)(const cspace::navigation::Query<World>&, Found&, Settings...),
                      bool (*is_concurrent)(const std::type_identity_t<World>&), PyObject* const* args,
                      Py_ssize_t count) {
    constexpr int ends_at = 4, settings_at = 6;
    constexpr bool has_evidence = requires(Found& found) { found.evidence; };
    if (count < settings_at + has_evidence)
        return PyErr_Format(PyExc_TypeError, "expected %d arguments or more", settings_at + has_evidence);
    const bool is_traced = args[0] == Py_True;
    PyObject* world = args[1];
    const auto* core = core_of<World>(args[2]);
    std::tuple<std::remove_cvref_t<Settings>...> settings;
    cspace::Point ends[2];
    if (!core || !read_settings(args + settings_at, count - settings_at - has_evidence, settings) ||
        !read_ends(world, args + ends_at, ends))
        return nullptr;
    Found found;
    cspace::navigation::Trace trace;
    const cspace::navigation::Query<World> query{*core, ends[0], ends[1], is_traced ? &trace : nullptr};
    const Watch watch;
    std::optional<nanobind::gil_scoped_release> released;
    if (!is_concurrent || is_concurrent(*core)) released.emplace();
    const bool is_free = std::apply([&](auto&... each) { return plan(query, found, each...); }, settings);
    released.reset();
    if (!is_free) return refuse_ends(world, ends);
    if (is_traced) return trace_arrays(trace);
    double seconds = watch.seconds();
    nanobind::object evidence;
    if constexpr (has_evidence) {
        seconds += found.spent;
        const nanobind::handle describe = args[count - 1];
        const auto tell = [&](auto&... part) { return describe(nanobind::cast(std::move(part))...); };
        if (found.evidence) evidence = std::apply(tell, *found.evidence);
    }
    return make_route(world, args[3], ends[0], ends[1], route_of(found), seconds, evidence.release().ptr());
}

template <auto plan, auto is_concurrent = nullptr>
PyObject* ask(PyObject*, PyObject* const* args, Py_ssize_t count) try {
    return ask_planner(plan, is_concurrent, args, count);
} catch (...) {
    return translate_exception(args[1]);
}
