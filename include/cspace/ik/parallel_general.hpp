// Arms with three parallel axes and no other special geometry: two equations, each linear in the cosines and
// sines of two angles (subproblem 6), a direction and a planar two-link arm. Up to 4 × 2 solutions.
//
// Rotations about the parallel axes with direction n leave n·(position) and n·(a direction) invariant.
// Written for both ends of the remaining joints, these are the two equations.
#pragma once

#include "cspace/ik/dh_form.hpp"
#include "cspace/ik/solution.hpp"
#include "cspace/ik/subproblems/two_angles.hpp"
#include "cspace/ik/trig_steps.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// The angle of a rotation about z.
inline Turn<double> planar_turn(const Mat3d& R) {
    const double r = std::hypot(R.m[0][0], R.m[1][0]);
    return r > 0 ? Turn<double>{R.m[0][0] / r, R.m[1][0] / r} : Turn<double>{1, 0};
}

// `planar` = Rz(t_j) Tx(a_j) Rz(t_k) Tx(a_k) Rz(t_l), the displacement required of the parallel joints j, k,
// l. Both elbow solutions are written into rows n and n + 1, with the other joints from l + 1 on, round the
// arm.
inline void planar_three(const DhForm& f, int j, const Posed& planar, const Turn<double> (&others)[3],
                         const ClosedFormSettings& settings, Branches<double>& out, int n) {
    const TwoLink<double> arm =
        two_link(planar.t.x, planar.t.y, f.a[j], f.a[j + 1], f.length, settings, settings.unconstrained[j]);
    const Turn<double> all = planar_turn(planar.R);
    for (int e = 0; e < 2; ++e) {
        out.t[n + e][j] = angle_of(arm.first[e]);
        out.t[n + e][j + 1] = angle_of(arm.elbow[e]);
        out.t[n + e][j + 2] = angle_of(all - (arm.first[e] + arm.elbow[e]));
        for (int i = 0; i < 3; ++i) out.t[n + e][(j + 3 + i) % 6] = angle_of(others[i]);
        out.ok[n + e] = arm.ok;
    }
}

inline TwoTurns both_angles(TwoTurnEquations e) {
    double largest = 0;
    for (int i = 0; i < 2; ++i)
        largest = max(largest, std::fabs(e.alpha[i]) + std::hypot(e.beta[i][0], e.beta[i][1]) +
                                   std::hypot(e.gamma[i][0], e.gamma[i][1]));
    for (int i = 0; i < 2; ++i) {
        e.alpha[i] /= largest;
        for (int k = 0; k < 2; ++k) {
            e.beta[i][k] /= largest;
            e.gamma[i][k] /= largest;
        }
    }
    return solve_two_turns(e);
}

// Axes 2, 3, 4 parallel, axes 5 and 6 separate: the height of axis 6 and its slope relative to n determine t1
// and t5.
inline Branches<double> solve_middle_parallel(const DhForm& f, const Posed& goal,
                                              const ClosedFormSettings& settings) {
    Branches<double> out{};
    out.doubt = true;
    const Vec3d p = goal.t, g = matrix_column(goal.R, 2);
    const double length = f.length, height = f.d[1] + f.d[2] + f.d[3] + f.ca[3] * f.d[4];
    const TwoTurns found =
        both_angles({{(f.ca[0] * p.z - height) / length, f.ca[0] * g.z - f.ca[3] * f.ca[4]},
                     {{-f.sa[0] * p.y / length, f.sa[0] * p.x / length}, {-f.sa[0] * g.y, f.sa[0] * g.x}},
                     {{0, -f.sa[3] * f.a[4] / length}, {f.sa[3] * f.sa[4], 0}}});
    for (int n = 0; n < found.count; ++n) {
        const Turn<double>&t1 = found.u[n], &t5 = found.w[n];
        const Posed seen = inverse(link_pose(f, 0, t1)) * goal;  // Rz(t2)…Rz(t4) · rest · Rz(t6)
        const Posed rest = Posed{link_pose(f, 3, {1, 0}).R, {f.a[3], 0, 0}} * link_pose(f, 4, t5);
        const Vec3d z = matrix_column(rest.R, 2), want = matrix_column(seen.R, 2);
        const Turn<double> t234 =
            align_turn(z.x, z.y, want.x, want.y, 1.0, settings, settings.unconstrained[3]).t;
        const Posed turned = {spatial::rotation_about(Vec3d{0, 0, 1}, t234.c, t234.s), {0, 0, 0}};
        const Turn<double> t6 = planar_turn(transpose((turned * rest).R) * seen.R);
        planar_three(f, 1, {turned.R, seen.t - turned.R * rest.t}, {t5, t6, t1}, settings, out, 2 * n);
    }
    return out;
}

// Axes 1, 2, 3 parallel: the slope of n relative to axis 5 and the height of the goal determine t4 and t6.
inline Branches<double> solve_first_parallel(const DhForm& f, const Posed& goal,
                                             const ClosedFormSettings& settings) {
    Branches<double> out{};
    out.doubt = true;
    const Vec3d r = matrix_row(goal.R, 2);
    const double length = f.length;
    const double height = f.d[1] + f.d[2] + f.ca[2] * f.d[3] + f.d[4] * f.ca[4] * r.z - goal.t.z;
    const TwoTurns found = both_angles({{r.z * f.ca[4] - f.ca[2] * f.ca[3], height / length},
                                        {{f.sa[2] * f.sa[3], 0}, {0, f.sa[2] * f.a[3] / length}},
                                        {{r.y * f.sa[4], r.x * f.sa[4]},
                                         {(f.a[4] * r.x + f.d[4] * f.sa[4] * r.y) / length,
                                          (-f.a[4] * r.y + f.d[4] * f.sa[4] * r.x) / length}}});
    for (int n = 0; n < found.count; ++n) {
        const Turn<double>&t4 = found.u[n], &t6 = found.w[n];
        const Posed to_four = Posed{link_pose(f, 2, {1, 0}).R, {f.a[2], 0, 0}} * link_pose(f, 3, t4);
        const Vec3d k = matrix_row(to_four.R, 2);
        const double x = r.x * t6.c - r.y * t6.s, y = r.x * t6.s + r.y * t6.c;
        // (k.x, k.y) turned by −t5 is (x, y cos α5 − rz sin α5).
        const Turn<double> t5 =
            align_turn(x, f.ca[4] * y - f.sa[4] * r.z, k.x, k.y, 1.0, settings, settings.unconstrained[4]).t;
        const Posed rest = to_four * link_pose(f, 4, t5) *
                           Posed{spatial::rotation_about(Vec3d{0, 0, 1}, t6.c, t6.s), {0, 0, 0}};
        planar_three(f, 0, goal * inverse(rest), {t4, t5, t6}, settings, out, 2 * n);
    }
    return out;
}

}  // namespace cspace::ik::inline CSPACE_ISA
