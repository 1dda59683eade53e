// Global least squares of a system of two angles: a sweep of the torus, then refinement of the local minima.
#pragma once

#include "cspace/ik/subproblems/refine.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// The lowest points of a coarse sweep, at most `most` ≤ 16; returns their number.
template <class System>
int valleys(const System& system, int most, Turn<double> (*at)[2]) {
    constexpr int steps = 24;
    Turn<double> turns[steps];
    for (int i = 0; i < steps; ++i) turns[i] = turn_by(2 * pi * i / steps);
    double field[steps][steps];
    double lowest[16];
    Linearised<System> point;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const Turn<double> t[2] = {turns[i], turns[j]};
            field[i][j] = linearise(system, t, point);
        }
    int count = 0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double here = field[i][j];
            const bool valley =
                here <= field[(i + 1) % steps][j] && here <= field[(i + steps - 1) % steps][j] &&
                here <= field[i][(j + 1) % steps] && here <= field[i][(j + steps - 1) % steps];
            if (!valley || (count == most && here >= lowest[count - 1])) continue;
            int k = count < most ? count++ : most - 1;
            for (; k > 0 && lowest[k - 1] > here; --k)
                lowest[k] = lowest[k - 1], at[k][0] = at[k - 1][0], at[k][1] = at[k - 1][1];
            lowest[k] = here, at[k][0] = turns[i], at[k][1] = turns[j];
        }
    return count;
}

// Newton's method on half the squared residual, with second derivatives from differences of the gradient.
// Where the residual remains large, Gauss–Newton alone converges slowly.
template <class System, class Unknown>
double descend(const System& system, Unknown* t) {
    constexpr int n = System::angles;
    constexpr double h = 1e-5;
    double error = refine(system, t), damping = 0;
    for (int iteration = 0; iteration < 60 && error > tolerance::exact; ++iteration) {
        Linearised<System> at;
        double normal[n][n], hessian[n][n], down[n], step[n], length = 0;
        linearise(system, t, at);
        normal_equations(at, normal, down);
        for (int j = 0; j < n; ++j) {
            Unknown aside[n];
            double sides[2][n];
            for (int side = 0; side < 2; ++side) {
                for (int i = 0; i < n; ++i) aside[i] = i == j ? step_angles(t[i], side ? h : -h) : t[i];
                linearise(system, aside, at);
                normal_equations(at, normal, sides[side]);
            }
            for (int i = j; i < n; ++i) hessian[j][i] = (sides[0][i] - sides[1][i]) / (2 * h);
        }
        for (int i = 0; i < n; ++i) step[i] = down[i];
        const bool convex = solve_damped(hessian, damping, step);
        Unknown next[n];
        for (int i = 0; i < n; ++i) next[i] = step_angles(t[i], step[i]), length += std::fabs(step[i]);
        const double next_error = convex ? linearise(system, next, at) : error + 1;
        if (next_error > error * (1 + 4 * std::numeric_limits<double>::epsilon())) {
            damping = 4 * damping + 1e-3;
            continue;
        }
        for (int i = 0; i < n; ++i) t[i] = next[i];
        error = next_error;
        damping *= 0.1;
        if (damping < 1e-4) damping = 0;
        if (length < 1e-12) break;
    }
    return error;
}

template <class System>
double least_squares(const System& system, Turn<double>* t) {
    Turn<double> at[6][2];
    const int count = valleys(system, 6, at);
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < count; ++i) {
        const double error = descend(system, at[i]);
        if (error < best) best = error, t[0] = at[i][0], t[1] = at[i][1];
    }
    return best;
}

}  // namespace cspace::ik::inline CSPACE_ISA
