// Two conditions f_i(q1) = g_i(q3), i = 0, 1, on the curves of the first and the last of three joints.
//
// Two circles: two_angles.hpp, a quartic. A circle and a line: eliminating the line's coordinate leaves a
// trigonometric polynomial of degree two in the angle (one, if both conditions are linear). Two lines: a line
// and a conic, or two lines. Conditions that are one: see below. The results are candidates, which
// are then refined on the arm itself. If none is a solution, further candidates represent a self-motion. The
// first joint is at zero if the last can follow; otherwise the last is at zero; otherwise either is where it
// is nearest to the middle joint.
#pragma once

#include "cspace/ik/position/curve.hpp"

namespace cspace::ik::inline CSPACE_ISA {

// Degenerate pair of conditions: the two conditions on q1 and q3 are equivalent to one, f(q1) = g(q3). One
// pair (q1, q3) is returned for each curve of solutions.
//
// On a circle each side is monotonic between its minimum and its maximum. On a line a side has one extremum
// or none. If the range of one side lies within the range of the other, its joint can take any value. The
// other joint follows on either slope: two curves (or one curve, if there is a single slope). If the ranges
// only overlap, both joints reverse where a range ends, and there is one curve. These are the curves of a
// four-bar linkage: the first case satisfies Grashof's condition, the second does not (Grashof 1883).

namespace pair {

struct Range {
    double least, most;
};
// Whether a side has an extremum. On a circle it has two, on a line one or none; a constant side has none.
inline bool has_end(const OnCurve& f) {
    return (f.line ? f.square : std::hypot(f.a, f.b)) > tolerance::rounding;
}
inline Range value_range(const OnCurve& f) {
    constexpr double without_end = std::numeric_limits<double>::infinity();
    if (!f.line) {
        const double reach = std::hypot(f.a, f.b);
        return {f.k - reach, f.k + reach};
    }
    if (!has_end(f)) return {-without_end, without_end};
    return {f.k - f.a * f.a / (4 * f.square), without_end};
}
// Where ends nearly coincide, curves nearly cross, and a continuation may switch between them. They are
// distinguished as if they crossed.
inline bool is_within(const Range& inner, const Range& outer) {
    constexpr double nearly = 1e-8;
    return inner.least >= outer.least - nearly && inner.most <= outer.most + nearly;
}
inline bool holds_value(const Range& r, double value) {
    return value >= r.least - tolerance::rounding && value <= r.most + tolerance::rounding;
}

// The joint value at the extremum of its side: the maximum, or the minimum.
inline double at_most(const OnCurve& f) { return f.line ? vertex_of(f) : std::atan2(f.b, f.a); }
inline double at_least(const OnCurve& f) { return f.line ? vertex_of(f) : std::atan2(-f.b, -f.a); }

// Whether the conditions f_i = g_i are equivalent to one; `k` is then the number of the non-trivial one.
inline bool is_one_condition(const OnCurve f[2], const OnCurve g[2], int& k) {
    double v[2][7], size[2] = {0, 0}, both = 0;
    for (int i = 0; i < 2; ++i) {
        const double terms[7] = {f[i].k - g[i].k, f[i].a, f[i].b, f[i].square, g[i].a, g[i].b, g[i].square};
        for (int j = 0; j < 7; ++j) v[i][j] = terms[j], size[i] += terms[j] * terms[j];
    }
    k = size[1] > size[0];
    if (size[k] <= tolerance::rounding * tolerance::rounding) return false;
    for (int j = 0; j < 7; ++j) both += v[0][j] * v[1][j];
    double apart = 0;
    for (int j = 0; j < 7; ++j) {
        const double d = v[1 - k][j] - both / size[k] * v[k][j];
        apart += d * d;
    }
    return apart <= tolerance::rounding * tolerance::rounding &&
           weight_of(f[k]) + weight_of(g[k]) > tolerance::rounding;
}

// Where an extremum of f coincides with an extremum of g, two curves cross, or one curve crosses itself. Both
// joints move, and either slope of one combines with either slope of the other.
struct Touching {
    bool most, least;
};
inline Touching touching_ends(const Range& f, const Range& g) {
    const auto same = [](double a, double b) { return std::fabs(a - b) <= tolerance::rounding; };
    return {same(f.most, g.most), same(f.least, g.least)};
}

// Whether a joint is near an extremum of its side, where curves may cross or nearly cross.
inline bool is_near_end(const OnCurve& f, double q) {
    constexpr double near = 0.3;
    const double way = q - at_most(f);
    return has_end(f) && std::fabs(f.line ? way : std::sin(way)) < near;
}
inline double away_from_ends(const OnCurve& f) {
    constexpr double line_away = 1;  // of the arm's size
    if (!is_near_end(f, 0)) return 0;
    return at_most(f) + (f.line ? line_away : 0.5 * pi);
}

// One pair per curve of f(q1) = g(q3), away from crossings of two curves. An unconstrained joint is at 0, or
// at π/2 from an extremum. Otherwise the first joint is at 0, or the last joint is at 0, or both sides are
// halfway between the ends of their curve.
inline void on_every_curve(const OnCurve& f, const OnCurve& g, PairCandidates& found) {
    const Range of_f = value_range(f), of_g = value_range(g);
    const Touching ends = touching_ends(of_f, of_g);
    // The two slopes of a side are one curve that passes from one to the other where it crosses itself.
    const bool once = (!f.line || !g.line) && ends.most != ends.least;
    double q[2];
    if (is_within(of_f, of_g)) {
        const double first = away_from_ends(f);
        const int n = values_on_curve(g, value_at(f, first), q);
        for (int i = 0; i < (once ? 1 : n); ++i) add_pair(found, first, q[i]);
    } else if (is_within(of_g, of_f)) {
        const double last = away_from_ends(g);
        const int n = values_on_curve(f, value_at(g, last), q);
        for (int i = 0; i < (once ? 1 : n); ++i) add_pair(found, q[i], last);
    } else if (!is_near_end(f, 0) && holds_value(of_g, value_at(f, 0))) {
        if (values_on_curve(g, value_at(f, 0), q) > 0) add_pair(found, 0, q[0]);
    } else if (!is_near_end(g, 0) && holds_value(of_f, value_at(g, 0))) {
        if (values_on_curve(f, value_at(g, 0), q) > 0) add_pair(found, q[0], 0);
    } else {
        const double least = std::fmax(of_f.least, of_g.least), most = std::fmin(of_f.most, of_g.most);
        const double halfway = 0.5 * (least + most);
        double first[2], last[2];
        if (values_on_curve(f, halfway, first) > 0 && values_on_curve(g, halfway, last) > 0)
            add_pair(found, first[0], last[0]);
    }
    // Where both sides are least, both points may lie on the axis between, whose joint is then free.
    if (!ends.least) return;
    const int next = found.count;
    add_pair(found, at_least(f), at_least(g));
    if (found.count > next) found.on_axis = next;
}

}  // namespace pair

namespace pair {

inline void add_swapped(const PairCandidates& swapped, PairCandidates& found) {
    for (int i = 0; i < swapped.count; ++i) add_pair(found, swapped.last[i], swapped.first[i]);
}
// For a given value of one joint, the other from each condition that depends on it.
inline void follow_last(const OnCurve f[2], const OnCurve g[2], double first, PairCandidates& found) {
    for (int i = 0; i < 2; ++i) {
        double q[2];
        const int n =
            weight_of(g[i]) > tolerance::rounding ? values_on_curve(g[i], value_at(f[i], first), q) : 0;
        for (int j = 0; j < n; ++j) add_pair(found, first, q[j]);
    }
}
inline void follow_first(const OnCurve f[2], const OnCurve g[2], double last, PairCandidates& found) {
    PairCandidates swapped;
    follow_last(g, f, last, swapped);
    add_swapped(swapped, found);
}

inline void two_circles(const OnCurve f[2], const OnCurve g[2], PairCandidates& found) {
    TwoTurnEquations e;
    for (int i = 0; i < 2; ++i) {
        e.alpha[i] = f[i].k - g[i].k;
        e.beta[i][0] = f[i].a, e.beta[i][1] = f[i].b;
        e.gamma[i][0] = -g[i].a, e.gamma[i][1] = -g[i].b;
    }
    const TwoTurns r = solve_two_turns(e);
    for (int i = 0; i < r.count; ++i) add_pair(found, angle_of(r.u[i]), angle_of(r.w[i]));
}

// A circle f and a line g, conditions f_i = g_i with g_0 linear: g_0 = k + a q.
inline void circle_and_line(const OnCurve f[2], const OnCurve g[2], PairCandidates& found) {
    // L = f_0 − k_0 = a_0 q; then a_0² (f_1 − k_1) = a_0 a_1 L + square L².
    const double a0 = g[0].a, a1 = g[1].a, square = g[1].square;
    const double scale = 1 + square;
    const LinearInTurn l = {f[0].k - g[0].k, f[0].a, f[0].b}, m = {f[1].k - g[1].k, f[1].a, f[1].b};
    const LinearInTurn n = a0 * m + -a1 * l;
    const TrigPolynomial p =
        square == 0 ? product({1, 0, 0}, n) : product({a0, 0, 0}, n) + product(-square * l, l);
    const TrigRoots u = trig_roots(p, scale);
    for (int i = 0; i < u.count; ++i) follow_last(f, g, angle_of(u.theta[i]), found);
    // A condition that hardly sees the line gives the angle alone.
    for (int k = 0; k < 2; ++k) {
        if (!(std::fabs(g[k].a) < tolerance::degenerate_pair) || g[k].square != 0) continue;
        double q[2];
        const int n = weight_of(f[k]) > tolerance::rounding ? values_on_curve(f[k], g[k].k, q) : 0;
        for (int i = 0; i < n; ++i) follow_last(f, g, q[i], found);
    }
}

// Lines f and g, the first condition linear on both; the second a conic or linear.
inline void two_lines(const OnCurve f[2], const OnCurve g[2], PairCandidates& found) {
    // f_0 − g_0 = k + a q1 − c q3 = 0 is the line (q1, q3) = foot + t (c, a) of that plane.
    const double k = f[0].k - g[0].k, a = f[0].a, c = g[0].a, size2 = a * a + c * c;
    if (size2 <= tolerance::rounding * tolerance::rounding) return;
    const double foot1 = -k * a / size2, foot3 = k * c / size2;
    OnCurve along = {true, value_at(f[1], foot1) - value_at(g[1], foot3), 0, 0, 0};
    along.a = c * (f[1].a + 2 * f[1].square * foot1) - a * (g[1].a + 2 * g[1].square * foot3);
    along.square = f[1].square * c * c - g[1].square * a * a;
    double t[2] = {0, 0};
    const int n = weight_of(along) > tolerance::rounding ? values_on_line(along, 0, t) : 1;
    for (int i = 0; i < n; ++i) add_pair(found, foot1 + t[i] * c, foot3 + t[i] * a);
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
        add_swapped(swapped, found);
    } else {
        two_lines(f, g, found);
    }
    found.now = 1;
    follow_last(f, g, 0, found);
    found.now = 2;
    follow_first(f, g, 0, found);
    found.now = 3;
    follow_last(f, g, vertex_of(f[1]), found);
    follow_first(f, g, vertex_of(g[1]), found);
    add_pair(found, 0, 0);
    return found;
}

}  // namespace cspace::ik::inline CSPACE_ISA
