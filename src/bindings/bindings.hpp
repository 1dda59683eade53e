// The parts of the compiled half, in the order in which they are filled: bind_<part> stands in <part>.cpp.
#pragma once

#include <nanobind/nanobind.h>

// clang-format off
#define CSPACE_BINDINGS(bind)                                                                              \
    bind(math) bind(kinematics) bind(kinematics_rows) bind(spatial_rotations) bind(ik_subproblems)         \
    bind(ik_solver) bind(robot) bind(ik_result) bind(ik) bind(ik_self_motion) bind(ik_goals)               \
    bind(ik_numeric) bind(ik_redundancy) bind(ik_tasks) bind(ik_tracking) bind(ik_description)             \
    bind(navigation_route) bind(navigation_grid) bind(navigation_coverage) bind(navigation_cars)           \
    bind(navigation_following) bind(navigation_polygons) bind(navigation_bugs)                             \
    bind(navigation_fields_grid) bind(navigation_fields_polygons) bind(maps_polygon_world)
// clang-format on

#define CSPACE_DECLARE_BINDING(part) void bind_##part(nanobind::module_& m);
CSPACE_BINDINGS(CSPACE_DECLARE_BINDING)

// What f returns; null, with what it throws as the error of Python.
template <class F>
PyObject* or_error(F f) noexcept {
    try {
        return f();
    } catch (nanobind::python_error& error) {
        error.restore();
    } catch (const nanobind::builtin_exception& error) {
        const bool is_type = error.type() == nanobind::exception_type::type_error;
        PyErr_SetString(is_type ? PyExc_TypeError : PyExc_ValueError, error.what());
    } catch (const std::bad_alloc&) {
        PyErr_NoMemory();
    } catch (const std::exception& error) {
        PyErr_SetString(PyExc_RuntimeError, error.what());
    }
    return nullptr;
}

// Adds a raw type to the module, for good.
PyTypeObject* add_type(nanobind::module_& m, PyType_Spec& spec, PyTypeObject* base = nullptr);
