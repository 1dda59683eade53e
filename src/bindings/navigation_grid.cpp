// Occupancy grids and the searches over them. The search of one query is a C-level entry, as it may take a
// microsecond; the interpreter is free meanwhile where the grid is not small.
#include "library/navigation_grid.hpp"

#include <utility>

#include "maps_grid.hpp"
#include "maps_points.hpp"
#include "navigation_route.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

using Bytes = Array<const std::uint8_t, nb::ndim<2>>;
using BytesOut = Array<std::uint8_t, nb::ndim<2>>;

void new_grid(GridWorld* at, Bytes blocked, double resolution, double x, double y) {
    new (at) GridWorld(blocked.data(), int(blocked.shape(0)), int(blocked.shape(1)), resolution, {x, y});
}
void unpack(const GridWorld& world, BytesOut into) {
    if (int(into.shape(0)) != world.rows() || int(into.shape(1)) != world.columns())
        throw nb::value_error("the array must have the shape of the grid");
    world.unpack(into.data());
}
// Which points (k, 2) lie in free cells or on their borders.
void free_points(const GridWorld& world, Points points, Array<std::uint8_t, nb::ndim<1>> into) {
    if (into.shape(0) != points.shape(0)) throw nb::value_error("into must have one entry per point");
    std::uint8_t* out = into.data();
    for (const Point p : points_of(points)) *out++ = world.locate(p).state == 0;
}
double path_least(const GridWorld& world, Points path) {
    const nb::gil_scoped_release free;
    return world.path_clearance(points_of(path));
}
nb::tuple locate(const GridWorld& world, double x, double y) {
    const auto [state, row, column] = world.locate({x, y});
    return nb::make_tuple(state, row, column);
}

constexpr std::size_t small_grid =
    1 << 14;  // cells; a search of so few is no longer than a change of threads

bool read_weight(PyObject* item, double& weight) {
    weight = PyFloat_AsDouble(item);
    return !(weight == -1 && PyErr_Occurred());
}

// Reads world, start, goal, planner, options, kind, corners, metric, g_weight, h_weight, bound, costs,
// least_cost: 1 if all can be used, 0 if the points cannot (which Python explains), -1 with an error set.
int read_question(PyObject* const* args, Py_ssize_t count, GridWorld*& world, GridQuestion& q) {
    if (count != 13 || !PyUnicode_Check(args[3])) {
        PyErr_SetString(PyExc_TypeError, "expected a grid, two points, a name and ten settings");
        return -1;
    }
    if (!(world = grid_of(args[0]))) return -1;
    q.planner = int(PyLong_AsLong(args[5]));
    q.corners = int(PyLong_AsLong(args[6]));
    q.metric = int(PyLong_AsLong(args[7]));
    q.costs = nullptr;
    if (!read_weight(args[8], q.g_weight) || !read_weight(args[9], q.h_weight) ||
        !read_weight(args[10], q.bound) || !read_weight(args[12], q.least_cost) || PyErr_Occurred())
        return -1;
    if (!q.is_known()) {
        PyErr_SetString(PyExc_ValueError, "unknown planner, corner rule or metric");
        return -1;
    }
    if (args[11] != Py_None) {
        auto* array = reinterpret_cast<PyArrayObject*>(args[11]);
        if (!PyArray_Check(args[11]) || PyArray_TYPE(array) != NPY_DOUBLE || !PyArray_ISCARRAY_RO(array) ||
            PyArray_NDIM(array) != 2 || PyArray_DIM(array, 0) != world->rows() ||
            PyArray_DIM(array, 1) != world->columns()) {
            PyErr_SetString(PyExc_TypeError,
                            "costs must be a contiguous float64 array of the shape of the grid");
            return -1;
        }
        q.costs = static_cast<const double*>(PyArray_DATA(array));
    }
    return read_point(args[1], q.start) && read_point(args[2], q.goal);
}

// Calls find() without the interpreter where the grid is not small.
template <class Find>
bool find_freely(const GridWorld& world, const Find& find) {
    if (world.cells() <= small_grid) return find();
    const nb::gil_scoped_release free;
    return find();
}

