// Planners over fields on a grid, and what the fields hold.
#include "library/navigation_fields_grid.hpp"

#include <nanobind/stl/tuple.h>

#include "maps_points.hpp"
#include "navigation_query.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;
using namespace cspace::navigation;

namespace {

// The field; gain, rho_0, cap, all in cells; scale, weight, whether greedy, the number of the corner rule.
struct PotentialSearch : SearchOf<GridWorld> {
    static constexpr int settings = 8;
    ClearanceField* field;
    std::array<double, 7> numbers;

    bool read(const Core&, PyObject* const* args) {
        return (field = core_of<ClearanceField>(args[0])) && read_settings(args + 1, numbers);
    }
    bool find(const Core& world, Point start, Point goal, Trace* trace) {
        return field->find_potential_route(world, start, goal, numbers.data(), found, trace);
    }
};

// The field; how near to walls the front is slower [cells].
struct MarchSearch : SearchOf<GridWorld> {
    static constexpr int settings = 2;
    ClearanceField* field;
    std::array<double, 1> slow_within;
    double time = 0;

    bool read(const Core&, PyObject* const* args) {
        return (field = core_of<ClearanceField>(args[0])) && read_settings(args + 1, slow_within);
    }
    bool find(const Core& world, Point start, Point goal, Trace* trace) {
        return field->find_march_route(world, start, goal, slow_within[0], found, time, trace);
    }
    PyObject* evidence() const {
        return found.status == Status::found ? Py_BuildValue("{s:d}", "time", time) : nullptr;
    }
};

// The field, the evidence, and the seconds that making the field took.
struct HarmonicSearch : SearchOf<GridWorld> {
    static constexpr int settings = 3;
    HarmonicPotential* field;
    PyObject* told;

    bool read(const Core&, PyObject* const* args) {
        told = args[1], spent = PyFloat_AsDouble(args[2]);
        return (field = core_of<HarmonicPotential>(args[0])) && !PyErr_Occurred();
    }
    bool find(const Core& world, Point start, Point goal, Trace* trace) {
        return field->descend(world, start, goal, found, trace);
    }
    PyObject* evidence() const { return Py_NewRef(told); }
};

// The diagram; whether the widest way is wanted.
struct BrushfireSearch : SearchOf<GridWorld> {
    static constexpr int settings = 2;
    BrushfireDiagram* diagram;
    bool is_widest;
    double least_clearance = 0;

    bool read(const Core&, PyObject* const* args) {
        return is_widest = args[1] == Py_True, diagram = core_of<BrushfireDiagram>(args[0]);
    }
    bool find(const Core& world, Point start, Point goal, Trace* trace) {
        return diagram->find_route(world, start, goal, is_widest, found, least_clearance, trace);
    }
    PyObject* evidence() const {
        if (found.status != Status::found) return nullptr;
        return Py_BuildValue("{s:d}", "least_clearance", least_clearance);
    }
};

PyMethodDef methods[] = {{"_potential_a_star", fast(ask<PotentialSearch>), METH_FASTCALL, nullptr},
                         {"_fast_marching", fast(ask<MarchSearch>), METH_FASTCALL, nullptr},
                         {"_harmonic", fast(ask<HarmonicSearch>), METH_FASTCALL, nullptr},
                         {"_brushfire", fast(ask<BrushfireSearch>), METH_FASTCALL, nullptr},
                         {nullptr, nullptr, 0, nullptr}};

Numbers<double> march_times(const ClearanceField& field, const GridWorld& world, PointRow goal,
                            double slow_within) {
    std::vector<double> times;
    {
        const nb::gil_scoped_release free;
        times = field.march_times(world, point_of(goal), slow_within);
    }
    return table(std::move(times), std::size_t(world.columns()));
}

bool divide(const GridWorld& world, PointRow start, PointRow goal) {
    const nb::gil_scoped_release free;
    return walls_divide(world, point_of(start), point_of(goal));
}
void new_harmonic(HarmonicPotential* at, const GridWorld& world, const ClearanceField& clearance,
                  PointRow goal, double residual, int most_cycles) {
    const nb::gil_scoped_release free;
    new (at) HarmonicPotential(world, clearance, point_of(goal), residual, most_cycles);
}
Numbers<double> heights(const HarmonicPotential& field, const GridWorld& world) {
    return table(field.heights(world), std::size_t(world.columns()));
}

// What a diagram holds for each cell, as an array (rows, columns).
template <auto values>
auto map_of(const BrushfireDiagram& diagram) {
    return table((diagram.*values)(), std::size_t(diagram.columns()));
}
auto branches_of(const BrushfireDiagram& diagram) {
    BrushfireDiagram::Branches all = diagram.branches();
    return std::tuple(table(std::move(all.ends), 4), table(std::move(all.lengths)),
                      table(std::move(all.least)));
}

}  // namespace

void bind_navigation_fields_grid(nb::module_& m) {
    if (PyModule_AddFunctions(m.ptr(), methods) < 0) throw nb::python_error();
    m.def("_walls_divide", divide, "grid"_a, "start"_a, "goal"_a,
          "Whether walls certainly divide two points.");
    nb::class_<ClearanceField>(m, "ClearanceField",
                               "The distance of every cell of a grid to the nearest wall.")
        .def(nb::init<const GridWorld&>(), "grid"_a, nb::call_guard<nb::gil_scoped_release>())
        .def("march_times", march_times, "grid"_a, "goal"_a, "slow_within"_a,
             "When a front from the goal arrives (rows, columns) [m, over the speed].");
    nb::class_<HarmonicPotential>(m, "HarmonicField", "A harmonic potential over the cells of a grid.")
        .def("__init__", new_harmonic, "grid"_a, "clearance"_a, "goal"_a, "residual"_a, "most_cycles"_a)
        .def_prop_ro("residual", &HarmonicPotential::residual,
                     "By what share a cell is off its mean, at most.")
        .def_prop_ro("cycles", &HarmonicPotential::cycles, "Of the solver.")
        .def_prop_ro("cells", &HarmonicPotential::cells, "From which a way leads to the goal.")
        .def_prop_ro("rests", &HarmonicPotential::rests, "Cells but the goal from which no step leads down.")
        .def("heights", heights, "grid"_a, "Minus the logarithm of the chance (rows, columns).");
    nb::class_<BrushfireDiagram>(m, "BrushfireCore",
                                 "The compiled half of cspace.navigation.BrushfireDiagram.")
        .def(nb::init<const GridWorld&>(), "grid"_a, nb::call_guard<nb::gil_scoped_release>())
        .def("clearance", map_of<&BrushfireDiagram::clearance>, "Of each cell (rows, columns) [m].")
        .def("labels", map_of<&BrushfireDiagram::labels>,
             "The nearest piece of boundary of each cell (rows, columns), or -1.")
        .def("cells", map_of<&BrushfireDiagram::cells>, "A byte per cell (rows, columns): 1 in the diagram.")
        .def("branches", branches_of, "Ends (k, 4), lengths (k,) [m] and least clearances (k,) [m].")
        .def_prop_ro("pieces", &BrushfireDiagram::pieces, "How many pieces the boundary has.");
}
