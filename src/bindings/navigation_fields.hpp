// What the bindings of fields share: routes and traces from what planners return.
#pragma once

#include "maps_points.hpp"
#include "navigation_route.hpp"

namespace fields {

inline nanobind::object made_route(nanobind::handle world, nanobind::handle planner, nanobind::handle options,
                                   const PointRow& start, const PointRow& goal,
                                   const cspace::navigation::Route& route, double seconds) {
    PyObject* made = make_route(world.ptr(), planner.ptr(), options.ptr(), point_of(start), point_of(goal),
                                route, seconds);
    if (!made) throw nanobind::python_error();
    return nanobind::steal(made);
}
inline void set_evidence(nanobind::handle route, nanobind::object evidence) {
    reinterpret_cast<RouteObject*>(route.ptr())->evidence = evidence.release().ptr();
}

inline nanobind::object arrays_of(const cspace::navigation::Trace& trace) {
    PyObject* made = trace_arrays(trace);
    if (!made) throw nanobind::python_error();
    return nanobind::steal(made);
}

}  // namespace fields