// What backs the verdict where path and length do not say it: what the way costs, and a bound below the best.
PyObject* evidence_of(const GridFinding& finding, const GridQuestion& q, double side) {
    if (finding.parts) return Py_BuildValue("{s:L}", "parts", static_cast<long long>(finding.parts));
    if (!finding.found || !q.has_bounds()) Py_RETURN_NONE;
    return Py_BuildValue("{s:d,s:d}", "cost", side * finding.cost, "at_least", side * finding.least);
}

// _grid_route(…) → Route, or None if start or goal is no point in a free cell.
PyObject* grid_route(PyObject*, PyObject* const* args, Py_ssize_t count) {
    GridWorld* world;
    GridQuestion q;
    const int read = read_question(args, count, world, q);
    if (read < 0) return nullptr;
    if (read == 0) Py_RETURN_NONE;
    // Its memory is kept from one query to the next. Making the route may collect garbage and so run any
    // code, another query too, which then finds it empty.
    thread_local GridFinding kept;
    GridFinding finding = std::move(kept);
    return search_grid(*world, [&]() -> PyObject* {
        const Watch watch;
        if (!find_freely(*world, [&] { return find_grid_route(*world, q, heed_interrupts, finding); }))
            Py_RETURN_NONE;
        PyObject* made =
            make_route(args[0], args[3], args[4], q.start, q.goal, finding.route, watch.seconds());
        PyObject* evidence = made ? evidence_of(finding, q, world->resolution()) : nullptr;
        kept = std::move(finding);
        if (evidence != Py_None) return add_evidence(made, evidence);
        Py_DECREF(evidence);
        return made;
    });
}

// _grid_order(…) → (row, column) of each cell settled and of its parent (k, 4), and g (k,) [m or m · cost].
PyObject* grid_order(PyObject*, PyObject* const* args, Py_ssize_t count) {
    GridWorld* world;
    GridQuestion q;
    const int read = read_question(args, count, world, q);
    if (read < 0) return nullptr;
    if (read == 0) Py_RETURN_NONE;
    return search_grid(*world, [&]() -> PyObject* {
        std::vector<std::int32_t> cells;
        std::vector<double> g;
        if (!find_freely(*world, [&] { return list_settled_cells(*world, q, heed_interrupts, cells, g); }))
            Py_RETURN_NONE;
        return Py_BuildValue("NN", rows_of(cells, 4, NPY_INT32), rows_of(g, 1, NPY_DOUBLE));
    });
}

PyMethodDef methods[] = {{"_grid_route", fast(grid_route), METH_FASTCALL, nullptr},
                         {"_grid_order", fast(grid_order), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

}  // namespace

void bind_navigation_grid(nb::module_& m) {
    nb::class_<GridWorld>(m, "GridBase", "The compiled half of cspace.maps.OccupancyGrid.")
        .def("__init__", new_grid, "blocked"_a, "resolution"_a, "x"_a, "y"_a)
        .def(nb::init<const GridWorld&, double, bool>(), "other"_a, "radius"_a, "from_centers"_a,
             nb::call_guard<nb::gil_scoped_release>())
        .def("_unpack", unpack, "into"_a, "Writes a byte per cell.")
        .def("_free", free_points, "points"_a, "into"_a, "Writes 1 for points in free cells.")
        .def("_path_clearance", path_least, "path"_a, "The least distance from a path to a blocked cell.")
        .def("_locate", locate, "x"_a, "y"_a, "Place, row and column of a point.")
        .def_prop_ro("rows", &GridWorld::rows, "Number of rows.")
        .def_prop_ro("columns", &GridWorld::columns, "Number of columns.")
        .def_prop_ro("resolution", &GridWorld::resolution, "Side of a cell [m].")
        .def_prop_ro("_x", [](const GridWorld& world) { return world.origin().x; })
        .def_prop_ro("_y", [](const GridWorld& world) { return world.origin().y; })
        .def_prop_ro("blocked_cells", &GridWorld::count_blocked, "How many cells are blocked.")
        .def_prop_ro("_corners", &GridWorld::count_corners)
        .def_prop_ro("nbytes", &GridWorld::bytes,
                     "Memory that the cells, and their parts if a search has asked for them, take [bytes].");
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
}
