#include "navigation_route.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "bindings.hpp"

using namespace cspace::navigation;
using cspace::Point;

namespace {

PyTypeObject* route_type = nullptr;  // the Python class that routes are made of
PyTypeObject* base_type = nullptr;   // RouteBase

RouteObject* route_of(PyObject* self) { return reinterpret_cast<RouteObject*>(self); }

int traverse(PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    Py_VISIT(route_of(self)->world);
    Py_VISIT(route_of(self)->planner);
    Py_VISIT(route_of(self)->evidence);
    return 0;
}
int clear(PyObject* self) {
    Py_CLEAR(route_of(self)->world);
    Py_CLEAR(route_of(self)->planner);
    Py_CLEAR(route_of(self)->evidence);
    return 0;
}
void destroy(PyObject* self) {
    PyTypeObject* type = Py_TYPE(self);
    PyObject_GC_UnTrack(self);
    clear(self);
    type->tp_free(self);
    Py_DECREF(type);
}

PyObject* get_path(PyObject* self, void*) {
    const npy_intp shape[2] = {route_of(self)->count, 2};
    PyObject* array = PyArray_SimpleNew(2, const_cast<npy_intp*>(shape), NPY_DOUBLE);
    const std::size_t bytes = sizeof(Point) * std::size_t(shape[0]);
    if (array && bytes)
        std::memcpy(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array)), route_of(self)->path, bytes);
    return array;
}
PyObject* get_start(PyObject* self, void*) { return number_row(&route_of(self)->start.x, 2); }
PyObject* get_goal(PyObject* self, void*) { return number_row(&route_of(self)->goal.x, 2); }
PyObject* get_length(PyObject* self, void*) { return PyFloat_FromDouble(route_of(self)->length); }
PyObject* get_verdict(PyObject* self, void*) { return PyLong_FromLong(long(route_of(self)->status)); }
PyObject* get_numbers(PyObject* self, void*) {
    const RouteObject* r = route_of(self);
    return Py_BuildValue("LLd", static_cast<long long>(r->stats.nodes),
                         static_cast<long long>(r->stats.edges), r->seconds);
}
PyObject* or_none(PyObject* value) { return Py_NewRef(value ? value : Py_None); }
PyObject* get_world(PyObject* self, void*) { return or_none(route_of(self)->world); }
PyObject* get_planner(PyObject* self, void*) { return or_none(route_of(self)->planner); }
PyObject* get_evidence(PyObject* self, void*) { return or_none(route_of(self)->evidence); }
int truth(PyObject* self) { return route_of(self)->status == Status::found; }

PyGetSetDef attributes[] = {
    {"path", get_path, nullptr, "The corners of the path (m, 2) [m], from start to goal.", nullptr},
    {"start", get_start, nullptr, "Where the robot starts (2,) [m].", nullptr},
    {"goal", get_goal, nullptr, "Where it is to go (2,) [m].", nullptr},
    {"length", get_length, nullptr, "The length of the path [m]; inf where there is none.", nullptr},
    {"world", get_world, nullptr, "The world that was asked about.", nullptr},
    {"_asked", get_planner, nullptr, "The planner with the options in force.", nullptr},
    {"_verdict", get_verdict, nullptr, "The status as a number.", nullptr},
    {"_numbers", get_numbers, nullptr, "Nodes, edges, seconds.", nullptr},
    {"_evidence", get_evidence, nullptr, "What backs the verdict, or None.", nullptr},
    {nullptr, nullptr, nullptr, nullptr, nullptr}};
PyType_Slot slots[] = {{Py_tp_dealloc, reinterpret_cast<void*>(&destroy)},
                       {Py_tp_traverse, reinterpret_cast<void*>(&traverse)},
                       {Py_tp_clear, reinterpret_cast<void*>(&clear)},
                       {Py_tp_getset, attributes},
                       {Py_nb_bool, reinterpret_cast<void*>(&truth)},
                       {Py_tp_doc, const_cast<char*>("The compiled half of cspace.navigation.Route.")},
                       {0, nullptr}};
PyType_Spec spec = {
    "cspace._core.RouteBase", offsetof(RouteObject, path), sizeof(Point),
    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_HAVE_GC | Py_TPFLAGS_DISALLOW_INSTANTIATION, slots};

// The route as it is; evidence is taken over.
PyObject* new_route(PyObject* world, PyObject* planner, Point start, Point goal, const Route& route,
                    double seconds, PyObject* evidence) {
    if (!route_type)
        PyErr_SetString(
            PyExc_ImportError,
            "cspace.navigation.route has not registered its class; import cspace.navigation first");
    const auto count = Py_ssize_t(route.path.size());
    auto* made =
        route_type ? reinterpret_cast<RouteObject*>(route_type->tp_alloc(route_type, count)) : nullptr;
    if (!made) return Py_XDECREF(evidence), nullptr;
    made->world = Py_NewRef(world);
    made->planner = Py_NewRef(planner);
    made->evidence = evidence;
    made->start = start, made->goal = goal;
    made->length = route.length, made->seconds = seconds;
    made->stats = route.stats;
    made->count = int(count);
    made->status = route.status;
    std::copy(route.path.begin(), route.path.end(), made->path);
    return reinterpret_cast<PyObject*>(made);
}

bool is_points(PyObject* value) {
    if (!PyArray_Check(value)) return false;
    auto* array = reinterpret_cast<PyArrayObject*>(value);
    return PyArray_TYPE(array) == NPY_DOUBLE && PyArray_ISCARRAY_RO(array) && PyArray_NDIM(array) == 2 &&
           PyArray_DIM(array, 1) == 2 && PyArray_DIM(array, 0) <= 1 << 28;
}

