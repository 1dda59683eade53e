// The Voronoi diagram of free space: built once for a world, then asked.
#include <chrono>

#include "maps_polygon_world.hpp"
#include "navigation_route.hpp"

using namespace cspace;
using namespace cspace::maps;
using namespace cspace::navigation;
using voronoi::Roadmap;
using Answer = voronoi::Way;

namespace {

// Building lets other threads run; of two that build at once, the first keeps its roadmap.
const Roadmap& roadmap_of(PolygonCore& core) {
    if (!core.voronoi) {
        std::unique_ptr<Roadmap> made;
        {
            nanobind::gil_scoped_release free;
            made = std::make_unique<Roadmap>(core.world);
        }
        if (!core.voronoi) core.voronoi = std::move(made);
    }
    return *core.voronoi;
}

struct Question {
    PolygonCore* core;
    double start[2], goal[2];
    bool widest;
    double tolerance;

    // False where an end lies in an obstacle.
    bool answer(Answer& way, Trace* trace) const {
        const Settled from = core->world.settle({start[0], start[1]}, core->tolerance);
        const Settled to = core->world.settle({goal[0], goal[1]}, core->tolerance);
        if (!from.is_free() || !to.is_free()) return false;
        const Index component = core->world.shared_component(from, to);
        way.route.status = Status::unreachable;
        if (component == none) return true;
        way = roadmap_of(*core).solve(from, to, component, widest, tolerance, trace);
        std::vector<Point>& path = way.route.path;
        if (!path.empty()) path.front() = {start[0], start[1]}, path.back() = {goal[0], goal[1]};
        return true;
    }
};

// (core, start, goal, widest, tolerance); false with an error set, or with ends that need a closer look.
bool read_question(PyObject* const* args, Question& q) {
    q.core = polygon_core_of(args[0]);
    if (!q.core) return PyErr_SetString(PyExc_TypeError, "the core of a PolygonWorld"), false;
    q.widest = args[3] == Py_True;
    q.tolerance = PyFloat_AsDouble(args[4]);
    if (PyErr_Occurred()) return false;
    return read_point(args[1], q.start) && read_point(args[2], q.goal);
}

// _voronoi(world, planner, options, evidence, core, start, goal, widest, tolerance) → route, or None where an
// end needs a closer look. evidence: what evidence is made with.
PyObject* voronoi_route(PyObject*, PyObject* const* args, Py_ssize_t count) {
    if (count != 9) return PyErr_SetString(PyExc_TypeError, "_voronoi takes nine arguments"), nullptr;
    Question q{};
    if (!read_question(args + 4, q)) {
        if (PyErr_Occurred()) return nullptr;
        Py_RETURN_NONE;
    }
    const auto begin = std::chrono::steady_clock::now();
    Answer way;
    if (!q.answer(way, nullptr)) Py_RETURN_NONE;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    PyObject* made = make_route(args[0], args[1], args[2], q.start, q.goal, way.route, seconds);
    if (!made || way.route.status != Status::found) return made;
    PyObject* evidence =
        PyObject_CallFunction(args[3], "dddd", way.clearance, way.on_diagram, way.at_start, way.at_goal);
    reinterpret_cast<RouteObject*>(made)->evidence = evidence;
    if (!evidence) Py_CLEAR(made);
    return made;
}

// _voronoi_trace(core, start, goal, widest, tolerance) → the arrays of its trace
PyObject* voronoi_trace(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Question q{};
    Answer way;
    Trace trace;
    if (count != 5 || !read_question(args, q) || !q.answer(way, &trace)) {
        if (!PyErr_Occurred())
            PyErr_SetString(PyExc_TypeError, "_voronoi_trace takes what _voronoi answered");
        return nullptr;
    }
    return trace_arrays(trace);
}

PyObject* array(int dimensions, npy_intp rows, int type) {
    npy_intp shape[2] = {rows, 2};
    return PyArray_SimpleNew(dimensions, shape, type);
}
template <class T>
T* data_of(PyObject* made) {
    return static_cast<T*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(made)));
}

// (polyline (k, 2), clearance (k,)) of one arc
PyObject* drawn(const voronoi::Diagram& diagram, const voronoi::Arc& arc, double tolerance) {
    std::vector<Point> points{arc.curve.at(arc.begin)};
    Roadmap::sample(arc.curve, arc.begin, arc.end, tolerance, points);
    PyObject* line = array(2, npy_intp(points.size()), NPY_DOUBLE);
    PyObject* clearance = array(1, npy_intp(points.size()), NPY_DOUBLE);
    if (line && clearance)
        for (std::size_t i = 0; i < points.size(); ++i) {
            data_of<Point>(line)[i] = diagram.place(points[i]);
            data_of<double>(clearance)[i] = arc.curve.radius(arc.curve.parameter(points[i]));
        }
    return Py_BuildValue("NN", line, clearance);
}

// _voronoi_diagram(core, tolerance) → vertices (n, 2), their clearance (n,), ends of arcs (k, 2), a list of
// (polyline, clearance), and which components are whole
PyObject* voronoi_diagram(PyObject*, PyObject* args) {
    PyObject* owner;
    double tolerance;
    if (!PyArg_ParseTuple(args, "Od", &owner, &tolerance)) return nullptr;
    PolygonCore* core = polygon_core_of(owner);
    if (!core) return PyErr_SetString(PyExc_TypeError, "the core of a PolygonWorld"), nullptr;
    const voronoi::Diagram& d = roadmap_of(*core).diagram();
    PyObject* at = array(2, npy_intp(d.vertices.size()), NPY_DOUBLE);
    PyObject* clearance = array(1, npy_intp(d.vertices.size()), NPY_DOUBLE);
    PyObject* ends = array(2, npy_intp(d.arcs.size()), NPY_INT32);
    PyObject* arcs = PyList_New(0);
    bool all = true;
    for (const auto whole : d.is_whole) all = all && whole;
    if (at && clearance && ends && arcs) {
        for (std::size_t v = 0; v < d.vertices.size(); ++v) {
            data_of<Point>(at)[v] = d.place(d.vertices[v].at);
            data_of<double>(clearance)[v] = d.vertices[v].radius;
        }
        for (std::size_t k = 0; k < d.arcs.size(); ++k) {
            data_of<Index>(ends)[2 * k] = d.arcs[k].from, data_of<Index>(ends)[2 * k + 1] = d.arcs[k].to;
            PyObject* one = drawn(d, d.arcs[k], tolerance);
            if (one) PyList_Append(arcs, one);
            Py_XDECREF(one);
        }
    }
    PyObject* made = PyErr_Occurred()
                         ? nullptr
                         : Py_BuildValue("OOOOO", at, clearance, ends, arcs, all ? Py_True : Py_False);
    for (PyObject* part : {at, clearance, ends, arcs}) Py_XDECREF(part);
    return made;
}

PyCFunction fast(PyObject* (*function)(PyObject*, PyObject* const*, Py_ssize_t)) {
    return reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(function));
}
PyMethodDef methods[] = {{"_voronoi", fast(voronoi_route), METH_FASTCALL, nullptr},
                         {"_voronoi_trace", fast(voronoi_trace), METH_FASTCALL, nullptr},
                         {"_voronoi_diagram", voronoi_diagram, METH_VARARGS, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_voronoi(nanobind::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nanobind::python_error();
}
