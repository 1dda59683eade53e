#include "kernels/ik_subproblems.hpp"

#include "arrays.hpp"
#include "bindings.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Theta = Array<double, nb::ndim<3>>;
using Count = Array<std::int32_t, nb::shape<-1>>;
using Flags = Array<bool, nb::shape<-1>>;

// The kernels write a row per problem into every array of the answer.
template <class... Inputs>
void same_rows(const Theta& theta, std::size_t most, std::size_t angles, std::size_t rows,
               const Inputs&... arrays) {
    if (theta.shape(0) != rows || theta.shape(1) != most || theta.shape(2) != angles ||
        ((arrays.shape(0) != rows) || ...))
        throw nb::value_error("every array needs one row per problem, and theta room for all answers");
}

cspace::ik::SubproblemAnswers answers(Theta& theta, RowOut& residual, Count& count, Flags& exact,
                                      Flags& free) {
    return {theta.data(), residual.data(), count.data(), exact.data(), free.data()};
}

}  // namespace

#define ANSWERS_OUT Theta theta, RowOut residual, Count count, Flags exact, Flags free
#define ANSWERS_ARGS "theta"_a, "residual"_a, "count"_a, "exact"_a, "free"_a
#define SOLVE(kernel, ...)                                         \
    const auto out = answers(theta, residual, count, exact, free); \
    nb::gil_scoped_release released;                               \
    cspace::kernels::kernel(__VA_ARGS__, residual.size(), out)

void bind_ik_subproblems(nb::module_& m) {
    m.def(
        "subproblem_1",
        [](Vectors k, Vectors p1, Vectors p2, ANSWERS_OUT) {
            same_rows(theta, 1, 1, residual.size(), k, p1, p2, count, exact, free);
            SOLVE(subproblem_1_n, k.data(), p1.data(), p2.data());
        },
        "k"_a, "p1"_a, "p2"_a, ANSWERS_ARGS,
        "Subproblem 1 for rows (n, 3), answers written into the last five.");
    m.def(
        "subproblem_2",
        [](Vectors k1, Vectors k2, Vectors p1, Vectors p2, ANSWERS_OUT) {
            same_rows(theta, 2, 2, residual.size(), k1, k2, p1, p2, count, exact, free);
            SOLVE(subproblem_2_n, k1.data(), k2.data(), p1.data(), p2.data());
        },
        "k1"_a, "k2"_a, "p1"_a, "p2"_a, ANSWERS_ARGS,
        "Subproblem 2 for rows (n, 3), answers written into the last five.");
    m.def(
        "subproblem_3",
        [](Vectors k, Vectors p1, Vectors p2, Row d, ANSWERS_OUT) {
            same_rows(theta, 2, 1, residual.size(), k, p1, p2, d, count, exact, free);
            SOLVE(subproblem_3_n, k.data(), p1.data(), p2.data(), d.data());
        },
        "k"_a, "p1"_a, "p2"_a, "d"_a, ANSWERS_ARGS,
        "Subproblem 3 for rows (n, 3) and d (n,), answers written into the last five.");
    m.def(
        "subproblem_4",
        [](Vectors h, Vectors k, Vectors p, Row d, ANSWERS_OUT) {
            same_rows(theta, 2, 1, residual.size(), h, k, p, d, count, exact, free);
            SOLVE(subproblem_4_n, h.data(), k.data(), p.data(), d.data());
        },
        "h"_a, "k"_a, "p"_a, "d"_a, ANSWERS_ARGS,
        "Subproblem 4 for rows (n, 3) and d (n,), answers written into the last five.");
    m.def(
        "subproblem_5",
        [](Array<const double, nb::shape<-1, 5, 3>> points, Array<const double, nb::shape<-1, 3, 3>> axes,
           ANSWERS_OUT) {
            same_rows(theta, 4, 3, residual.size(), points, axes, count, exact, free);
            SOLVE(subproblem_5_n, points.data(), axes.data());
        },
        "points"_a, "axes"_a, ANSWERS_ARGS,
        "Subproblem 5 for points (n, 5, 3) and axes (n, 3, 3), answers written into the last five.");
    m.def(
        "subproblem_6",
        [](Array<const double, nb::shape<-1, 4, 3>> h, Array<const double, nb::shape<-1, 4, 3>> k,
           Array<const double, nb::shape<-1, 4, 3>> p, Array<const double, nb::shape<-1, 2>> d, ANSWERS_OUT) {
            same_rows(theta, 4, 2, residual.size(), h, k, p, d, count, exact, free);
            SOLVE(subproblem_6_n, h.data(), k.data(), p.data(), d.data());
        },
        "h"_a, "k"_a, "p"_a, "d"_a, ANSWERS_ARGS,
        "Subproblem 6 for h, k, p (n, 4, 3) and d (n, 2), answers written into the last five.");
}
