// Two equations, each linear in the cosine and sine of two angles: the common core of subproblems 5 and 6.
//
//     α_i + β_i·u + γ_i·w = 0,  i = 0, 1,  u = (cos θ, sin θ), w = (cos φ, sin φ)
//
// Proof. Write B and Γ for the matrices of rows β_i and γ_i. If Γ is regular, w = −Γ⁻¹ (α + B u), and ‖w‖ = 1
// gives ‖adj Γ (α + B u)‖² = (det Γ)²: a trigonometric polynomial of degree two in θ, hence at most four θ,
// each with one φ. If B is regular the roles may be exchanged; the side with the larger smallest singular
// value is eliminated. If neither is regular, B u moves on a line along b and Γ w on a line along g. The
// cross product with g leaves one linear equation in θ alone, that with b one in φ alone: two times two
// solutions. If these lines are parallel as well, only one equation remains for two angles: no solution or a
// one-parameter set. Close to these cases the polynomial has near-double roots. All candidates are therefore
// refined by Newton's method on the two equations, where pairs of solutions with the same θ differ in φ.
#pragma once

#include "cspace/ik/subproblems/least_squares.hpp"
#include "cspace/math/cos_sin.hpp"
#include "cspace/math/trig_polynomial.hpp"

namespace cspace::ik {

struct TwoTurnEquations {
    double alpha[2], beta[2][2], gamma[2][2];
    double weight[2] = {1, 1};  // the size of each row before it was brought to one
};
// `free`: the solutions are not isolated; those given represent them.
struct TwoTurns {
    int count = 0;
    Turn<double> u[4], w[4];
    bool free = false;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

namespace two_turns {

inline double apply_row(const double row[2], const Turn<double>& t) { return row[0] * t.c + row[1] * t.s; }
inline Turn<double> quarter_turn(const Turn<double>& t) { return {-t.s, t.c}; }

struct Residual {
    static constexpr int angles = 2, equations = 2;
    const TwoTurnEquations& e;
    double factor[2] = {1, 1};
    void operator()(const Turn<double>* t, double* value, double (*slope)[2]) const {
        const Turn<double> du = quarter_turn(t[0]), dw = quarter_turn(t[1]);
        for (int i = 0; i < 2; ++i) {
            value[i] = factor[i] * (e.alpha[i] + apply_row(e.beta[i], t[0]) + apply_row(e.gamma[i], t[1]));
            slope[i][0] = factor[i] * apply_row(e.beta[i], du);
            slope[i][1] = factor[i] * apply_row(e.gamma[i], dw);
        }
    }
};

// Bound of the rounding error in the coefficients of normalised rows.
inline double noise_bound(const TwoTurnEquations& e) {
    return tolerance::rounding / std::fmin(e.weight[0], e.weight[1]);
}

inline double determinant(const double m[2][2]) { return m[0][0] * m[1][1] - m[0][1] * m[1][0]; }
inline double frobenius_norm(const double m[2][2]) {
    return std::sqrt(m[0][0] * m[0][0] + m[0][1] * m[0][1] + m[1][0] * m[1][0] + m[1][1] * m[1][1]);
}
inline double smallest_singular_value(const double m[2][2]) {
    const double largest = frobenius_norm(m);
    return largest > 0 ? std::fabs(determinant(m)) / largest : 0;
}
// Coefficients within rounding become zero, so that degenerate cases are exactly degenerate. The other rows
// are normalised, so that a short row has the same weight as a long one.
inline TwoTurnEquations balance_equations(TwoTurnEquations e) {
    for (int i = 0; i < 2; ++i) {
        double largest = 0;
        double* row[5] = {&e.alpha[i], &e.beta[i][0], &e.beta[i][1], &e.gamma[i][0], &e.gamma[i][1]};
        for (double* x : row) {
            if (std::fabs(*x) <= tolerance::rounding) *x = 0;
            largest = std::fmax(largest, std::fabs(*x));
        }
        if (largest == 0) continue;
        for (double* x : row) *x /= largest;
        e.weight[i] *= largest;
    }
    return e;
}
inline TwoTurnEquations exchange_angles(const TwoTurnEquations& e) {
    TwoTurnEquations r = e;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) r.beta[i][j] = e.gamma[i][j], r.gamma[i][j] = e.beta[i][j];
    return r;
}

inline double chord_between(const Turn<double>& a, const Turn<double>& b) {
    return std::fabs(a.c - b.c) + std::fabs(a.s - b.s);
}
// Whether the solution belongs to a one-parameter set.
inline bool belongs_to_curve(const TwoTurnEquations& e, const Turn<double>* t) {
    const Residual system{e};
    Linearised<Residual> at;
    linearise(system, t, at);
    const double largest = frobenius_norm(at.slope),
                 zero = tolerance::exact / tolerance::rounding * noise_bound(e);
    if (largest <= tolerance::degenerate_pair) {
        const double first[2] = {1, 0}, second[2] = {0, 1};
        return continues_along(system, t, first, zero) || continues_along(system, t, second, zero);
    }
    if (std::fabs(determinant(at.slope)) > tolerance::degenerate_pair * largest * largest) return false;
    const int i = std::hypot(at.slope[1][0], at.slope[1][1]) > std::hypot(at.slope[0][0], at.slope[0][1]);
    const double length = std::hypot(at.slope[i][0], at.slope[i][1]);
    const double along[2] = {at.slope[i][1] / length, -at.slope[i][0] / length};
    return continues_along(system, t, along, zero);
}
// Refines a candidate and appends it if it solves the equations and is new. The iteration uses rows of equal
// size. The final refinement uses rows of their true size, because normalising amplifies the rounding of a
// short row if there are more equations than angles.
inline void propose_candidates(const TwoTurnEquations& e, const Turn<double>& u, const Turn<double>& w,
                               TwoTurns& found) {
    Turn<double> t[2] = {u, w};
    refine_angles(Residual{e}, t);
    if (refine_angles(Residual{e, {e.weight[0], e.weight[1]}}, t) > tolerance::exact || found.count == 4)
        return;
    for (int i = 0; i < found.count; ++i)
        if (chord_between(t[0], found.u[i]) + chord_between(t[1], found.w[i]) < tolerance::same_turns) return;
    found.free = found.free || belongs_to_curve(e, t);
    found.u[found.count] = t[0];
    found.w[found.count++] = t[1];
}
// All w for a given u, by the larger row of Γ.
inline void propose_with(const TwoTurnEquations& e, const Turn<double>& u, TwoTurns& found) {
    const auto length = [&](int i) { return std::hypot(e.gamma[i][0], e.gamma[i][1]); };
    const int i = length(1) > length(0);
    const CosSinRoots<double> w =
        cos_sin_roots(e.gamma[i][0], e.gamma[i][1], -e.alpha[i] - apply_row(e.beta[i], u), 1.0);
    propose_candidates(e, u, w.theta[0], found);
    if (w.two) propose_candidates(e, u, w.theta[1], found);
}

// The line on which M x moves if M is singular: its larger column.
inline void range_of(const double m[2][2], double line[2]) {
    const int j = std::hypot(m[0][1], m[1][1]) > std::hypot(m[0][0], m[1][0]);
    line[0] = m[0][j], line[1] = m[1][j];
}

// Eliminates w by the inverse of Γ: f and h are adj Γ (α + B u).
inline void by_quartic(const TwoTurnEquations& e, TwoTurns& found) {
    const double (*g)[2] = e.gamma;
    const LinearInTurn first = {e.alpha[0], e.beta[0][0], e.beta[0][1]},
                       second = {e.alpha[1], e.beta[1][0], e.beta[1][1]};
    const LinearInTurn f = g[1][1] * first + -g[0][1] * second, h = g[0][0] * second + -g[1][0] * first;
    const double d = determinant(g),
                 scale = frobenius_norm(g) * frobenius_norm(g) * noise_bound(e) / tolerance::rounding;
    TrigPolynomial norm = product(f, f) + product(h, h);
    norm.a0 -= d * d;
    const TrigRoots u = trig_roots(norm, scale);
    if (u.everywhere) propose_with(e, no_turn<double>(), found);
    for (int i = 0; i < u.count; ++i) propose_with(e, u.theta[i], found);
}

// One equation β·u + γ·w + α = 0 remains for two angles. θ = 0 if some φ solves it, otherwise the middle of
// the θ for which one does: |β·u| ≤ ‖β‖ and |α + β·u| ≤ ‖γ‖.
inline void by_one_equation(const TwoTurnEquations& e, TwoTurns& found) {
    propose_with(e, no_turn<double>(), found);
    if (found.count) return;
    const auto length = [](const double* row) { return std::hypot(row[0], row[1]); };
    const int i = length(e.beta[1]) > length(e.beta[0]);
    const double b = length(e.beta[i]), g = length(e.gamma[i]);
    const double lowest = std::fmax(-b, -e.alpha[i] - g), highest = std::fmin(b, -e.alpha[i] + g);
    const CosSinRoots<double> u = cos_sin_roots(e.beta[i][0], e.beta[i][1], 0.5 * (lowest + highest), 1.0);
    for (const Turn<double>& t : u.theta) propose_with(e, t, found);
}

// B and Γ singular (or nearly: then these are candidates in addition to those of the quartic).
inline void by_lines(const TwoTurnEquations& e, bool singular, TwoTurns& found) {
    double b[2], g[2];
    range_of(e.beta, b);
    range_of(e.gamma, g);
    const double crossing = b[0] * g[1] - b[1] * g[0], length_b = std::hypot(b[0], b[1]),
                 length_g = std::hypot(g[0], g[1]);
    if (std::fabs(crossing) <= noise_bound(e) * length_b * length_g) {
        if (singular) by_one_equation(e, found);
        return;
    }
    const auto across = [](const double line[2], double first, double second) {
        return line[1] * first - line[0] * second;
    };
    const CosSinRoots<double> u =
        cos_sin_roots(across(g, e.beta[0][0], e.beta[1][0]), across(g, e.beta[0][1], e.beta[1][1]),
                      -across(g, e.alpha[0], e.alpha[1]), 1.0);
    const CosSinRoots<double> w =
        cos_sin_roots(across(b, e.gamma[0][0], e.gamma[1][0]), across(b, e.gamma[0][1], e.gamma[1][1]),
                      -across(b, e.alpha[0], e.alpha[1]), 1.0);
    for (const Turn<double>& s : u.theta)
        for (const Turn<double>& t : w.theta) propose_candidates(e, s, t, found);
}

}  // namespace two_turns

inline TwoTurns solve_two_turns(const TwoTurnEquations& given) {
    using namespace two_turns;
    const TwoTurnEquations e = balance_equations(given);
    const double b = smallest_singular_value(e.beta), g = smallest_singular_value(e.gamma);
    const bool exchange = b > g;
    const TwoTurnEquations used = exchange ? exchange_angles(e) : e;
    TwoTurns found;
    const double regular = std::fmax(b, g);
    const bool singular = regular <= noise_bound(e);
    if (!singular) by_quartic(used, found);
    if (regular < tolerance::degenerate_pair) by_lines(used, singular, found);
    if (exchange)
        for (int i = 0; i < found.count; ++i) {
            const Turn<double> u = found.u[i];
            found.u[i] = found.w[i];
            found.w[i] = u;
        }
    return found;
}

}  // namespace cspace::ik::inline CSPACE_ISA
