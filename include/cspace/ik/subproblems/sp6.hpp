// Subproblem 6: two rotated points per plane, two planes, two angles.
//
//     h1ᵀ Rot(k1, θ1) p1 + h2ᵀ Rot(k2, θ2) p2 = d1
//     h3ᵀ Rot(k3, θ1) p3 + h4ᵀ Rot(k4, θ2) p4 = d2
//
// Proof. By the proof of subproblem 4 each product hᵀ Rot(k, θ) p is (h·k)(k·p) + a cos θ + b sin θ with a =
// (k × h)·(k × p) and b = h·(k × p). Both equations are linear in the cosines and sines of the two angles,
// which two_angles.hpp solves: at most four solutions. If none exists, the pair of angles with the smallest
// length of the residual vector is returned.
//
// Reference: Elias & Wen 2022, §3.6.
#pragma once

#include "cspace/ik/subproblems/least_squares.hpp"
#include "cspace/ik/subproblems/two_angles.hpp"

namespace cspace::ik {

// Equation i pairs (h, k, p)[2 i], rotated by θ1, with (h, k, p)[2 i + 1], rotated by θ2.
struct Sp6Problem {
    Vec3d h[4], k[4], p[4];
    double d[2];
};
// Exact solutions, or one least-squares solution with `exact` unset. `free`: they are not isolated.
struct Sp6 {
    int count = 0;
    Turn<double> theta[4][2];
    double error = 0;  // largest residual, the length of both equations together
    bool exact = false, free = false;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline Sp6 subproblem_6(const Sp6Problem& s) {
    TwoTurnEquations e;
    double largest = 0, scales[2];
    for (int i = 0; i < 2; ++i) {
        scales[i] = std::fabs(s.d[i]);
        for (int j = 2 * i; j < 2 * i + 2; ++j) scales[i] += norm(s.h[j]) * norm(s.p[j]);
        largest = std::fmax(largest, scales[i]);
    }
    const double inverse = largest > 0 ? 1 / largest : 0;
    for (int i = 0; i < 2; ++i) {
        e.alpha[i] = -s.d[i] * inverse;
        for (int j = 0; j < 2; ++j) {
            const int m = 2 * i + j;
            const Vec3d kp = cross(s.k[m], s.p[m]);
            double* row = j ? e.gamma[i] : e.beta[i];
            row[0] = dot(cross(s.k[m], s.h[m]), kp) * inverse;
            row[1] = dot(s.h[m], kp) * inverse;
            e.alpha[i] += dot(s.h[m], s.k[m]) * dot(s.k[m], s.p[m]) * inverse;
        }
    }
    const TwoTurns found = solve_two_turns(e);
    Sp6 r;
    r.count = found.count;
    r.exact = found.count > 0;
    r.free = found.free;
    for (int i = 0; i < found.count; ++i) r.theta[i][0] = found.u[i], r.theta[i][1] = found.w[i];
    if (!r.exact) {
        r.count = 1;
        const SweepTurns turns;
        const auto start = [&](int i, int j, Turn<double>* t) {
            t[0] = turns.at[i], t[1] = turns.at[j];
            Linearised<two_turns::Residual> at;
            return linearise(two_turns::Residual{e}, t, at);
        };
        minimise_from_sweep<6>(two_turns::Residual{e}, sweep_steps, sweep_steps, start, r.theta[0]);
    }
    for (int i = 0; i < r.count; ++i) {
        Linearised<two_turns::Residual> at;
        r.error = std::fmax(r.error, largest * linearise(two_turns::Residual{e}, r.theta[i], at));
    }
    return r;
}

}  // namespace cspace::ik::inline CSPACE_ISA
