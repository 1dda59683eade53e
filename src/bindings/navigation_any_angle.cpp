// The shortest path between points of a grid whose cells are not made into polygons, as a raw entry:
// _grid_any_angle(world, planner, options, start, goal) → route, or None where an end lies in no
// free cell; _grid_any_angle_trace(world, start, goal) → the arrays of its trace.
#include <chrono>
#include <new>

#include "bindings.hpp"
#include "cspace/navigation/any_angle/grid_any_angle.hpp"
#include "maps_grid.hpp"
#include "navigation_route.hpp"

namespace nb = nanobind;
using namespace cspace;
using namespace cspace::navigation;

namespace {

struct Question {
    GridWorld* world;
    double start[2], goal[2];
    Route route{};

    // 1 if all can be used, 0 if the points cannot, −1 with an error set.
    int read(PyObject* grid, PyObject* start_given, PyObject* goal_given) {
        if (!nb::isinstance<GridWorld>(grid) || !nb::inst_ready(grid)) {
            PyErr_SetString(PyExc_TypeError, "a search takes a grid");
            return -1;
        }
        world = nb::inst_ptr<GridWorld>(grid);
        if (!maps::RunMesh::fits(world->bits)) {
            PyErr_SetString(PyExc_ValueError, "a grid has too many cells for a search over runs of them");
            return -1;
        }
        return read_point(start_given, start) && read_point(goal_given, goal);
    }
    // False where an end lies in a blocked cell.
    bool answer(Trace* trace) {
        nb::gil_scoped_release free;
        GridAnyAngle search(world->bits, world->frame);
        const Point a{start[0], start[1]}, b{goal[0], goal[1]};
        const SettledInRuns from = search.settle(a), to = search.settle(b);
        if (from.runs.empty() || to.runs.empty()) return false;
        route = search.solve(a, from, b, to, &world->parts, trace, heed_interrupts);
        return true;
    }
};

PyObject* ask(PyObject*, PyObject* args) {
    PyObject *grid, *planner, *options, *start, *goal;
    if (!PyArg_ParseTuple(args, "OUOOO", &grid, &planner, &options, &start, &goal)) return nullptr;
    Question q;
    if (const int read = q.read(grid, start, goal); read <= 0) return read < 0 ? nullptr : Py_NewRef(Py_None);
    try {
        const auto began = std::chrono::steady_clock::now();
        if (!q.answer(nullptr)) Py_RETURN_NONE;
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
        return make_route(grid, planner, options == Py_None ? nullptr : options, q.start, q.goal, q.route,
                          took.count());
    } catch (const std::bad_alloc&) {
        return refuse_memory(q.world->bits);
    } catch (nb::python_error& raised) {
        raised.restore();
        return nullptr;
    }
}

PyObject* retrace(PyObject*, PyObject* args) {
    PyObject *grid, *start, *goal;
    if (!PyArg_ParseTuple(args, "OOO", &grid, &start, &goal)) return nullptr;
    Question q;
    Trace trace;
    try {
        const int read = q.read(grid, start, goal);
        if (read < 0) return nullptr;
        if (read > 0) q.answer(&trace);
        return trace_arrays(trace);
    } catch (const std::bad_alloc&) {
        return refuse_memory(q.world->bits);
    } catch (nb::python_error& raised) {
        raised.restore();
        return nullptr;
    }
}

PyMethodDef methods[] = {{"_grid_any_angle", ask, METH_VARARGS, nullptr},
                         {"_grid_any_angle_trace", retrace, METH_VARARGS, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_any_angle(nb::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
}
