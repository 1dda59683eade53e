// The Voronoi diagram of free space: built once for a world, then asked.
#include "library/navigation_voronoi.hpp"

#include "maps_polygon_world.hpp"

using namespace cspace;
using namespace cspace::navigation;

namespace {

// (core, start, goal, widest, tolerance); false with an error set, or where an end needs a closer look.
bool find(PolygonQuestion& q, PyObject* const* args, VoronoiFinding& finding, Trace* trace) {
    const bool widest = args[3] == Py_True;
    const double tolerance = PyFloat_AsDouble(args[4]);
    if (PyErr_Occurred() || !q.read(args[0], args[1], args[2])) return false;
    const nanobind::gil_scoped_release free;
    return find_voronoi_route(*q.core, q.start, q.goal, widest, tolerance, finding, trace);
}

// _voronoi(world, planner, options, evidence, core, start, goal, widest, tolerance) → route, or None where an
// end needs a closer look. evidence: what evidence is made with.
PyObject* voronoi_route(PyObject*, PyObject* const* args, Py_ssize_t count) {
    if (count != 9) return PyErr_SetString(PyExc_TypeError, "_voronoi: expected nine arguments"), nullptr;
    PolygonQuestion q;
    VoronoiFinding way;
    const Watch watch;
    if (!find(q, args + 4, way, nullptr)) return no_answer();
    PyObject* made = make_route(args[0], args[1], args[2], q.start, q.goal, way.route, watch.seconds());
    if (!made || way.route.status != Status::found) return made;
    return add_evidence(made, PyObject_CallFunction(args[3], "dddd", way.clearance, way.on_diagram,
                                                    way.at_start, way.at_goal));
}

// _voronoi_trace(core, start, goal, widest, tolerance) → the arrays of its trace
PyObject* voronoi_trace(PyObject*, PyObject* const* args, Py_ssize_t count) {
    PolygonQuestion q;
    VoronoiFinding way;
    Trace trace;
    return count == 5 && find(q, args, way, &trace) ? trace_arrays(trace) : no_trace();
}

// _voronoi_diagram(core, tolerance) → vertices (n, 2), their clearance (n,), ends of arcs (k, 2), a list of
// (polyline, clearance), and whether all components are whole
PyObject* voronoi_diagram(PyObject*, PyObject* args) {
    PyObject* owner;
    double tolerance;
    if (!PyArg_ParseTuple(args, "Od", &owner, &tolerance)) return nullptr;
    const PolygonCore* core = polygon_core_of(owner);
    if (!core) return nullptr;
    const VoronoiArcs diagram = list_voronoi_arcs(*core, tolerance);
    std::vector<std::int32_t> ends;
    PyObject* arcs = PyList_New(0);
    for (const VoronoiArc& arc : diagram.arcs) {
        ends.insert(ends.end(), {arc.from, arc.to});
        PyObject* one =
            arcs ? Py_BuildValue("NN", rows_of(arc.line), rows_of(arc.clearance, 1, NPY_DOUBLE)) : nullptr;
        if (!one || PyList_Append(arcs, one) < 0) Py_CLEAR(arcs);
        Py_XDECREF(one);
    }
    return Py_BuildValue("NNNNO", rows_of(diagram.vertices), rows_of(diagram.clearance, 1, NPY_DOUBLE),
                         rows_of(ends, 2, NPY_INT32), arcs, diagram.is_whole ? Py_True : Py_False);
}

PyMethodDef methods[] = {{"_voronoi", fast(voronoi_route), METH_FASTCALL, nullptr},
                         {"_voronoi_trace", fast(voronoi_trace), METH_FASTCALL, nullptr},
                         {"_voronoi_diagram", voronoi_diagram, METH_VARARGS, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_voronoi(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
