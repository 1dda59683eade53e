// Explicit Runge–Kutta steps in the group of motions: the classical one, and that of Dormand and Prince.
//
// A step is a displacement and a change of velocity. The orientation of a floating base is exp(u) R with a
// rotation vector u, which obeys u' = J⁻¹(u) ω (Munthe-Kaas 1999); all else is added.
#pragma once

#include "cspace/dynamics/mechanics.hpp"

namespace cspace::dynamics {

// The weights of the stages before each stage, and those of the step.
template <int n>
struct Tableau {
    double before[n][n], end[n];
};

// The rates of displacement and of velocity at up to seven stages, (stages, dof) each; a displacement and a
// change of velocity (dof,); and a state between.
template <class V>
struct Stages {
    V *xs, *vs, *dx, *dv;
    State<V> inner;
};

}  // namespace cspace::dynamics

namespace cspace::dynamics::inline CSPACE_ISA {

inline constexpr Tableau<4> classical = {{{}, {1.0 / 2}, {0, 1.0 / 2}, {0, 0, 1}},
                                         {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}};

// Dormand and Prince 1980, RK5(4)7M.
inline constexpr Tableau<7> dormand_prince = {
    {{},
     {1.0 / 5},
     {3.0 / 40, 9.0 / 40},
     {44.0 / 45, -56.0 / 15, 32.0 / 9},
     {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
     {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
     {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}},
    {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84, 0}};
// The weights of the fifth order less those of the fourth.
inline constexpr double dormand_prince_error[7] = {-71.0 / 57600,    0,           71.0 / 16695, -71.0 / 1920,
                                                   17253.0 / 339200, -22.0 / 525, 1.0 / 40};
// The weights of θ, θ², θ³ and θ⁴ between the ends of a step (Shampine 1986).
inline constexpr double dormand_prince_dense[4][7] = {
    {1, 0, 0, 0, 0, 0, 0},
    {-8048581381.0 / 2820520608, 0, 131558114200.0 / 32700410799, -1754552775.0 / 470086768,
     127303824393.0 / 49829197408, -282668133.0 / 205662961, 40617522.0 / 29380423},
    {8663915743.0 / 2820520608, 0, -68118460800.0 / 10900136933, 14199869525.0 / 1410260304,
     -318862633887.0 / 49829197408, 2019193451.0 / 616988883, -110615467.0 / 29380423},
    {-12715105075.0 / 11282082432, 0, 87487479700.0 / 32700410799, -10690763975.0 / 1880347072,
     701980252875.0 / 199316789632, -1453857185.0 / 822651844, 69997945.0 / 29380423}};

// h times the weighted sum of `count` rates (dof,).
template <class V>
CSPACE_INLINE void weigh_rates(const double* weights, int count, const V* rates, int dof, V h, V* sum) {
    for (int j = 0; j < dof; ++j) {
        V total = fill_lanes<V>(0.0);
        for (int s = 0; s < count; ++s)
            if (weights[s] != 0.0) total = total + weights[s] * rates[s * dof + j];
        sum[j] = h * total;
    }
}

// The displacement and the change of velocity dx, dv of a step of length h, and the rates at its stages.
template <class V, int n>
CSPACE_INLINE void find_stages(const Tableau<n>& table, const Mechanics& mechanics, const State<V>& state,
                               const V* tau, V h, Workspace<V>& work, Stages<V>& stages) {
    const int dof = mechanics.dof();
    for (int j = 0; j < dof; ++j) stages.xs[j] = state.qd[j];
    driven_accelerations(mechanics, state, tau, work, stages.vs);
    for (int s = 1; s < n; ++s) {
        weigh_rates(table.before[s], s, stages.xs, dof, h, stages.dx);
        weigh_rates(table.before[s], s, stages.vs, dof, h, stages.dv);
        advance_state(mechanics, state, stages.dx, stages.dv, stages.inner);
        displacement_rate(mechanics, stages.inner, stages.dx, stages.xs + s * dof);
        driven_accelerations(mechanics, stages.inner, tau, work, stages.vs + s * dof);
    }
    weigh_rates(table.end, n, stages.xs, dof, h, stages.dx);
    weigh_rates(table.end, n, stages.vs, dof, h, stages.dv);
}

// The state after one step of the classical method, of order four. False where the base turned too far.
template <class V>
mask_of<V> step_runge_kutta(const Mechanics& mechanics, const State<V>& state, const V* tau, V h,
                            Workspace<V>& work, Stages<V>& stages, State<V>& after) {
    find_stages(classical, mechanics, state, tau, h, work, stages);
    return advance_state(mechanics, state, stages.dx, stages.dv, after);
}

}  // namespace cspace::dynamics::inline CSPACE_ISA
