// Planners that draw points from free space: roadmaps and trees.
#include <chrono>

#include "cspace/navigation/sampling/rrt.hpp"
#include "maps_polygon_world.hpp"
#include "navigation_route.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;

namespace {

enum Planner { prm, rrt, rrt_star };

struct Question {
    PolygonCore* core = nullptr;
    double start[2], goal[2];
    int planner = prm;
    long long neighbours = 0;
    sampling::Growth growth;

    // (core, start, goal, (planner, samples, seed, neighbours, step, goal bias)); false with an error set, or
    // with ends that need a closer look.
    bool read(PyObject* const* args) {
        core = polygon_core_of(args[0]);
        if (!core) return PyErr_SetString(PyExc_TypeError, "the core of a PolygonWorld"), false;
        long long samples;
        unsigned long long seed;
        if (!PyArg_ParseTuple(args[3], "iLKLdd", &planner, &samples, &seed, &neighbours, &growth.step,
                              &growth.goal_bias))
            return false;
        growth.samples = samples, growth.seed = seed, growth.is_optimal = planner == rrt_star;
        return read_point(args[1], start) && read_point(args[2], goal);
    }

    sampling::Answer on_roadmap(const sampling::Problem& problem, Trace* trace) const {
        const sampling::RoadmapKey key{problem.component, growth.samples, neighbours, growth.seed};
        const auto make = [&] { return std::make_shared<const sampling::Roadmap>(core->world, key); };
        const auto roadmap = core->roadmap.of(key, make, search::most_kept_bytes);
        return sampling::RoadmapSearch(problem, *roadmap).solve(trace);
    }

    // False where an end lies in an obstacle.
    bool answer(sampling::Answer& found, Trace* trace) const {
        const PolygonWorld& world = core->world;
        const Settled from = world.settle({start[0], start[1]}, core->tolerance);
        const Settled to = world.settle({goal[0], goal[1]}, core->tolerance);
        if (!from.is_free() || !to.is_free()) return false;
        const Index component = world.shared_component(from, to);
        found.route.status = Status::unreachable;
        if (component == none) return true;
        const sampling::Problem problem = sampling::problem_of(world, component, from, to);
        found = planner == prm ? on_roadmap(problem, trace) : sampling::Tree(problem, growth, trace).solve();
        std::vector<Point>& path = found.route.path;
        if (path.empty()) return true;
        path.front() = {start[0], start[1]}, path.back() = {goal[0], goal[1]};  // they were taken off a wall
        found.route.length = length_of(path);
        return true;
    }
};

// _sampling(world, planner, options, evidence, core, start, goal, settings) → route, or None where an end
// needs a closer look. evidence: what evidence is made with.
PyObject* sampled(PyObject*, PyObject* const* args, Py_ssize_t count) {
    if (count != 8) return PyErr_SetString(PyExc_TypeError, "_sampling takes eight arguments"), nullptr;
    Question q;
    if (!q.read(args + 4)) {
        if (PyErr_Occurred()) return nullptr;
        Py_RETURN_NONE;
    }
    const auto begin = std::chrono::steady_clock::now();
    sampling::Answer found;
    bool is_free;
    {
        nanobind::gil_scoped_release free;
        is_free = q.answer(found, nullptr);
    }
    if (!is_free) Py_RETURN_NONE;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    PyObject* made = make_route(args[0], args[1], args[2], q.start, q.goal, found.route, seconds);
    if (!made) return nullptr;
    const Stats& stats = found.route.stats;
    PyObject* evidence =
        PyObject_CallFunction(args[3], "LLL", static_cast<long long>(found.samples),
                              static_cast<long long>(stats.nodes), static_cast<long long>(stats.edges));
    reinterpret_cast<RouteObject*>(made)->evidence = evidence;
    if (!evidence) Py_CLEAR(made);
    return made;
}

// _sampling_trace(core, start, goal, settings) → the arrays of its trace
PyObject* sampled_trace(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Question q;
    sampling::Answer found;
    Trace trace;
    if (count != 4 || !q.read(args) || !q.answer(found, &trace)) {
        if (!PyErr_Occurred())
            PyErr_SetString(PyExc_TypeError, "_sampling_trace takes what _sampling answered");
        return nullptr;
    }
    return trace_arrays(trace);
}

PyCFunction fast(PyObject* (*function)(PyObject*, PyObject* const*, Py_ssize_t)) {
    return reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(function));
}
PyMethodDef methods[] = {{"_sampling", fast(sampled), METH_FASTCALL, nullptr},
                         {"_sampling_trace", fast(sampled_trace), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_sampling(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
