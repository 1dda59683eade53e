#include "kernels/ik_subproblems.hpp"

#include "arrays.hpp"
#include "bindings.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Theta = Array<double, nb::ndim<3>>;
using Count = Array<std::int32_t, nb::shape<-1>>;
using Flags = Array<bool, nb::shape<-1>>;

template <int... shape>
using Rows = Array<const double, nb::shape<-1, shape...>>;

// Defines what calls a kernel for rows: the answers go into its last five arguments.
template <class... Inputs, class Kernel, class... Names>
void def_rows(nb::module_& m, const char* name, Kernel kernel, std::size_t most, std::size_t angles,
              const char* doc, Names... names) {
    const auto solve = [=](Inputs... inputs, Theta theta, RowOut residual, Count count, Flags exact,
                           Flags free) {
        const std::size_t n = residual.size();
        const auto has_rows = [n](const auto&... arrays) { return ((arrays.shape(0) == n) && ...); };
        if (!has_rows(theta, inputs..., count, exact, free) || theta.shape(1) != most ||
            theta.shape(2) != angles)
            throw nb::value_error("every array needs one row per problem, and theta room for all answers");
        const nb::gil_scoped_release released;
        kernel(inputs.data()..., n, {theta.data(), residual.data(), count.data(), exact.data(), free.data()});
    };
    m.def(name, solve, nb::arg(names)..., "theta"_a, "residual"_a, "count"_a, "exact"_a, "free"_a, doc);
}

}  // namespace

void bind_ik_subproblems(nb::module_& m) {
    using namespace cspace::kernels;
    def_rows<Vectors, Vectors, Vectors>(m, "subproblem_1", subproblem_1_n, 1, 1,
                                        "Subproblem 1 for rows (n, 3), answers written into the last five.",
                                        "k", "p1", "p2");
    def_rows<Vectors, Vectors, Vectors, Vectors>(
        m, "subproblem_2", subproblem_2_n, 2, 2,
        "Subproblem 2 for rows (n, 3), answers written into the last five.", "k1", "k2", "p1", "p2");
    def_rows<Vectors, Vectors, Vectors, Row>(
        m, "subproblem_3", subproblem_3_n, 2, 1,
        "Subproblem 3 for rows (n, 3) and d (n,), answers written into the last five.", "k", "p1", "p2", "d");
    def_rows<Vectors, Vectors, Vectors, Row>(
        m, "subproblem_4", subproblem_4_n, 2, 1,
        "Subproblem 4 for rows (n, 3) and d (n,), answers written into the last five.", "h", "k", "p", "d");
    def_rows<Rows<5, 3>, Rows<3, 3>>(
        m, "subproblem_5", subproblem_5_n, 4, 3,
        "Subproblem 5 for points (n, 5, 3) and axes (n, 3, 3), answers written into the last five.", "points",
        "axes");
    def_rows<Rows<4, 3>, Rows<4, 3>, Rows<4, 3>, Rows<2>>(
        m, "subproblem_6", subproblem_6_n, 4, 2,
        "Subproblem 6 for h, k, p (n, 4, 3) and d (n, 2), answers written into the last five.", "h", "k", "p",
        "d");
}
