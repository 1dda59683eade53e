// Nonlinear least squares: the damped Gauss–Newton step, and the descent that adapts its damping (Levenberg
// 1944; Marquardt 1963; Nocedal & Wright 2006, chapter 10).
#pragma once

#include "cspace/math/linear.hpp"

namespace cspace::inline CSPACE_ISA {

// The largest magnitude of n numbers.
template <class V>
CSPACE_INLINE V largest_of(const V* x, int n) {
    V largest = fill_lanes<V>(0.0);
    for (int i = 0; i < n; ++i) largest = max(largest, abs(x[i]));
    return largest;
}
// The factor that shortens a step with this largest entry to a stride.
template <class V>
CSPACE_INLINE V shortening_factor(V largest, double stride) {
    return select_lanes(largest > stride, stride / largest, fill_lanes<V>(1.0));
}

// dx (n,) with (JᵀJ + λ I) dx = Jᵀ e, for the first m rows of J. loose[j] is 1, or 0 for an unknown that must
// not move. Of two equivalent systems the smaller is solved: this one, or dx = Jᵀ y with (J Jᵀ + λ I) y = e.
template <int rows, int columns, class V>
CSPACE_INLINE void damped_step(int m, int n, const V (&J)[rows][columns], const V (&e)[rows], const V* loose,
                               V damping, V* dx) {
    V M[rows][rows], b[rows];
    if (n <= m) {
        for (int i = 0; i < n; ++i) {
            for (int j = i; j < n; ++j) {
                V sum = fill_lanes<V>(0.0);
                for (int r = 0; r < m; ++r) sum = mul_add(J[r][i], J[r][j], sum);
                M[i][j] = loose[i] * loose[j] * sum;
            }
            M[i][i] = M[i][i] + damping + (1.0 - loose[i]);
            b[i] = fill_lanes<V>(0.0);
            for (int r = 0; r < m; ++r) b[i] = mul_add(J[r][i], e[r], b[i]);
            b[i] = loose[i] * b[i];
        }
        solve_positive(M, n, b);
        for (int i = 0; i < n; ++i) dx[i] = b[i];
        return;
    }
    for (int r = 0; r < m; ++r) {
        for (int t = r; t < m; ++t) {
            V sum = fill_lanes<V>(0.0);
            for (int j = 0; j < n; ++j) sum = mul_add(loose[j] * J[r][j], J[t][j], sum);
            M[r][t] = sum;
        }
        M[r][r] = M[r][r] + damping;
        b[r] = e[r];
    }
    solve_positive(M, m, b);
    for (int j = 0; j < n; ++j) {
        dx[j] = fill_lanes<V>(0.0);
        for (int r = 0; r < m; ++r) dx[j] = mul_add(J[r][j], b[r], dx[j]);
        dx[j] = loose[j] * dx[j];
    }
}

// The same step for n columns of J (n, rows) without their squares, which halve the digits: the rows of
// √damping times the identity are reflected into J one after the other (Golub & Van Loan 2013, section
// 6.5.3).
template <int rows, int columns>
void damped_step_by_reflections(int n, const double (&columns_of_J)[columns][rows],
                                const double (&error)[rows], double damping, double* dx) {
    const double root = std::sqrt(damping);
    double J[columns][rows], e[rows], R[columns][columns];
    for (int k = 0; k < rows; ++k) e[k] = error[k];
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < rows; ++k) J[i][k] = columns_of_J[i][k];
    for (int k = 0; k < n; ++k) {
        const double square = dot_n(J[k], J[k], rows), diagonal = -std::sqrt(damping + square);
        const double head = root - diagonal, factor = 2 / (head * head + square);
        R[k][k] = diagonal;
        for (int j = k + 1; j < n; ++j) {
            const double along = factor * dot_n(J[k], J[j], rows);
            R[k][j] = -along * head;
            for (int i = 0; i < rows; ++i) J[j][i] -= along * J[k][i];
        }
        const double along = factor * dot_n(J[k], e, rows);
        dx[k] = -along * head;
        for (int i = 0; i < rows; ++i) e[i] -= along * J[k][i];
    }
    for (int k = n - 1; k >= 0; --k) {
        for (int j = k + 1; j < n; ++j) dx[k] -= R[k][j] * dx[j];
        dx[k] /= R[k][k];
    }
}

// Moves the unknowns to a local minimum of the error, which never grows; returns it. `at` belongs to x on
// return. A step that does not reduce the error is rejected, and the damping increased.
//
// A Problem has `size`, the largest number of unknowns, their number n, and
//   evaluate(x, at)          the error at x, and in `at` what the model needs;
//   model(x, at, A, down)   the upper triangle of the Hessian of the squared error, or of JᵀJ, and the
//                           negative gradient; false at a stationary point;
//   add_step(value, step)      one unknown after a step.
// A Rule has the damping of the next step, accept(error) and reject(), which change it; `enough`, an error;
// `slack`, the part by which rounding may raise an error; `shortest` and `stride`, lengths of a step; and
// `floor`, which the pivots of a definite A exceed, over its largest entry.
template <class Problem, class Unknown, class Place, class Rule>
double descend_damped(const Problem& problem, Unknown* x, Place& at, Rule rule, int most_steps) {
    constexpr int size = Problem::size;
    const int n = problem.n;
    double error = problem.evaluate(x, at);
    rule.accept(error);
    for (int k = 0; k < most_steps && error > rule.enough; ++k) {
        double A[size][size], step[size], diagonal = 0;
        if (!problem.model(x, at, A, step)) break;
        for (int i = 0; i < n; ++i) {
            A[i][i] += rule.damping;
            diagonal = max(diagonal, abs(A[i][i]));
        }
        if (!solve_positive(A, n, step, rule.floor * diagonal)) {
            rule.reject();
            continue;
        }
        const double largest = largest_of(step, n), keep = shortening_factor(largest, rule.stride);
        Unknown to[size];
        Place there;
        for (int i = 0; i < n; ++i) to[i] = problem.add_step(x[i], keep * step[i]);
        const double left = problem.evaluate(to, there);
        if (left < error * (1 + rule.slack)) {
            for (int i = 0; i < n; ++i) x[i] = to[i];
            at = there;
            error = left;
            rule.accept(error);
        } else {
            rule.reject();
        }
        if (largest < rule.shortest) break;
    }
    return error;
}

// Newton's method on a cost that stays large, where the damping is zero while its steps descend.
struct NewtonDamping {
    double enough, shortest, stride, first, floor;
    double damping = 0, slack = 4 * std::numeric_limits<double>::epsilon();

    void accept(double) { damping = damping < first ? 0 : 0.1 * damping; }
    void reject() { damping = max(4 * damping, first); }
};
// Gauss–Newton on an error that vanishes at the solution: the damping follows its square, which keeps the
// convergence fast (Yamashita & Fukushima 2001), down to `least`.
struct GaussNewtonDamping {
    double enough, shortest, least;
    double damping = 1e300, stride = 1e300, slack = 0, floor = 0;
    static constexpr double of_square = 1e-3;  // restrains no step towards a regular solution
    static constexpr double risen = 1e-12;     // from nothing, to where rounding is damped

    void accept(double error) { damping = max(min(0.125 * damping, of_square * error * error), least); }
    void reject() { damping = 8 * damping + risen; }
};

}  // namespace cspace::inline CSPACE_ISA
