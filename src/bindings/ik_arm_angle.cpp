// Arms with two spherical joints by the swivel of their elbow: plain checked arrays in, filled arrays out.
#include "library/ik_arm_angle.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "ik.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

using ik::SwivelSolver;

void make_solver(SwivelSolver* at, SolverArgument solver) {
    if (solver.core().chain().n != 7) throw nb::value_error("a swivel needs seven joints");
    new (at) SwivelSolver(solver.core().chain());
}

void require_swivel(const SwivelSolver& arm, bool sizes_match) {
    if (!arm.serves()) throw nb::value_error("the arm has no swivel");
    if (!sizes_match) throw nb::value_error("arrays of matching sizes are needed");
}

void solve_rows(const SwivelSolver& arm, Goals goals, Row swivels, Array<double, nb::shape<-1, 8, 7>> q) {
    const std::size_t n = swivels.shape(0), N = goals.shape(0);
    require_swivel(arm, (N == 1 || N == n) && q.shape(0) == n);
    const nb::gil_scoped_release release;
    arm.solve(goals.data(), N == 1, swivels.data(), n, q.data());
}

void swivels(const SwivelSolver& arm, Array<const double, nb::shape<-1, 7>> q,
             Array<double, nb::ndim<1>> out) {
    require_swivel(arm, out.shape(0) == q.shape(0));
    for (std::size_t i = 0; i < q.shape(0); ++i) out.data()[i] = arm.swivel_at(q.data() + 7 * i);
}

}  // namespace

void bind_ik_arm_angle(nb::module_& m) {
    nb::class_<SwivelSolver>(m, "SwivelSolver", "Arms with two spherical joints and an elbow between them.")
        .def("__init__", &make_solver, "solver"_a, "Of an arm of seven revolute joints.")
        .def_prop_ro("serves", &SwivelSolver::serves, "Whether axes 1, 2, 3 and 5, 6, 7 meet.")
        .def("solve", &solve_rows, "goals"_a, "swivels"_a, "q"_a, "Every solution at given swivels.")
        .def("swivels", &swivels, "q"_a, "out"_a, "The swivel of configurations.");
}
