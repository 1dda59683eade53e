// Damped Gauss–Newton on a few angles: refines candidates, and finds the least-squares solution where no
// exact one exists.
//
// A System has `angles` and `equations`, and as a function (turns, value, slope) gives the residuals and
// their derivatives with respect to the angles. Lengths in it are about one.
#pragma once

#include "cspace/math/linear.hpp"
#include "cspace/math/turn.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::ik::inline CSPACE_ISA {

inline Turn<double> step_angles(const Turn<double>& t, double step) {
    const double length = std::sqrt(1 + step * step);
    return t + Turn<double>{1 / length, step / length};
}
inline double step_angles(double q, double step) { return q + step; }
inline double difference(const Turn<double>& a, const Turn<double>& b) { return (a - b).s; }
inline double difference(double a, double b) { return a - b; }

template <class System>
struct Linearised {
    double value[System::equations], slope[System::equations][System::angles];
};
template <class System, class Unknown>
double linearise(const System& system, const Unknown* t, Linearised<System>& at) {
    system(t, at.value, at.slope);
    double sum = 0;
    for (double v : at.value) sum += v * v;
    return std::sqrt(sum);
}

// Solves (A + damping) x = b, where A is used up; b becomes x. False if it is not positive definite.
template <int n>
bool solve_damped(double (&A)[n][n], double damping, double* b) {
    for (int i = 0; i < n; ++i) A[i][i] += damping;
    return solve_positive(A, n, b);
}

// The upper triangle of JᵀJ, and −Jᵀ value; returns the length of the latter.
template <class System>
double normal_equations(const Linearised<System>& at, double (*a)[System::angles], double* down) {
    double length = 0;
    for (int i = 0; i < System::angles; ++i) {
        down[i] = 0;
        for (int k = 0; k < System::equations; ++k) down[i] -= at.slope[k][i] * at.value[k];
        length = std::hypot(length, down[i]);
        for (int j = i; j < System::angles; ++j) {
            a[i][j] = 0;
            for (int k = 0; k < System::equations; ++k) a[i][j] += at.slope[k][i] * at.slope[k][j];
        }
    }
    return length;
}

// Moves the unknowns to a local minimum of the residual; returns its length there. A step that does not
// reduce the residual is rejected and the damping increased (Marquardt 1963), so the residual never grows.
template <class System, class Unknown>
double refine(const System& system, Unknown* t, int iterations = 30) {
    constexpr int n = System::angles;
    // A slope that is only rounding must not throw an unknown about.
    constexpr double least = tolerance::exact * tolerance::exact;
    Linearised<System> at, ahead;
    double error = linearise(system, t, at), damping = std::fmax(1e-3 * error * error, least);
    for (int i = 0; i < iterations && error > 2 * std::numeric_limits<double>::epsilon(); ++i) {
        double normal[n][n], step[n], length = 0;
        if (normal_equations(at, normal, step) == 0) break;
        if (!solve_damped(normal, damping, step)) {
            damping *= 8;
            continue;
        }
        Unknown next[n];
        for (int j = 0; j < n; ++j) next[j] = step_angles(t[j], step[j]), length += std::fabs(step[j]);
        const double next_error = linearise(system, next, ahead);
        if (next_error >= error) {
            if (length < 1e-10) break;
            damping = 8 * damping + 1e-12;
            continue;
        }
        for (int j = 0; j < n; ++j) t[j] = next[j];
        at = ahead, error = next_error;
        damping = std::fmax(std::fmin(0.125 * damping, 1e-3 * error * error), least);
    }
    return error;
}

// Whether the zero t lies on a curve of zeros with the unit tangent `along`. After a step along a curve,
// refinement finds a residual below `zero` nearby; from an isolated multiple zero it must return all the way.
template <class System, class Unknown>
bool continues_along(const System& system, const Unknown* t, const double* along, double zero) {
    constexpr double reach = 1e-3;
    Unknown start[System::angles], found[System::angles];
    for (int j = 0; j < System::angles; ++j) found[j] = start[j] = step_angles(t[j], reach * along[j]);
    if (refine(system, found) > zero) return false;
    double drift = 0;
    for (int j = 0; j < System::angles; ++j) drift = std::hypot(drift, difference(found[j], start[j]));
    return drift < 0.5 * reach;
}

}  // namespace cspace::ik::inline CSPACE_ISA
