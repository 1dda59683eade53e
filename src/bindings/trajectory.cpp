// Motions from state to state.
#include <nanobind/stl/tuple.h>

#include <cmath>
#include <tuple>

#include "arrays.hpp"
#include "arrays_in_place.hpp"
#include "bindings.hpp"
#include "library/trajectory_states.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace cspace::trajectory;

namespace {

using States = Array<const double, nb::shape<-1, 2, 3, -1>>;
using OneState = Array<const double, nb::shape<2, 3, -1>>;
using MatrixOut = Array<double, nb::ndim<2>>;
using CubeOut = Array<double, nb::ndim<3>>;
using VerdictsOut = Array<std::int32_t, nb::ndim<1>>;

constexpr int modes = 3;

void solve(const States& states, const Matrix& limits, const Row& durations, double cycle, int mode,
           int threads, VerdictsOut verdict, RowOut duration, MatrixOut shortest, CubeOut motions) {
    const std::size_t rows = states.shape(0), dof = states.shape(3);
    require_sizes(has_shape(limits, 5u, dof) && has_shape(durations, rows) && has_shape(verdict, rows) &&
                  has_shape(duration, rows) && has_shape(shortest, rows, dof) &&
                  has_shape(motions, numbers_of_motion(), rows, dof) && mode >= 0 && mode < modes);
    const StateProblems problems{rows,
                                 dof,
                                 states.data(),
                                 limits.data(),
                                 durations.data(),
                                 cycle,
                                 Synchronize(mode),
                                 verdict.data(),
                                 duration.data(),
                                 shortest.data(),
                                 motions.data()};
    const nb::gil_scoped_release release;
    solve_states(problems, threads);
}

std::tuple<Doubles, Doubles, Doubles> make_arrays(const OneState& states, const Matrix& limits,
                                                  const Row& shortest, const Matrix& motions, double duration,
                                                  int mode) {
    const std::size_t dof = states.shape(2);
    require_sizes(has_shape(limits, 5u, dof) && has_shape(shortest, dof) &&
                  has_shape(motions, numbers_of_motion(), dof) && mode >= 0 && mode < modes);
    const StatePieces made = make_pieces({dof, states.data(), limits.data(), shortest.data(), motions.data(),
                                          duration, Synchronize(mode)});
    const npy_intp n = npy_intp(dof), pieces = npy_intp(made.pieces);
    return {Doubles({n, pieces + 1}, made.knots.data()), Doubles({n, pieces, 4}, made.coefficients.data()),
            Doubles({n, pieces}, made.origins.data())};
}

}  // namespace

void bind_trajectory(nb::module_& m) {
    m.attr("NUMBERS_OF_MOTION") = int(numbers_of_motion());
    m.def("solve_states", &solve, "states"_a, "limits"_a, "durations"_a, "cycle"_a, "mode"_a, "threads"_a,
          "verdict"_a, "duration"_a, "shortest"_a, "motions"_a,
          "Motions of axes from state to state.\n\nstates (rows, 2, 3, dof): q, qd, qdd at the start and the "
          "goal. limits (5, dof): highest and lowest velocity and acceleration, jerk. durations (rows,): NaN "
          "for the shortest. mode: 0 in time, 1 in phase, 2 each axis alone. Writes verdict (rows,): 0 found, "
          "1 another duration, 2 not parallel; duration (rows,), shortest (rows, dof), motions "
          "(NUMBERS_OF_MOTION, rows, dof).");
    m.def("make_pieces", &make_arrays, "states"_a, "limits"_a, "shortest"_a, "motions"_a, "duration"_a,
          "mode"_a,
          "Polynomials of one motion: knots (dof, k + 1), coefficients (dof, k, 4) and origins (dof, k).");
}
