// How planners' bindings reach the compiled half of an OccupancyGrid, and what searches over it may raise.
#pragma once

#include <nanobind/nanobind.h>

#include <new>

#include "library/maps_grid.hpp"

using cspace::maps::GridWorld;

// The grid behind a Python object; null, with an error set, for other objects.
inline GridWorld* grid_of(PyObject* value) {
    if (nanobind::isinstance<GridWorld>(value) && nanobind::inst_ready(value))
        return nanobind::inst_ptr<GridWorld>(value);
    PyErr_SetString(PyExc_TypeError, "the first argument must be a grid");
    return nullptr;
}

// For searches that run long: raises what Python's signal handlers raise, Ctrl-C among it. Any code may run
// in them.
inline void heed_interrupts() {
    nanobind::gil_scoped_acquire held;
    if (PyErr_CheckSignals()) throw nanobind::python_error();
}

// What a raw entry returns whose search may throw.
template <class Search>
PyObject* search_grid(const GridWorld& grid, const Search& search) {
    try {
        return search();
    } catch (const std::bad_alloc&) {
        return PyErr_Format(PyExc_MemoryError,
                            "out of memory in a search over %d x %d cells, which needs up to 100 bytes per "
                            "expanded cell; use larger cells",
                            grid.rows(), grid.columns());
    } catch (const std::invalid_argument& refused) {
        PyErr_SetString(PyExc_ValueError, refused.what());
    } catch (nanobind::python_error& raised) {
        raised.restore();
    }
    return nullptr;
}
