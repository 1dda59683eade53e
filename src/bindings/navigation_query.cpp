#include "navigation_query.hpp"

#include <new>
#include <stdexcept>

using cspace::Point;
using cspace::maps::GridWorld;

namespace {

constexpr const char* names[] = {"start", "goal"};

}  // namespace

bool read_ends(PyObject* world, PyObject* const* given, Point (&ends)[2]) {
    if (read_numbers(given[0], &ends[0].x, 2) && read_numbers(given[1], &ends[1].x, 2)) return true;
    for (int k = 0; k < 2; ++k) {
        PyObject* checked = PyObject_CallMethod(world, "check_free", "Os", given[k], names[k]);
        const bool is_point = checked && read_numbers(checked, &ends[k].x, 2);
        Py_XDECREF(checked);
        if (is_point) continue;
        if (!PyErr_Occurred()) PyErr_SetString(PyExc_TypeError, "world.check_free must return a point (2,)");
        return false;
    }
    return true;
}

PyObject* refuse_ends(PyObject* world, const Point (&ends)[2]) {
    for (int k = 0; k < 2; ++k) {
        PyObject* checked = PyObject_CallMethod(world, "check_free", "(dd)s", ends[k].x, ends[k].y, names[k]);
        if (!checked) return nullptr;
        Py_DECREF(checked);
    }
    PyErr_SetString(PyExc_RuntimeError, "start or goal is free for world.check_free, but not for the search");
    return nullptr;
}

PyObject* translate_exception(PyObject* world) {
    try {
        throw;
    } catch (const std::bad_alloc&) {
        if (!nanobind::isinstance<GridWorld>(world) || !nanobind::inst_ready(world)) return PyErr_NoMemory();
        const GridWorld& grid = *nanobind::inst_ptr<GridWorld>(world);
        return PyErr_Format(PyExc_MemoryError,
                            "out of memory in a search over %d x %d cells, which needs up to 100 bytes per "
                            "expanded cell; use larger cells",
                            grid.rows, grid.columns);
    } catch (const std::invalid_argument& refused) {
        PyErr_SetString(PyExc_ValueError, refused.what());
        return nullptr;
    } catch (...) {
        return or_error([]() -> PyObject* { throw; });
    }
}
