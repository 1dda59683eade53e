// How an arm is solved, as plain objects: see library/ik_description.hpp.
#include "library/ik_description.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "ik.hpp"

namespace nb = nanobind;
using namespace cspace;

namespace {

nb::object to_python(const std::string& json) {
    return nb::module_::import_("json").attr("loads")(nb::str(json.c_str()));
}

// None for an object that is not a solver.
nb::object describe_geometry(nb::handle object) {
    SolverArgument solver;
    return solver.read(object.ptr()) ? to_python(ik::arm_geometry(solver.arm())) : nb::none();
}

nb::object describe_numbers(SolverArgument solver) {
    if (!solver.arm().room) throw nb::type_error("_ik_numbers takes a solver without redundant joints");
    const auto [kind, plan] = ik::plan_numbers(solver.arm());
    return nb::make_tuple(kind, to_python(plan));
}

double compute_determinant(SolverArgument solver, const std::vector<double>& goal, int formulation,
                           double a0) {
    if (!ik::has_hidden_determinant(solver.arm()) || goal.size() != 16)
        throw nb::type_error("_ik_determinant takes a general arm and the 16 numbers of a goal");
    return ik::hidden_determinant(solver.arm(), goal.data(), formulation, a0);
}

}  // namespace

void bind_ik_description(nb::module_& m) {
    m.def(
        "_ik_numbers", &describe_numbers,
        "How the arm of a solver is solved (closed, general, few_joints, any) and the numbers of its plan.");
    m.def("_ik_geometry", &describe_geometry, "What the classification of an arm saw.");
    m.def("_ik_determinant", &compute_determinant, "The determinant of a general arm at one hidden angle.");
}
