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
    Py_VISIT(route_of(self)->options);
    Py_VISIT(route_of(self)->evidence);
    return 0;
}
int clear(PyObject* self) {
    Py_CLEAR(route_of(self)->world);
    Py_CLEAR(route_of(self)->planner);
    Py_CLEAR(route_of(self)->options);
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

PyObject* array_of(const Point* points, const npy_intp* shape, int dimensions) {
    PyObject* array = PyArray_SimpleNew(dimensions, const_cast<npy_intp*>(shape), NPY_DOUBLE);
    const std::size_t bytes = array ? PyArray_NBYTES(reinterpret_cast<PyArrayObject*>(array)) : 0;
    if (bytes) std::memcpy(PyArray_DATA(reinterpret_cast<PyArrayObject*>(array)), points, bytes);
    return array;
}
PyObject* get_path(PyObject* self, void*) {
    const npy_intp shape[2] = {route_of(self)->count, 2};
    return array_of(route_of(self)->path, shape, 2);
}
PyObject* point_array(const Point& point) {
    const npy_intp two = 2;
    return array_of(&point, &two, 1);
}
PyObject* get_start(PyObject* self, void*) { return point_array(route_of(self)->start); }
PyObject* get_goal(PyObject* self, void*) { return point_array(route_of(self)->goal); }
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
PyObject* get_options(PyObject* self, void*) { return or_none(route_of(self)->options); }
PyObject* get_evidence(PyObject* self, void*) { return or_none(route_of(self)->evidence); }
int truth(PyObject* self) { return route_of(self)->status == Status::found; }

PyGetSetDef attributes[] = {
    {"path", get_path, nullptr, "The corners of the path (m, 2) [m], from start to goal.", nullptr},
    {"start", get_start, nullptr, "Where the robot starts (2,) [m].", nullptr},
    {"goal", get_goal, nullptr, "Where it is to go (2,) [m].", nullptr},
    {"length", get_length, nullptr, "The length of the path [m]; inf where there is none.", nullptr},
    {"world", get_world, nullptr, "The world that was asked about.", nullptr},
    {"planner", get_planner, nullptr, "The name of the planner.", nullptr},
    {"_verdict", get_verdict, nullptr, "The status as a number.", nullptr},
    {"_numbers", get_numbers, nullptr, "Nodes, edges, seconds.", nullptr},
    {"_options", get_options, nullptr, "The options of the planner, or None.", nullptr},
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

bool is_points(PyObject* value) {
    if (!PyArray_Check(value)) return false;
    auto* array = reinterpret_cast<PyArrayObject*>(value);
    return PyArray_TYPE(array) == NPY_DOUBLE && PyArray_ISCARRAY_RO(array) && PyArray_NDIM(array) == 2 &&
           PyArray_DIM(array, 1) == 2 && PyArray_DIM(array, 0) <= 1 << 28;
}

// _route_make(world, planner, options, start, goal, status, path (m, 2), length, nodes, edges, seconds,
// evidence)
PyObject* route_make(PyObject*, PyObject* args) {
    PyObject *world, *planner, *options, *start, *goal, *path, *evidence;
    int status;
    double length, seconds;
    Point ends[2];
    long long nodes, edges;
    if (!PyArg_ParseTuple(args, "OUOOOiOdLLdO", &world, &planner, &options, &start, &goal, &status, &path,
                          &length, &nodes, &edges, &seconds, &evidence))
        return nullptr;
    if (!is_points(path) || !read_point(start, ends[0]) || !read_point(goal, ends[1]) || status < 0 ||
        status > int(Status::local_minimum)) {
        PyErr_SetString(PyExc_TypeError, "_route_make: expected points as float64 arrays and a known status");
        return nullptr;
    }
    auto* array = reinterpret_cast<PyArrayObject*>(path);
    RouteObject* made = new_route(world, planner, options, ends[0], ends[1], static_cast<Status>(status),
                                  int(PyArray_DIM(array, 0)));
    if (!made) return nullptr;
    if (made->count) std::memcpy(made->path, PyArray_DATA(array), sizeof(Point) * std::size_t(made->count));
    made->length = length;
    made->seconds = seconds;
    made->stats = {nodes, edges};
    made->evidence = evidence == Py_None ? nullptr : Py_NewRef(evidence);
    return reinterpret_cast<PyObject*>(made);
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

// One entry of a sequence as a finite number. Only plain floats and integers are read here.
bool read_number(PyObject* item, double* number) {
    if (PyFloat_Check(item))
        *number = PyFloat_AS_DOUBLE(item);
    else if (PyLong_CheckExact(item))
        *number = PyLong_AsDouble(item);
    else
        return false;
    if (*number == -1 && PyErr_Occurred()) return PyErr_Clear(), false;
    return std::isfinite(*number);
}

}  // namespace

bool read_point(PyObject* value, Point& point) {
    if (PyTuple_CheckExact(value) && PyTuple_GET_SIZE(value) == 2)
        return read_number(PyTuple_GET_ITEM(value, 0), &point.x) &&
               read_number(PyTuple_GET_ITEM(value, 1), &point.y);
    if (!PyArray_Check(value)) return false;
    auto* array = reinterpret_cast<PyArrayObject*>(value);
    if (PyArray_TYPE(array) != NPY_DOUBLE || PyArray_NDIM(array) != 1 || PyArray_DIM(array, 0) != 2 ||
        !PyArray_ISCARRAY_RO(array))
        return false;
    std::memcpy(&point, PyArray_DATA(array), sizeof point);
    return std::isfinite(point.x) && std::isfinite(point.y);
}

RouteObject* new_route(PyObject* world, PyObject* planner, PyObject* options, Point start, Point goal,
                       Status status, int count) {
    if (!route_type) {
        PyErr_SetString(
            PyExc_ImportError,
            "cspace.navigation.route has not registered its class; import cspace.navigation first");
        return nullptr;
    }
    auto* made = reinterpret_cast<RouteObject*>(route_type->tp_alloc(route_type, count));
    if (!made) return nullptr;
    made->world = Py_NewRef(world);
    made->planner = Py_NewRef(planner);
    made->options = options && options != Py_None ? Py_NewRef(options) : nullptr;
    made->start = start, made->goal = goal;
    made->status = status;
    made->count = count;
    made->length = std::numeric_limits<double>::infinity();
    return made;
}

PyObject* make_route(PyObject* world, PyObject* planner, PyObject* options, Point start, Point goal,
                     const Route& route, double seconds) {
    // Who is at the goal already stays: a path of one point, whatever the planner's own way to say so is.
    const bool stays = route.status == Status::found && start == goal;
    const std::size_t count = stays ? 1 : route.path.size();
    RouteObject* made = new_route(world, planner, options, start, goal, route.status, int(count));
    if (!made) return nullptr;
    std::copy_n(stays ? &start : route.path.data(), count, made->path);
    made->length = stays ? 0 : route.length;
    made->seconds = seconds;
    made->stats = route.stats;
    return reinterpret_cast<PyObject*>(made);
}

PyObject* add_evidence(PyObject* route, PyObject* evidence) {
    if (route && evidence) {
        route_of(route)->evidence = evidence;
        return route;
    }
    Py_XDECREF(route);
    Py_XDECREF(evidence);
    return nullptr;
}

PyObject* rows_of(const std::vector<Point>& points, int each) {
    npy_intp shape[2] = {npy_intp(points.size()) / each, 2 * each};
    return array_of(points.data(), shape, 2);
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
