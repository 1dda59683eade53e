// Occupancy grids and the searches over them. The search of one query is a C-level entry, as it may take a
// microsecond; the interpreter is free meanwhile where the grid is not small.
#include <chrono>
#include <memory>
#include <new>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/maps/grid_corners.hpp"
#include "cspace/maps/grid_inflation.hpp"
#include "cspace/maps/path_clearance.hpp"
#include "cspace/navigation/grid/grid_route.hpp"
#include "maps_grid.hpp"
#include "navigation_route.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

using Bytes = Array<const std::uint8_t, nb::ndim<2>>;
using BytesOut = Array<std::uint8_t, nb::ndim<2>>;

void new_grid(GridWorld* at, Bytes blocked, double resolution, double x, double y) {
    new (at) GridWorld{{blocked.data(), int(blocked.shape(0)), int(blocked.shape(1))}, {resolution, {x, y}}};
}
void new_inflated(GridWorld* at, const GridWorld& other, double radius, bool from_centers) {
    nb::gil_scoped_release free;
    new (at)
        GridWorld{maps::inflated(other.bits, radius / other.frame.resolution, from_centers), other.frame};
}
void unpack(const GridWorld& world, BytesOut into) {
    if (int(into.shape(0)) != world.bits.rows() || int(into.shape(1)) != world.bits.columns())
        throw nb::value_error("an array of the shape of the grid");
    world.bits.unpack(into.data());
}
// Which points (k, 2) lie in free cells or on their borders.
void free_points(const GridWorld& world, Array<const double, nb::shape<-1, 2>> points,
                 Array<std::uint8_t, nb::ndim<1>> into) {
    if (into.shape(0) != points.shape(0)) throw nb::value_error("as many answers as points");
    for (std::size_t k = 0; k < points.shape(0); ++k) {
        maps::Cell cell;
        const Point p = {points(k, 0), points(k, 1)};
        into(k) = world.frame.locate(world.bits, p, cell) == maps::CellState::free;
    }
}
// The least distance from a path (m, 2) to a blocked cell or the border [m].
double path_least(const GridWorld& world, Array<const double, nb::shape<-1, 2>> path) {
    nb::gil_scoped_release free;
    return maps::path_clearance({reinterpret_cast<const Point*>(path.data()), path.shape(0)}, world.bits,
                                world.frame);
}
// (place, row, column); place: 0 free, 1 blocked, 2 outside.
nb::tuple locate(const GridWorld& world, double x, double y) {
    maps::Cell cell = {-1, -1};
    const maps::CellState place = world.frame.locate(world.bits, {x, y}, cell);
    return nb::make_tuple(int(place), cell.row, cell.column);
}

// What a thread's searches remember. More than so many bytes are given back after a query, which took far
// longer than to ask for them again.
GridScratch& scratch() {
    thread_local GridScratch one;
    return one;
}
constexpr std::size_t kept_bytes = std::size_t(32) << 20;
constexpr std::uint32_t small_grid =
    1 << 14;  // cells; a search of so few is no longer than a change of threads

struct Ask {
    GridWorld* world;
    Point start, goal;
    maps::Cell from, to;
    PyObject *planner, *options;
    GridQuery query;
};

bool read_weight(PyObject* item, double& weight) {
    weight = PyFloat_AsDouble(item);
    return !(weight == -1 && PyErr_Occurred());
}

