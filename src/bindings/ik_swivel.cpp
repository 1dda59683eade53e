// Arms with two spherical joints by the swivel of their elbow: plain checked arrays in, filled arrays out.
#include "ik_swivel.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "cspace/ik/goal.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace;

namespace {

using Seven = Array<const double, nb::shape<7, 3>>;

void make_solver(ik::SwivelArm* at, Seven axes, Seven points, Goal T_zero) {
    ik::Chain chain;
    chain.n = 7;
    for (int i = 0; i < 7; ++i) {
        const double *h = axes.data() + 3 * i, *p = points.data() + 3 * i;
        chain.axis[i] = {h[0], h[1], h[2]};
        chain.point[i] = {p[0], p[1], p[2]};
    }
    chain.tip = read_goal(T_zero.data()).T;
    new (at) ik::SwivelArm(make_swivel_arm(chain));
}

// Goal i at swivel i, or one goal at all of them: q (n, 8, 7), NaN in rows without a solution.
void solve_rows(const ik::SwivelArm& arm, Goals goals, Row swivels, Array<double, nb::shape<-1, 8, 7>> q) {
    const std::size_t n = swivels.shape(0), N = goals.shape(0);
    if (!arm.serves) throw nb::value_error("the arm has no swivel");
    if ((N != 1 && N != n) || q.shape(0) != n) throw nb::value_error("arrays of matching sizes are needed");
    const nb::gil_scoped_release release;
    const std::size_t each = N == 1 ? n : 1;
    for (std::size_t i = 0; i < N; ++i)
        kernels::swivel_solutions(arm, read_goal(goals.data() + 16 * i).T, swivels.data() + i, int(each),
                                  q.data() + 56 * i);
}

void swivels(const ik::SwivelArm& arm, Array<const double, nb::shape<-1, 7>> q,
             Array<double, nb::ndim<1>> out) {
    if (!arm.serves) throw nb::value_error("the arm has no swivel");
    if (out.shape(0) != q.shape(0)) throw nb::value_error("arrays of matching sizes are needed");
    for (std::size_t i = 0; i < q.shape(0); ++i) out.data()[i] = swivel_of(arm, q.data() + 7 * i);
}

}  // namespace

void bind_ik_swivel(nb::module_& m) {
    nb::class_<ik::SwivelArm>(m, "SwivelSolver", "Arms with two spherical joints and an elbow between them.")
        .def("__init__", &make_solver, "axes"_a, "points"_a, "T_zero"_a, "From the screws of seven turns.")
        .def_ro("serves", &ik::SwivelArm::serves, "Whether axes 1, 2, 3 and 5, 6, 7 meet.")
        .def("solve", &solve_rows, "goals"_a, "swivels"_a, "q"_a, "Every solution at given swivels.")
        .def("swivels", &swivels, "q"_a, "out"_a, "The swivel of configurations.");
}
