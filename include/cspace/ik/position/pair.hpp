// Two conditions f_i(q1) = g_i(q3), i = 0, 1, on the curves of the first and the last of three joints.
//
// Two circles: two_angles.hpp, a quartic. A circle and a line: eliminating the line's coordinate leaves a
// trigonometric polynomial of degree two in the angle (one, if both conditions are linear). Two lines: a line
// and a conic, or two lines. Conditions that are one: one_condition.hpp. The results are candidates, which
// are then refined on the arm itself. If none is a solution, further candidates represent a self-motion. The
// first joint is at zero if the last can follow; otherwise the last is at zero; otherwise either is where it
// is nearest to the middle joint.
#pragma once

#include "cspace/ik/position/one_condition.hpp"

namespace cspace::ik::inline CSPACE_ISA {

namespace pair {

// For a given value of one joint, the other from each condition that depends on it.
inline void follow_last(const OnCurve f[2], const OnCurve g[2], double first, PairCandidates& found) {
    for (int i = 0; i < 2; ++i) {
        double q[2];
        const int n = weight(g[i]) > tolerance::rounding ? values(g[i], value(f[i], first), q) : 0;
        for (int j = 0; j < n; ++j) add(found, first, q[j]);
    }
}
inline void follow_first(const OnCurve f[2], const OnCurve g[2], double last, PairCandidates& found) {
    PairCandidates swapped;
    follow_last(g, f, last, swapped);
    for (int i = 0; i < swapped.count; ++i) add(found, swapped.last[i], swapped.first[i]);
}

inline void two_circles(const OnCurve f[2], const OnCurve g[2], PairCandidates& found) {
    TwoTurnEquations e;
    for (int i = 0; i < 2; ++i) {
        e.alpha[i] = f[i].k - g[i].k;
        e.beta[i][0] = f[i].a, e.beta[i][1] = f[i].b;
        e.gamma[i][0] = -g[i].a, e.gamma[i][1] = -g[i].b;
    }
    const TwoTurns r = solve_two_turns(e);
    for (int i = 0; i < r.count; ++i) add(found, angle_of(r.u[i]), angle_of(r.w[i]));
}

// A circle f and a line g, conditions f_i = g_i with g_0 linear: g_0 = k + a q.
inline void circle_and_line(const OnCurve f[2], const OnCurve g[2], PairCandidates& found) {
    // L = f_0 − k_0 = a_0 q; then a_0² (f_1 − k_1) = a_0 a_1 L + square L².
    const double a0 = g[0].a, a1 = g[1].a, square = g[1].square;
    const double scale = 1 + square;
    const double l[3] = {f[0].k - g[0].k, f[0].a, f[0].b}, m[3] = {f[1].k - g[1].k, f[1].a, f[1].b};
    TrigPolynomial p;
    if (square == 0) {
        p = {a0 * m[0] - a1 * l[0], a0 * m[1] - a1 * l[1], a0 * m[2] - a1 * l[2], 0, 0};
    } else {
        p = product(l[0], l[1], l[2], -square * l[0], -square * l[1], -square * l[2]);
        p.a0 += a0 * (a0 * m[0] - a1 * l[0]);
        p.a1 += a0 * (a0 * m[1] - a1 * l[1]);
        p.b1 += a0 * (a0 * m[2] - a1 * l[2]);
    }
    const TrigRoots u = trig_roots(p, scale);
    for (int i = 0; i < u.count; ++i) follow_last(f, g, angle_of(u.theta[i]), found);
    if (std::fabs(a0) < tolerance::degenerate_pair) {
        // The first condition hardly sees the line: it gives the angle alone.
        double q[2];
        const int n = weight(f[0]) > tolerance::rounding ? values(f[0], g[0].k, q) : 0;
        for (int i = 0; i < n; ++i) follow_last(f, g, q[i], found);
    }
    if (std::fabs(a1) < tolerance::degenerate_pair && square == 0) {
        double q[2];
        const int n = weight(f[1]) > tolerance::rounding ? values(f[1], g[1].k, q) : 0;
        for (int i = 0; i < n; ++i) follow_last(f, g, q[i], found);
    }
}

// Lines f and g, the first condition linear on both; the second a conic or linear.
inline void two_lines(const OnCurve f[2], const OnCurve g[2], PairCandidates& found) {
    // f_0 − g_0 = k + a q1 − c q3 = 0 is the line (q1, q3) = foot + t (c, a) of that plane.
    const double k = f[0].k - g[0].k, a = f[0].a, c = g[0].a, size2 = a * a + c * c;
    if (size2 <= tolerance::rounding * tolerance::rounding) return;
    const double foot1 = -k * a / size2, foot3 = k * c / size2;
    OnCurve along = {true, value(f[1], foot1) - value(g[1], foot3), 0, 0, 0};
    along.a = c * (f[1].a + 2 * f[1].square * foot1) - a * (g[1].a + 2 * g[1].square * foot3);
    along.square = f[1].square * c * c - g[1].square * a * a;
    double t[2] = {0, 0};
    const int n = weight(along) > tolerance::rounding ? values_on_line(along, 0, t) : 1;
    for (int i = 0; i < n; ++i) add(found, foot1 + t[i] * c, foot3 + t[i] * a);
}

}  // namespace pair

// Candidates (q1, q3) for f_i(q1) = g_i(q3); f_0 and g_0 have no square.
inline PairCandidates solve_pair(const OnCurve f[2], const OnCurve g[2]) {
    using namespace pair;
    PairCandidates found;
    int k;
    if (is_one_condition(f, g, k)) {
        on_every_curve(f[k], g[k], found);
    } else if (!f[0].line && !g[0].line) {
        two_circles(f, g, found);
    } else if (!f[0].line) {
        circle_and_line(f, g, found);
    } else if (!g[0].line) {
        PairCandidates swapped;
        circle_and_line(g, f, swapped);
        for (int i = 0; i < swapped.count; ++i) add(found, swapped.last[i], swapped.first[i]);
    } else {
        two_lines(f, g, found);
    }
    found.now = 1;
    follow_last(f, g, 0, found);
    found.now = 2;
    follow_first(f, g, 0, found);
    found.now = 3;
    follow_last(f, g, vertex(f[1]), found);
    follow_first(f, g, vertex(g[1]), found);
    add(found, 0, 0);
    return found;
}

}  // namespace cspace::ik::inline CSPACE_ISA