// Reads world, start, goal, planner, options, kind, corners, metric, g_weight, h_weight, bound, costs,
// least_cost: 1 if all can be used, 0 if the points cannot (which Python explains), -1 with an error set.
int read_ask(PyObject* const* args, Py_ssize_t count, Ask& ask) {
    if (count != 13 || !nb::isinstance<GridWorld>(args[0]) || !nb::inst_ready(args[0]) ||
        !PyUnicode_Check(args[3])) {
        PyErr_SetString(PyExc_TypeError, "a search takes a grid, two points, a name and its ten settings");
        return -1;
    }
    ask.world = nb::inst_ptr<GridWorld>(args[0]);
    ask.planner = args[3];
    ask.options = args[4] == Py_None ? nullptr : args[4];
    const long kind = PyLong_AsLong(args[5]), corners = PyLong_AsLong(args[6]),
               metric = PyLong_AsLong(args[7]);
    GridQuery& query = ask.query;
    if (!read_weight(args[8], query.g_weight) || !read_weight(args[9], query.h_weight) ||
        !read_weight(args[10], query.bound) || !read_weight(args[12], query.least_cost) || PyErr_Occurred())
        return -1;
    if (kind < 0 || kind > long(GridPlanner::waves) || corners < 0 || corners >= corner_rules || metric < 0 ||
        metric > long(Metric::euclidean)) {
        PyErr_SetString(PyExc_ValueError, "a planner, corner rule or metric that the core does not know");
        return -1;
    }
    query.planner = static_cast<GridPlanner>(kind);
    query.corners = static_cast<Corners>(corners);
    query.metric = static_cast<Metric>(metric);
    if (args[11] != Py_None) {
        auto* array = reinterpret_cast<PyArrayObject*>(args[11]);
        if (!PyArray_Check(args[11]) || PyArray_TYPE(array) != NPY_DOUBLE || !PyArray_ISCARRAY_RO(array) ||
            PyArray_NDIM(array) != 2 || PyArray_DIM(array, 0) != ask.world->bits.rows() ||
            PyArray_DIM(array, 1) != ask.world->bits.columns()) {
            PyErr_SetString(PyExc_TypeError, "costs as a contiguous float64 array of the shape of the grid");
            return -1;
        }
        query.costs = static_cast<const double*>(PyArray_DATA(array));
    }
    double ends[4];
    if (!read_point(args[1], ends) || !read_point(args[2], ends + 2)) return 0;
    ask.start = {ends[0], ends[1]};
    ask.goal = {ends[2], ends[3]};
    const GridWorld& world = *ask.world;
    return world.frame.locate(world.bits, ask.start, ask.from) == maps::CellState::free &&
           world.frame.locate(world.bits, ask.goal, ask.to) == maps::CellState::free;
}

// The scratch of this thread, or, for a search that a signal handler runs amid another one, its own.
class Borrowed {
  public:
    Borrowed() {
        if (depth()++ > 0) own_ = std::make_unique<GridScratch>();
    }
    ~Borrowed() {
        if (--depth() == 0 && scratch().bytes() > kept_bytes) scratch().release();
    }
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;
    GridScratch& get() { return own_ ? *own_ : scratch(); }

  private:
    static int& depth() {
        thread_local int one = 0;
        return one;
    }
    std::unique_ptr<GridScratch> own_;
};

void run(const Ask& ask, GridAnswer& answer, Route& route) {
    Borrowed borrowed;
    find_way(ask.world->bits, ask.from, ask.to, ask.query, borrowed.get(), answer, &ask.world->parts,
             heed_interrupts);
    draw_route(ask.world->frame, ask.start, ask.goal, answer, route);
}
void run_freely(const Ask& ask, GridAnswer& answer, Route& route) {
    if (ask.world->bits.numbers() <= small_grid) return run(ask, answer, route);
    nb::gil_scoped_release free;
    run(ask, answer, route);
}

// What backs the verdict where path and length do not say it: what the way costs, and a bound below the best.
PyObject* evidence_of(const Ask& ask, const GridAnswer& answer) {
    const double side = ask.world->frame.resolution;
    if (answer.parts) return Py_BuildValue("{s:L}", "parts", static_cast<long long>(answer.parts));
    if (!answer.found || (!ask.query.costs && ask.query.planner != GridPlanner::focal)) Py_RETURN_NONE;
    return Py_BuildValue("{s:d,s:d}", "cost", side * answer.cost, "at_least", side * answer.least);
}

// _grid_route(…) → Route, or None if start or goal is no point in a free cell.
PyObject* grid_route(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Ask ask;
    const int read = read_ask(args, count, ask);
    if (read < 0) return nullptr;
    if (read == 0) Py_RETURN_NONE;
    // Their memory is kept from one query to the next. Making the route may collect garbage and so run any
    // code, another query too, which then finds them empty.
    thread_local GridAnswer kept_answer;
    thread_local Route kept_route;
    GridAnswer answer = std::move(kept_answer);
    Route route = std::move(kept_route);
    try {
        const auto began = std::chrono::steady_clock::now();
        run_freely(ask, answer, route);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
        const double ends[4] = {ask.start.x, ask.start.y, ask.goal.x, ask.goal.y};
        PyObject* made = make_route(args[0], ask.planner, ask.options, ends, ends + 2, route, took.count());
        if (made) {
            PyObject* evidence = evidence_of(ask, answer);
            if (evidence == nullptr) return Py_DECREF(made), nullptr;
            if (evidence != Py_None)
                reinterpret_cast<RouteObject*>(made)->evidence = evidence;
            else
                Py_DECREF(evidence);
        }
        kept_answer = std::move(answer);
        kept_route = std::move(route);
        return made;
    } catch (const std::bad_alloc&) {
        return refuse_memory(ask.world->bits);
    } catch (nb::python_error& raised) {
        raised.restore();
        return nullptr;
    }
}

