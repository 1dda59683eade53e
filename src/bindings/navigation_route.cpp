#include "navigation_route.hpp"

#include <structmember.h>

#include <algorithm>

#include "maps_points.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::navigation;
using cspace::Point;

namespace {

ResultType route_type("cspace.navigation.route", "_route_class");

RouteObject* route_of(PyObject* self) { return reinterpret_cast<RouteObject*>(self); }
using Slots =
    Collected<RouteObject, free_object, &RouteObject::world, &RouteObject::planner, &RouteObject::evidence>;

PyObject* get_path(PyObject* self, void*) {
    return new_array({route_of(self)->count, 2}, &route_of(self)->path->x);
}
PyObject* get_start(PyObject* self, void*) { return new_array({2}, &route_of(self)->start.x); }
PyObject* get_goal(PyObject* self, void*) { return new_array({2}, &route_of(self)->goal.x); }
PyObject* get_verdict(PyObject* self, void*) { return PyLong_FromLong(long(route_of(self)->status)); }
PyObject* get_numbers(PyObject* self, void*) {
    const RouteObject* r = route_of(self);
    return Py_BuildValue("LLd", static_cast<long long>(r->stats.nodes),
                         static_cast<long long>(r->stats.edges), r->seconds);
}
int truth(PyObject* self) { return route_of(self)->status == Status::found; }

PyMemberDef members[] = {
    {"length", T_DOUBLE, offsetof(RouteObject, length), READONLY,
     "The length of the path [m]; inf where there is none."},
    {"world", T_OBJECT, offsetof(RouteObject, world), READONLY, "The world that was asked about."},
    {"_asked", T_OBJECT, offsetof(RouteObject, planner), READONLY, "The planner with the options in force."},
    {"_evidence", T_OBJECT, offsetof(RouteObject, evidence), READONLY, "What backs the verdict, or None."},
    {nullptr, 0, 0, 0, nullptr}};
PyGetSetDef attributes[] = {
    {"path", get_path, nullptr, "The corners of the path (m, 2) [m], from start to goal.", nullptr},
    {"start", get_start, nullptr, "Where the robot starts (2,) [m].", nullptr},
    {"goal", get_goal, nullptr, "Where it is to go (2,) [m].", nullptr},
    {"_verdict", get_verdict, nullptr, "The status as a number.", nullptr},
    {"_numbers", get_numbers, nullptr, "Nodes, edges, seconds.", nullptr},
    {nullptr, nullptr, nullptr, nullptr, nullptr}};
PyType_Slot slots[] = {{Py_tp_dealloc, reinterpret_cast<void*>(&Slots::destroy)},
                       {Py_tp_traverse, reinterpret_cast<void*>(&Slots::visit)},
                       {Py_tp_clear, reinterpret_cast<void*>(&Slots::clear)},
                       {Py_tp_members, members},
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
    const auto count = Py_ssize_t(route.path.size());
    auto* made = reinterpret_cast<RouteObject*>(route_type.make(count));
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

nb::object route_from_parts(nb::handle world, nb::handle planner, Point start, Point goal, int status,
                            std::span<const Point> path, double length, std::int64_t nodes,
                            std::int64_t edges, double seconds, nb::handle evidence) {
    if (status < 0 || status > int(Status::local_minimum))
        throw nb::type_error("_route_make takes a status it knows");
    const Route route = {static_cast<Status>(status), {path.begin(), path.end()}, length, {nodes, edges}};
    PyObject* made =
        new_route(world.ptr(), planner.ptr(), start, goal, route, seconds, evidence.inc_ref().ptr());
    if (!made) throw nb::python_error();
    return nb::steal(made);
}

}  // namespace

PyObject* make_route(PyObject* world, PyObject* planner, Point start, Point goal, const Route& route,
                     double seconds, PyObject* evidence) {
    // Who is at the goal already stays: a path of one point, whatever the planner's own way to say so is.
    if (route.status != Status::found || !(start == goal))
        return new_route(world, planner, start, goal, route, seconds, evidence);
    return new_route(world, planner, start, goal, {Status::found, {start}, 0, route.stats}, seconds,
                     evidence);
}

PyObject* trace_arrays(const Trace& trace) {
    cspace::Table<std::int8_t> kinds;
    cspace::Table<Point> from, to;
    cspace::Table<double> values;
    for (const Event& event : trace) {
        kinds.values.push_back(event.kind);
        from.values.push_back(event.from);
        to.values.push_back(event.to);
        values.values.push_back(event.value);
    }
    return nb::make_tuple(std::move(kinds), std::move(from), std::move(to), std::move(values))
        .release()
        .ptr();
}

void bind_navigation_route(nb::module_& m) {
    route_type.add(m, spec);
    m.def("_route_make", route_from_parts, "world"_a, "planner"_a, "start"_a, "goal"_a, "status"_a, "path"_a,
          "length"_a, "nodes"_a, "edges"_a, "seconds"_a, "evidence"_a.none(), "A route from its parts.");
}
