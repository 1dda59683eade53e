// Motions from state to state.
#include <cmath>

#include "arrays.hpp"
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
using PhasesOut = Array<double, nb::ndim<4>>;
using PhasesIn = Array<const double, nb::ndim<3>>;
using Counts = Array<const std::int32_t, nb::ndim<1>>;
using CountsOut = Array<std::int32_t, nb::ndim<2>>;
using VerdictsOut = Array<std::int32_t, nb::ndim<1>>;

void solve(const States& states, const Matrix& limits, const Row& durations, double cycle, int mode,
           int threads, VerdictsOut verdict, RowOut duration, MatrixOut shortest, CountsOut count,
           PhasesOut phases) {
    const std::size_t rows = states.shape(0), dof = states.shape(3), most = std::size_t(phases_of_axis());
    require_sizes(has_shape(limits, 5u, dof) && has_shape(durations, rows) && has_shape(verdict, rows) &&
                  has_shape(duration, rows) && has_shape(shortest, rows, dof) &&
                  has_shape(count, rows, dof) &&
                  has_shape(phases, rows, dof, most, std::size_t(phase_numbers)) && mode >= 0 && mode <= 2);
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
                                 count.data(),
                                 phases.data()};
    const nb::gil_scoped_release release;
    solve_states(problems, threads);
}

void fill_pieces(const OneState& states, const Counts& count, const PhasesIn& phases, double duration,
                 MatrixOut knots, CubeOut coefficients, MatrixOut origins) {
    const std::size_t dof = states.shape(2), pieces = origins.shape(1), most = std::size_t(phases_of_axis());
    bool fit = has_shape(count, dof) && has_shape(phases, dof, most, std::size_t(phase_numbers)) &&
               pieces > 0 && has_shape(knots, dof, pieces + 1) && has_shape(coefficients, dof, pieces, 4u) &&
               has_shape(origins, dof, pieces);
    for (std::size_t i = 0; fit && i < dof; ++i)
        fit = count.data()[i] >= 0 && std::size_t(count.data()[i]) <= std::min(pieces, most);
    require_sizes(fit);
    make_pieces({dof, pieces, states.data(), count.data(), phases.data(), duration, knots.data(),
                 coefficients.data(), origins.data()});
}

}  // namespace

void bind_trajectory(nb::module_& m) {
    m.attr("PHASES_OF_AXIS") = phases_of_axis();
    m.def(
        "solve_states", &solve, "states"_a, "limits"_a, "durations"_a, "cycle"_a, "mode"_a, "threads"_a,
        "verdict"_a, "duration"_a, "shortest"_a, "count"_a, "phases"_a,
        "Motions of axes from state to state.\n\nstates (rows, 2, 3, dof): q, qd, qdd at the start and the "
        "goal. "
        "limits (5, dof): highest and lowest velocity and acceleration, jerk. durations (rows,): NaN for the "
        "shortest. mode: 0 in time, 1 in phase, 2 each axis alone. Writes verdict (rows,): 0 found, 1 "
        "another "
        "duration, 2 not parallel; duration (rows,), shortest (rows, dof), count (rows, dof), phases (rows, "
        "dof, "
        "PHASES_OF_AXIS, 3).");
    m.def("fill_pieces", &fill_pieces, "states"_a, "count"_a, "phases"_a, "duration"_a, "knots"_a,
          "coefficients"_a, "origins"_a,
          "Polynomials of the phases of one motion: writes knots (dof, k + 1), coefficients (dof, k, 4) and "
          "origins "
          "(dof, k).");
}
