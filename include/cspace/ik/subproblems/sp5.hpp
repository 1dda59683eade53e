// Subproblem 5: two arms of points, three angles, one meeting point.
//
//     p0 + Rot(k1, θ1) p1 = p2 + Rot(k2, θ2) (p3 + Rot(k3, θ3) p4)
//
// Proof. Let a(θ1) = p0 − p2 + Rot(k1, θ1) p1 and b(θ3) = p3 + Rot(k3, θ3) p4. Some θ2 rotates b into a about
// k2 exactly when both have the same height over k2 and the same length (subproblem 1):
//     k2·a = k2·b,   ‖a‖² = ‖b‖².
// Both are linear in the cosines and sines of θ1 and θ3, since ‖x + Rot(k, θ) y‖² = ‖x‖² + ‖y‖² + 2 xᵀ Rot(k,
// θ) y and by the proof of subproblem 4. Two such equations have at most four solutions (two_angles.hpp). θ2
// follows from subproblem 1, and any θ2 is a solution if the meeting point is on its axis. If no solution
// exists, the distance ‖a − Rot(k2, θ2) b‖ left by the best θ2 is the one between the points (k2·a, ‖k2 × a‖)
// and (k2·b, ‖k2 × b‖) of the half plane; its least value over θ1 and θ3 is returned.
//
// Reference: Elias & Wen 2022, §3.5.
#pragma once

#include "cspace/ik/subproblems/least_squares.hpp"
#include "cspace/ik/subproblems/sp1.hpp"
#include "cspace/ik/subproblems/two_angles.hpp"

namespace cspace::ik {

struct Sp5Problem {
    Vec3d p0, p1, p2, p3, p4, k1, k2, k3;
};
// Exact solutions, or one least-squares solution with `exact` unset. `free`: they are not isolated.
struct Sp5 {
    int count = 0;
    Turn<double> theta[4][3];
    double error = 0;  // largest distance left
    bool exact = false, free = false;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

namespace sp5 {

// The gap as a function of all three angles. It is smooth also where the points meet on the axis k2.
struct Gap {
    static constexpr int angles = 3, equations = 3;
    const Sp5Problem& s;
    void operator()(const Turn<double>* t, double* value, double (*slope)[3]) const {
        const Vec3d turned1 = rotate_about(s.k1, t[0], s.p1), turned4 = rotate_about(s.k3, t[2], s.p4);
        const Vec3d turned2 = rotate_about(s.k2, t[1], s.p3 + turned4);
        const Vec3d columns[4] = {s.p0 + turned1 - s.p2 - turned2, cross(s.k1, turned1),
                                  -cross(s.k2, turned2), -rotate_about(s.k2, t[1], cross(s.k3, turned4))};
        for (int j = 0; j < 4; ++j) {
            const double rows[3] = {columns[j].x, columns[j].y, columns[j].z};
            for (int i = 0; i < 3; ++i) (j ? slope[i][j - 1] : value[i]) = rows[i];
        }
    }
};

inline TwoTurnEquations two_turn_equations(const Sp5Problem& s) {
    const Vec3d x = s.p0 - s.p2;
    // cᵀ Rot(k, θ) p adds its constant, cosine and sine to a row.
    const auto add = [](const Vec3d& c, const Vec3d& k, const Vec3d& p, double factor, double& alpha,
                        double* row) {
        const Vec3d kp = cross(k, p);
        alpha += factor * dot(c, k) * dot(k, p);
        row[0] = factor * dot(cross(k, c), kp);
        row[1] = factor * dot(c, kp);
    };
    TwoTurnEquations e;
    e.alpha[0] = dot(s.k2, x) - dot(s.k2, s.p3);
    add(s.k2, s.k1, s.p1, 1, e.alpha[0], e.beta[0]);
    add(s.k2, s.k3, s.p4, -1, e.alpha[0], e.gamma[0]);
    e.alpha[1] = dot(x, x) + dot(s.p1, s.p1) - dot(s.p3, s.p3) - dot(s.p4, s.p4);
    add(x, s.k1, s.p1, 2, e.alpha[1], e.beta[1]);
    add(s.p3, s.k3, s.p4, -2, e.alpha[1], e.gamma[1]);
    return e;
}

// Writes θ1 and θ3, with the best θ2 between them.
inline Sp1<double> complete_turns(const Sp5Problem& s, const Turn<double>& first, const Turn<double>& third,
                                  Turn<double>* theta) {
    const Sp1<double> second = subproblem_1(s.k2, s.p3 + rotate_about(s.k3, third, s.p4),
                                            s.p0 - s.p2 + rotate_about(s.k1, first, s.p1));
    theta[0] = first, theta[1] = second.theta, theta[2] = third;
    return second;
}

// Divides all lengths by their sum, which is one afterwards.
inline Sp5Problem scale_problem(const Sp5Problem& s, double size) {
    const double f = 1 / size;
    return {f * s.p0, f * s.p1, f * s.p2, f * s.p3, f * s.p4, s.k1, s.k2, s.k3};
}

// The least-squares solution. What the best θ2 leaves is the distance in the half plane of k2.
inline Sp5 nearest_solution(const Sp5Problem& s, double size) {
    const SweepTurns turns;
    const auto start = [&](int i, int j, Turn<double>* t) {
        return complete_turns(s, turns.at[i], turns.at[j], t).error;
    };
    Sp5 r;
    r.count = 1;
    r.error = size * minimise_from_sweep<6>(Gap{s}, sweep_steps, sweep_steps, start, r.theta[0]);
    r.exact = r.error <= tolerance::exact * size;
    Turn<double> again[3];
    r.free = complete_turns(s, r.theta[0][0], r.theta[0][2], again).free;
    return r;
}

}  // namespace sp5

inline Sp5 subproblem_5(const Sp5Problem& given) {
    Sp5 r;
    const double size = norm(given.p0 - given.p2) + norm(given.p1) + norm(given.p3) + norm(given.p4);
    if (size == 0) {
        r.count = 1;
        for (Turn<double>& t : r.theta[0]) t = no_turn<double>();
        r.exact = r.free = true;
        return r;
    }
    const Sp5Problem s = sp5::scale_problem(given, size);
    const TwoTurns found = solve_two_turns(sp5::two_turn_equations(s));
    r.free = found.free;
    for (int i = 0; i < found.count; ++i) {
        Turn<double>* const theta = r.theta[r.count];
        const bool is_free = sp5::complete_turns(s, found.u[i], found.w[i], theta).free;
        const double left = refine_angles(sp5::Gap{s}, theta, 100);
        r.free = r.free || is_free;
        if (left > tolerance::exact) continue;
        ++r.count;
        r.error = std::fmax(r.error, size * left);
    }
    r.exact = r.count > 0;
    if (r.exact) return r;
    return sp5::nearest_solution(s, size);
}

}  // namespace cspace::ik::inline CSPACE_ISA
