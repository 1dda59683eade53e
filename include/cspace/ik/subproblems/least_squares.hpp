// Least squares on a few angles: refinement of candidates, and the global minimum where no exact solution
// exists.
//
// A System has `angles` and `equations`, and as a function (turns, value, slope) gives the residuals and
// their derivatives with respect to the angles. Lengths in it are about one.
#pragma once

#include "cspace/math/least_squares.hpp"
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

// The upper triangle of JᵀJ, and −Jᵀ value; returns the length of the latter.
template <class System>
double normal_equations(const Linearised<System>& at, double (*a)[System::angles], double* down) {
    double square = 0;
    for (int i = 0; i < System::angles; ++i) {
        down[i] = 0;
        for (int k = 0; k < System::equations; ++k) down[i] -= at.slope[k][i] * at.value[k];
        square += down[i] * down[i];
        for (int j = i; j < System::angles; ++j) {
            a[i][j] = 0;
            for (int k = 0; k < System::equations; ++k) a[i][j] += at.slope[k][i] * at.slope[k][j];
        }
    }
    return std::sqrt(square);
}

// A system as a problem of descend_damped: by Gauss–Newton.
template <class System>
struct AngleProblem {
    static constexpr int size = System::angles, n = size;
    const System& system;

    template <class Unknown>
    double evaluate(const Unknown* t, Linearised<System>& at) const {
        return linearise(system, t, at);
    }
    template <class Unknown>
    bool model(const Unknown*, const Linearised<System>& at, double (*A)[size], double* down) const {
        return normal_equations(at, A, down) > 0;
    }
    template <class Unknown>
    Unknown add_step(const Unknown& t, double step) const {
        return step_angles(t, step);
    }
};
// By Newton's method, with second derivatives from differences of the gradient. Where the residual remains
// large, Gauss–Newton alone converges slowly.
template <class System>
struct CurvedAngleProblem : AngleProblem<System> {
    static constexpr int n = System::angles;

    template <class Unknown>
    bool model(const Unknown* t, const Linearised<System>& at, double (*H)[n], double* down) const {
        constexpr double h = 1e-5;
        double normal[n][n], behind[n] = {}, ahead[n] = {};
        const auto gradient_aside = [&](int j, double step, double* out) {
            Unknown aside[n];
            for (int i = 0; i < n; ++i) aside[i] = i == j ? step_angles(t[i], step) : t[i];
            Linearised<System> there;
            linearise(this->system, aside, there);
            normal_equations(there, normal, out);
        };
        for (int j = 0; j < n; ++j) {
            gradient_aside(j, -h, behind);
            gradient_aside(j, h, ahead);
            for (int i = j; i < n; ++i) H[j][i] = (behind[i] - ahead[i]) / (2 * h);
        }
        return normal_equations(at, normal, down) > 0;
    }
};

// Which descents of refine_angles end early: at once those from a start with a residual above `far`; and
// those that only seek zeros, where a residual above `clear` is not halved by some steps.
struct Seek {
    double far = 1e300;
    bool zeros = false;
    static constexpr double clear = 1e-3;
    static constexpr int patience = 6;  // steps; a double zero takes one
};
struct NearbyDamping : GaussNewtonDamping {
    Seek seek;
    double halved = 1e300;  // the residual when it was last halved
    int waited = -1;        // steps since then; −1 before the first

    void accept(double error) {
        if (waited < 0 && error > seek.far) enough = error;
        wait();
        if (error < 0.5 * halved) halved = error, waited = 0;
        GaussNewtonDamping::accept(error);
    }
    void reject() {
        wait();
        GaussNewtonDamping::reject();
    }

  private:
    void wait() {
        if (++waited >= Seek::patience && seek.zeros && halved > Seek::clear) enough = halved;
    }
};

// Moves the unknowns to a local minimum of the residual, or as far as is sought; returns its length there.
template <class System, class Unknown>
double refine_angles(const System& system, Unknown* t, int most_steps = 30, const Seek& seek = {}) {
    constexpr double shortest_step = 1e-10;  // [rad] the step after it squares the error
    // A slope that is only rounding must not throw an unknown about.
    constexpr double least = tolerance::exact * tolerance::exact;
    Linearised<System> at;
    const GaussNewtonDamping damping{2 * std::numeric_limits<double>::epsilon(), shortest_step, least};
    return descend_damped(AngleProblem<System>{system}, t, at, NearbyDamping{damping, seek}, most_steps);
}
// The same where the residual there may be large.
template <class System, class Unknown>
double descend_angles(const System& system, Unknown* t) {
    constexpr double last_step = 1e-12;     // [rad] where the residual stays large, convergence is slower
    constexpr double first_damping = 1e-3;  // of the curvature of unit vectors: little where none is needed
    Linearised<System> at;
    refine_angles(system, t);
    return descend_damped(CurvedAngleProblem<System>{{system}}, t, at,
                          NewtonDamping{tolerance::exact, last_step, 1e300, first_damping, 0}, 60);
}

// Whether the zero t lies on a curve of zeros with the unit tangent `along`. After a step along a curve,
// refinement finds a residual below `zero` nearby; from an isolated multiple zero it must return all the way.
template <class System, class Unknown>
bool continues_along(const System& system, const Unknown* t, const double* along, double zero) {
    constexpr double reach = 1e-3;
    Unknown start[System::angles], found[System::angles];
    for (int j = 0; j < System::angles; ++j) found[j] = start[j] = step_angles(t[j], reach * along[j]);
    if (refine_angles(system, found) > zero) return false;
    double drift = 0;
    for (int j = 0; j < System::angles; ++j) drift = std::hypot(drift, difference(found[j], start[j]));
    return drift < 0.5 * reach;
}

// Points of a sweep over the circle.
inline constexpr int sweep_steps = 24;
struct SweepTurns {
    Turn<double> at[sweep_steps];
    SweepTurns() {
        for (int i = 0; i < sweep_steps; ++i) at[i] = turn_by(2 * pi * i / sweep_steps);
    }
};

// The global minimum of the residual: start(i, j, t) sets the unknowns to row i and column j of a sweep of up
// to two angles and returns the residual there. The minimum is sought from its `most` lowest valleys, which
// are below their neighbours, modulo 2π. Returns the length of the residual at the minimum.
template <int most, class System, class Unknown, class Start>
double minimise_from_sweep(const System& system, int rows, int columns, const Start& start, Unknown* best) {
    double value[sweep_steps][sweep_steps];
    Unknown t[System::angles];
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) value[i][j] = start(i, j, t);
    struct Valley {
        int row, column;
        double value;
    } found[most];  // the lowest first
    int count = 0;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const double here = value[i][j];
            const auto is_below = [&](int row, int column) {
                return here <= value[(i + row) % rows][(j + column) % columns];
            };
            if (!is_below(1, 0) || !is_below(rows - 1, 0) || !is_below(0, 1) || !is_below(0, columns - 1) ||
                (count == most && here >= found[most - 1].value))
                continue;
            int k = count < most ? count++ : most - 1;
            for (; k > 0 && found[k - 1].value > here; --k) found[k] = found[k - 1];
            found[k] = {i, j, here};
        }
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < count; ++k) {
        start(found[k].row, found[k].column, t);
        const double error = descend_angles(system, t);
        if (!(error < least)) continue;
        least = error;
        for (int i = 0; i < System::angles; ++i) best[i] = t[i];
    }
    return least;
}

}  // namespace cspace::ik::inline CSPACE_ISA
