// Motions from state to state.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include "arrays.hpp"
#include "arrays_in_place.hpp"
#include "bindings.hpp"
#include "library/trajectory_roots.hpp"
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

using PieceArrays = std::tuple<Doubles, Doubles, Doubles>;

PieceArrays show(const StatePieces& made, std::size_t dof) {
    const npy_intp n = npy_intp(dof), pieces = npy_intp(made.pieces);
    return {Doubles({n, pieces + 1}, made.knots.data()), Doubles({n, pieces, 4}, made.coefficients.data()),
            Doubles({n, pieces}, made.origins.data())};
}

PieceArrays make_arrays(const OneState& states, const Matrix& limits, const Row& shortest,
                        const Matrix& motions, double duration, int mode) {
    const std::size_t dof = states.shape(2);
    require_sizes(has_shape(limits, 5u, dof) && has_shape(shortest, dof) &&
                  has_shape(motions, numbers_of_motion(), dof) && mode >= 0 && mode < modes);
    const StatePieces made = make_pieces(
        {dof, states.data(), limits.data(), shortest.data(), motions.data(), duration, Synchronize(mode)});
    return show(made, dof);
}

bool is_number(nb::handle given) {
    int overflow = 0;
    if (PyFloat_Check(given.ptr())) return true;
    return PyLong_CheckExact(given.ptr()) && PyLong_AsLongLongAndOverflow(given.ptr(), &overflow) != -1 &&
           overflow == 0;
}

// One number per axis from None (what is given for it), a number, or an array; false for anything else.
bool read_row(nb::handle given, double absent, double scale, std::vector<double>& out, std::size_t at,
              std::size_t n) {
    const auto begin = out.begin() + std::ptrdiff_t(at);
    if (given.is_none()) {
        std::fill_n(begin, n, absent);
    } else if (is_number(given)) {
        std::fill_n(begin, n, scale * nb::cast<double>(given));
    } else {
        ConstDoubles row;
        if (!row.read(given.ptr()) || row.ndim() != 1 || std::size_t(row.size) != n) return false;
        for (std::size_t i = 0; i < n; ++i) begin[std::ptrdiff_t(i)] = scale * row.data[i];
    }
    return true;
}

using PlainMotion = std::tuple<PieceArrays, double, bool>;

// states: start, its velocity and acceleration, goal, likewise; limits: velocity, acceleration, jerk; bounds:
// lower and upper positions.
std::optional<PlainMotion> move_plain(const nb::object& states, const nb::object& limits,
                                      const nb::object& bounds, double farthest) {
    constexpr double none = std::numeric_limits<double>::infinity();
    const auto at = [](const nb::object& given, std::size_t k) { return nb::object(given[k]); };
    ConstDoubles start;
    require_sizes(nb::len(states) == 6 && nb::len(limits) == 3 && nb::len(bounds) == 2);
    if (!start.read(at(states, 0).ptr()) || start.ndim() != 1 || start.size == 0) return {};
    const std::size_t n = std::size_t(start.size);
    std::vector<double> rows(13 * n);
    for (std::size_t k = 0; k < 6; ++k) {
        const nb::object given = at(states, k);
        const bool is_row = !is_number(given) && !given.is_none();
        if ((k % 3 == 0 && !is_row) || !read_row(given, 0, 1, rows, k * n, n)) return {};
    }
    const double signs[5] = {1, -1, 1, -1, 1};
    for (std::size_t k = 0; k < 5; ++k)
        if (!read_row(at(limits, k / 2), signs[k] * none, signs[k], rows, (6 + k) * n, n)) return {};
    for (std::size_t k = 0; k < 2; ++k)
        if (!read_row(at(bounds, k), k ? none : -none, 1, rows, (11 + k) * n, n)) return {};
    const double* first = rows.data();
    if (!can_be_asked(first, first + 6 * n, n, farthest)) return {};
    const OneMotion made = move_axes(first, first + 6 * n, first + 11 * n, first + 12 * n, n);
    return PlainMotion{show(made.pieces, n), made.duration, made.keeps_within};
}

}  // namespace

void bind_trajectory(nb::module_& m) {
    m.attr("NUMBERS_OF_MOTION") = int(numbers_of_motion());
    m.def(
        "solve_states", &solve, "states"_a, "limits"_a, "durations"_a, "cycle"_a, "mode"_a, "threads"_a,
        "verdict"_a, "duration"_a, "shortest"_a, "motions"_a,
        "Motions of axes from state to state.\n\nstates (rows, 2, 3, dof): q, qd, qdd at the start and the "
        "goal. limits (5, dof): highest and lowest velocity and acceleration, jerk. durations (rows,): NaN "
        "for the shortest. mode: 0 in time, 1 in phase, 2 each axis alone. Writes verdict (rows,): 0 found, "
        "1 another duration, 2 not parallel; duration (rows,), shortest (rows, dof), motions "
        "(NUMBERS_OF_MOTION, rows, dof).");
    m.def("make_pieces", &make_arrays, "states"_a, "limits"_a, "shortest"_a, "motions"_a, "duration"_a,
          "mode"_a,
          "Polynomials of one motion: knots (dof, k + 1), coefficients (dof, k, 4) and origins (dof, k).");
    m.def(
        "find_roots",
        [](const Matrix& coefficients, const Row& begin, const Row& end, double converged) {
            const std::size_t rows = coefficients.shape(0), terms = coefficients.shape(1);
            require_sizes(terms > 0 && has_shape(begin, rows) && has_shape(end, rows));
            Doubles roots({npy_intp(rows), npy_intp(terms - 1)});
            {
                const nb::gil_scoped_release release;
                find_roots(coefficients.data(), begin.data(), end.data(), rows, terms, converged, roots.data);
            }
            return roots;
        },
        "coefficients"_a, "begin"_a, "end"_a, "converged"_a,
        "Roots (k, n - 1) of polynomials (k, n) on intervals begin, end (k,), ascending, then NaN.");
    m.def(
        "move_plain", &move_plain, "states"_a, "limits"_a, "bounds"_a, "farthest"_a,
        "The fastest motion between two states, or None where arguments are not plain rows that can be asked."
        "\n\nstates: start, its velocity and acceleration, goal, likewise. limits: velocity, acceleration, "
        "jerk. bounds: lower and upper positions. Each an array (n,), a float, or None. Returns knots, "
        "coefficients and origins, the duration, and whether positions keep within bounds.");
}
