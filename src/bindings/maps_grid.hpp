// An occupancy grid as Python holds it: cspace.maps.OccupancyGrid is the subclass of its class.
#pragma once

#include <nanobind/nanobind.h>

#include "cspace/maps/bit_grid.hpp"
#include "cspace/maps/grid_frame.hpp"
#include "cspace/maps/grid_parts.hpp"

struct GridWorld {
    cspace::maps::BitGrid bits;
    cspace::maps::GridFrame frame;
    cspace::maps::LazyParts parts{};
};

// For searches that run long: raises what Python's signal handlers raise, Ctrl-C among it. Any code may run
// in them.
inline void heed_interrupts() {
    nanobind::gil_scoped_acquire held;
    if (PyErr_CheckSignals()) throw nanobind::python_error();
}
// Sets the error of a search that found no memory.
inline PyObject* refuse_memory(const cspace::maps::BitGrid& grid) {
    return PyErr_Format(
        PyExc_MemoryError,
        "no memory is left for a search over %d x %d cells: a search takes up to 100 bytes per "
        "cell that it comes to; make the cells larger",
        grid.rows(), grid.columns());
}
