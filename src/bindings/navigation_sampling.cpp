// Planners that draw points from free space: roadmaps and trees.
#include "library/navigation_polygons.hpp"
#include "maps_polygon_world.hpp"

using namespace cspace;
using namespace cspace::navigation;

namespace {

// (core, start, goal, (planner, samples, seed, neighbours, step, goal bias)); false with an error set, or
// where an end needs a closer look.
bool find(PolygonQuestion& q, PyObject* const* args, SamplingFinding& finding, Trace* trace) {
    SamplingSettings s;
    if (!PyArg_ParseTuple(args[3], "iLKLdd", &s.planner, &s.samples, &s.seed, &s.neighbours, &s.step,
                          &s.goal_bias) ||
        !q.read(args[0], args[1], args[2]))
        return false;
    const nanobind::gil_scoped_release free;
    return find_sampled_route(*q.core, s, q.start, q.goal, finding, trace);
}

// _sampling(world, planner, options, evidence, core, start, goal, settings) → route, or None where an end
// needs a closer look. evidence: what evidence is made with.
PyObject* sampled(PyObject*, PyObject* const* args, Py_ssize_t count) {
    if (count != 8) return PyErr_SetString(PyExc_TypeError, "_sampling: expected eight arguments"), nullptr;
    PolygonQuestion q;
    SamplingFinding finding;
    const Watch watch;
    if (!find(q, args + 4, finding, nullptr)) return no_answer();
    PyObject* made = make_route(args[0], args[1], args[2], q.start, q.goal, finding.route, watch.seconds());
    const Stats& stats = finding.route.stats;
    return add_evidence(
        made,
        made ? PyObject_CallFunction(args[3], "LLL", static_cast<long long>(finding.samples),
                                     static_cast<long long>(stats.nodes), static_cast<long long>(stats.edges))
             : nullptr);
}

// _sampling_trace(core, start, goal, settings) → the arrays of its trace
PyObject* sampled_trace(PyObject*, PyObject* const* args, Py_ssize_t count) {
    PolygonQuestion q;
    SamplingFinding finding;
    Trace trace;
    return count == 4 && find(q, args, finding, &trace) ? trace_arrays(trace) : no_trace();
}

PyMethodDef methods[] = {{"_sampling", fast(sampled), METH_FASTCALL, nullptr},
                         {"_sampling_trace", fast(sampled_trace), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_sampling(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