// _route_make(world, planner, start, goal, status, path (m, 2), length, nodes, edges, seconds, evidence)
PyObject* route_make(PyObject*, PyObject* args) {
    PyObject *world, *planner, *start, *goal, *path, *evidence;
    int status;
    double seconds;
    Point ends[2];
    Route route;
    long long nodes, edges;
    if (!PyArg_ParseTuple(args, "OOOOiOdLLdO", &world, &planner, &start, &goal, &status, &path, &route.length,
                          &nodes, &edges, &seconds, &evidence))
        return nullptr;
    if (!is_points(path) || !read_point(start, ends[0]) || !read_point(goal, ends[1]) || status < 0 ||
        status > int(Status::local_minimum)) {
        PyErr_SetString(PyExc_TypeError, "_route_make: expected points as float64 arrays and a known status");
        return nullptr;
    }
    auto* array = reinterpret_cast<PyArrayObject*>(path);
    const auto* points = static_cast<const Point*>(PyArray_DATA(array));
    route.path.assign(points, points + PyArray_DIM(array, 0));
    route.status = static_cast<Status>(status);
    route.stats = {nodes, edges};
    return new_route(world, planner, ends[0], ends[1], route, seconds, Py_NewRef(evidence));
}

// _route_class(cls): routes are made of this class from now on.
PyObject* route_class(PyObject*, PyObject* cls) {
    if (!PyType_Check(cls) || !PyType_IsSubtype(reinterpret_cast<PyTypeObject*>(cls), base_type)) {
        PyErr_SetString(PyExc_TypeError, "_route_class: expected a subclass of RouteBase");
        return nullptr;
    }
    Py_XDECREF(route_type);
    route_type = reinterpret_cast<PyTypeObject*>(Py_NewRef(cls));
    Py_RETURN_NONE;
}

PyMethodDef methods[] = {{"_route_make", route_make, METH_VARARGS, nullptr},
                         {"_route_class", route_class, METH_O, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

bool read_number(PyObject* item, double& number) {
    if (PyFloat_Check(item))
        number = PyFloat_AS_DOUBLE(item);
    else if (PyLong_CheckExact(item))
        number = PyLong_AsDouble(item);
    else
        return false;
    if (number == -1 && PyErr_Occurred()) return PyErr_Clear(), false;
    return std::isfinite(number);
}

bool read_numbers(PyObject* value, double* row, int count) {
    if (PyTuple_CheckExact(value) && PyTuple_GET_SIZE(value) == count) {
        for (int k = 0; k < count; ++k)
            if (!read_number(PyTuple_GET_ITEM(value, k), row[k])) return false;
        return true;
    }
    if (!PyArray_Check(value)) return false;
    auto* array = reinterpret_cast<PyArrayObject*>(value);
    if (PyArray_TYPE(array) != NPY_DOUBLE || PyArray_NDIM(array) != 1 || PyArray_DIM(array, 0) != count ||
        !PyArray_ISCARRAY_RO(array))
        return false;
    std::copy_n(static_cast<const double*>(PyArray_DATA(array)), count, row);
    return std::all_of(row, row + count, [](double number) { return std::isfinite(number); });
}

PyObject* number_row(const double* numbers, npy_intp count) {
    PyObject* made = PyArray_SimpleNew(1, &count, NPY_DOUBLE);
    if (made)
        std::copy_n(numbers, count,
                    static_cast<double*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(made))));
    return made;
}

PyObject* make_route(PyObject* world, PyObject* planner, Point start, Point goal, const Route& route,
                     double seconds, PyObject* evidence) {
    if (!evidence && PyErr_Occurred()) return nullptr;
    // Who is at the goal already stays: a path of one point, whatever the planner's own way to say so is.
    if (route.status != Status::found || !(start == goal))
        return new_route(world, planner, start, goal, route, seconds, evidence);
    return new_route(world, planner, start, goal, {Status::found, {start}, 0, route.stats}, seconds,
                     evidence);
}

PyObject* trace_arrays(const Trace& trace) {
    npy_intp rows[2] = {npy_intp(trace.size()), 2};
    PyObject* kinds = PyArray_SimpleNew(1, rows, NPY_INT8);
    PyObject* from = PyArray_SimpleNew(2, rows, NPY_DOUBLE);
    PyObject* to = PyArray_SimpleNew(2, rows, NPY_DOUBLE);
    PyObject* values = PyArray_SimpleNew(1, rows, NPY_DOUBLE);
    if (kinds && from && to && values) {
        const auto data = [](PyObject* array) {
            return PyArray_DATA(reinterpret_cast<PyArrayObject*>(array));
        };
        for (std::size_t i = 0; i < trace.size(); ++i) {
            static_cast<std::int8_t*>(data(kinds))[i] = trace[i].kind;
            static_cast<Point*>(data(from))[i] = trace[i].from;
            static_cast<Point*>(data(to))[i] = trace[i].to;
            static_cast<double*>(data(values))[i] = trace[i].value;
        }
        return Py_BuildValue("NNNN", kinds, from, to, values);
    }
    for (PyObject* array : {kinds, from, to, values}) Py_XDECREF(array);
    return nullptr;
}

void bind_navigation_route(nanobind::module_& m) {
    PyObject* type = PyType_FromSpec(&spec);
    if (!type || PyModule_AddObjectRef(m.ptr(), "RouteBase", type) < 0 ||
        PyModule_AddFunctions(m.ptr(), methods) < 0)
        throw nanobind::python_error();
    base_type = reinterpret_cast<PyTypeObject*>(type);  // kept for good
}