// _grid_order(…) → (row, column) of each cell settled and of its parent (k, 4), and g (k,) [m or m · cost].
PyObject* grid_order(PyObject*, PyObject* const* args, Py_ssize_t count) {
    Ask ask;
    const int read = read_ask(args, count, ask);
    if (read < 0) return nullptr;
    if (read == 0) Py_RETURN_NONE;
    try {
        GridAnswer answer;
        std::vector<Settled> settled;
        answer.settled = &settled;
        Route route;
        run_freely(ask, answer, route);
        npy_intp shape[2] = {npy_intp(settled.size()), 4};
        PyObject* cells = PyArray_SimpleNew(2, shape, NPY_INT32);
        PyObject* lengths = PyArray_SimpleNew(1, shape, NPY_DOUBLE);
        if (!cells || !lengths) return Py_XDECREF(cells), Py_XDECREF(lengths), nullptr;
        auto* cell = static_cast<std::int32_t*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(cells)));
        auto* g = static_cast<double*>(PyArray_DATA(reinterpret_cast<PyArrayObject*>(lengths)));
        for (const Settled& one : settled) {
            for (const int number : {one.cell.row, one.cell.column, one.parent.row, one.parent.column})
                *cell++ = number;
            *g++ = ask.world->frame.resolution * one.g;
        }
        return Py_BuildValue("NN", cells, lengths);
    } catch (const std::bad_alloc&) {
        return refuse_memory(ask.world->bits);
    } catch (nb::python_error& raised) {
        raised.restore();
        return nullptr;
    }
}

template <PyObject* (*function)(PyObject*, PyObject* const*, Py_ssize_t)>
PyCFunction as_function() {
    return reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(function));
}
PyMethodDef methods[] = {{"_grid_route", as_function<grid_route>(), METH_FASTCALL, nullptr},
                         {"_grid_order", as_function<grid_order>(), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_grid(nb::module_& m) {
    nb::class_<GridWorld>(m, "GridBase", "The compiled half of cspace.maps.OccupancyGrid.")
        .def("__init__", new_grid, "blocked"_a, "resolution"_a, "x"_a, "y"_a)
        .def("__init__", new_inflated, "other"_a, "radius"_a, "from_centers"_a)
        .def("_unpack", unpack, "into"_a, "Writes a byte per cell.")
        .def("_free", free_points, "points"_a, "into"_a, "Writes 1 for points in free cells.")
        .def("_path_clearance", path_least, "path"_a, "The least distance from a path to a blocked cell.")
        .def("_locate", locate, "x"_a, "y"_a, "Place, row and column of a point.")
        .def_prop_ro(
            "rows", [](const GridWorld& world) { return world.bits.rows(); }, "Number of rows.")
        .def_prop_ro(
            "columns", [](const GridWorld& world) { return world.bits.columns(); }, "Number of columns.")
        .def_prop_ro(
            "resolution", [](const GridWorld& world) { return world.frame.resolution; },
            "Side of a cell [m].")
        .def_prop_ro("_x", [](const GridWorld& world) { return world.frame.origin.x; })
        .def_prop_ro("_y", [](const GridWorld& world) { return world.frame.origin.y; })
        .def_prop_ro(
            "blocked_cells", [](const GridWorld& world) { return world.bits.count_blocked(); },
            "How many cells are blocked.")
        .def_prop_ro("_corners", [](const GridWorld& world) { return maps::count_corners(world.bits); })
        .def_prop_ro(
            "nbytes", [](const GridWorld& world) { return world.bits.bytes() + world.parts.bytes(); },
            "Memory that the cells, and their parts if a search has asked for them, take [bytes].");
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
}
