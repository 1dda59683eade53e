// The parts of the compiled half, in the order in which they are filled: bind_<part> stands in <part>.cpp.
#pragma once

#include <nanobind/nanobind.h>

// clang-format off
#define CSPACE_BINDINGS(bind)                                                                              \
    bind(math) bind(kinematics) bind(kinematics_rows) bind(kinematics_loops) bind(spatial_rotations) bind(ik_subproblems)         \
    bind(ik_solver) bind(dynamics) bind(robot) bind(ik_result) bind(ik) bind(ik_self_motion) bind(ik_goals)               \
    bind(ik_numeric) bind(ik_redundancy) bind(ik_tracking) bind(ik_description) bind(maps) bind(shapes)    \
    bind(collision) bind(collision_solids) bind(planning_arm) bind(navigation_route) bind(navigation_grid) \
    bind(navigation_polygons) bind(navigation_vehicles) bind(planning_two_joints) bind(planning_fields)     \
    bind(dynamics_simulation) bind(trajectory) bind(trajectory_timing) bind(trajectory_cartesian)           \
    bind(localization_graph) bind(maps_sensing) bind(localization_search) bind(localization_particles)      \
    bind(localization_histogram)                                                                            \
    bind(localization_scans) bind(localization_landmarks) bind(localization_incremental)
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

// A raw entry for a table of methods.
template <class F>
PyCFunction as_method(F* f) {
    return reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(f));
}

// The interpreter is free while a function runs.
using WithoutLock = nanobind::call_guard<nanobind::gil_scoped_release>;

// Adds a raw type to the module, for good.
PyTypeObject* add_type(nanobind::module_& m, PyType_Spec& spec, PyTypeObject* base = nullptr);

// The raw type of results, and its subclass in Python of which they are made.
class ResultType {
  public:
    // The module of the package that names the class, by the private function `entry`.
    ResultType(const char* module, const char* entry) : module_(module), entry_(entry) {}
    void add(nanobind::module_& m, PyType_Spec& spec);
    // A result of so many items, all zeros; null with an error set.
    PyObject* make(Py_ssize_t count) const;

  private:
    const char *module_, *entry_;
    PyTypeObject *base_ = nullptr, *made_of_ = nullptr;
};

// What a raw type that takes part in the search for cycles does with the references that its objects hold.
inline void free_object(PyObject* self) {
    PyTypeObject* type = Py_TYPE(self);
    type->tp_free(self);
    Py_DECREF(type);
}
template <class Object, void (*release)(PyObject*), PyObject* Object::*... references>
struct Collected {
    static int visit(PyObject* self, visitproc visit, void* arg) {
        int stopped = 0;
        const auto look = [&](PyObject* held) { stopped = stopped || !held ? stopped : visit(held, arg); };
        look(reinterpret_cast<PyObject*>(Py_TYPE(self)));
        (look(reinterpret_cast<Object*>(self)->*references), ...);
        return stopped;
    }
    static int clear(PyObject* self) {
        const auto drop = [](PyObject*& held) { Py_CLEAR(held); };
        (drop(reinterpret_cast<Object*>(self)->*references), ...);
        return 0;
    }
    static void destroy(PyObject* self) {
        PyObject_GC_UnTrack(self);
        clear(self);
        release(self);
    }
};
