// Where the two conditions on q1 and q3 are one, f(q1) = g(q3): one pair (q1, q3) on each of its curves.
//
// Both sides rise and fall once, over a circle between two extremes, along a line above one or without end.
// If the values of one side lie within those of the other, its joint is free to take any value and the other
// follows on either slope: two curves (or one, where there is a single slope). If they only overlap, both
// joints turn back where a side ends, and the curve is one: that of a four-bar whose links satisfy Grashof's
// condition in the first case and do not in the second (Grashof 1883).
#pragma once

#include "cspace/ik/position/values.hpp"

namespace cspace::inline CSPACE_ISA {

namespace pair {

struct Range {
    double least, most;
};
// Whether a side has an end: over a circle it has two, over a line one or none; a side that rests has none.
inline bool has_end(const OnCurve& f) {
    return (f.line ? f.square : std::hypot(f.a, f.b)) > tolerance::rounding;
}
inline Range range(const OnCurve& f) {
    constexpr double without_end = std::numeric_limits<double>::infinity();
    if (!f.line) {
        const double reach = std::hypot(f.a, f.b);
        return {f.k - reach, f.k + reach};
    }
    if (!has_end(f)) return {-without_end, without_end};
    return {f.k - f.a * f.a / (4 * f.square), without_end};
}
// Where ends nearly touch, curves nearly cross, and who follows one of them may change to another: they are
// told apart as if they did.
inline bool is_within(const Range& inner, const Range& outer) {
    constexpr double nearly = 1e-8;
    return inner.least >= outer.least - nearly && inner.most <= outer.most + nearly;
}
inline bool holds(const Range& r, double value) {
    return value >= r.least - tolerance::rounding && value <= r.most + tolerance::rounding;
}

// The values of a joint from where the side of its condition rises: its greatest value, or its least.
inline double at_most(const OnCurve& f) { return f.line ? vertex(f) : std::atan2(f.b, f.a); }
inline double at_least(const OnCurve& f) { return f.line ? vertex(f) : std::atan2(-f.b, -f.a); }

// Whether conditions f_i = g_i are one; `k` is then the number of the one that says something.
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
           weight(f[k]) + weight(g[k]) > tolerance::rounding;
}

// Where an end of f is an end of g, two curves cross there, or one crosses itself: both joints move, either
// slope of one with either slope of the other.
struct Touching {
    bool most, least;
};
inline Touching touching(const Range& f, const Range& g) {
    const auto same = [](double a, double b) { return std::fabs(a - b) <= tolerance::rounding; };
    return {same(f.most, g.most), same(f.least, g.least)};
}

// Whether a joint stands near an end of its side, where curves may cross or nearly do.
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

// One pair per curve of f(q1) = g(q3), no crossing of two: a joint that is free at 0, or a quarter of a turn
// from an end; else the first at 0, or the last at 0, or both sides halfway between the ends of their curve.
inline void on_every_curve(const OnCurve& f, const OnCurve& g, PairCandidates& found) {
    const Range of_f = range(f), of_g = range(g);
    const Touching ends = touching(of_f, of_g);
    // The two slopes of a side are one curve that passes from one to the other where it crosses itself.
    const bool once = (!f.line || !g.line) && ends.most != ends.least;
    double q[2];
    if (is_within(of_f, of_g)) {
        const double first = away_from_ends(f);
        const int n = values(g, value(f, first), q);
        for (int i = 0; i < (once ? 1 : n); ++i) add(found, first, q[i]);
    } else if (is_within(of_g, of_f)) {
        const double last = away_from_ends(g);
        const int n = values(f, value(g, last), q);
        for (int i = 0; i < (once ? 1 : n); ++i) add(found, q[i], last);
    } else if (!is_near_end(f, 0) && holds(of_g, value(f, 0))) {
        if (values(g, value(f, 0), q) > 0) add(found, 0, q[0]);
    } else if (!is_near_end(g, 0) && holds(of_f, value(g, 0))) {
        if (values(f, value(g, 0), q) > 0) add(found, q[0], 0);
    } else {
        const double least = std::fmax(of_f.least, of_g.least), most = std::fmin(of_f.most, of_g.most);
        const double halfway = 0.5 * (least + most);
        double first[2], last[2];
        if (values(f, halfway, first) > 0 && values(g, halfway, last) > 0) add(found, first[0], last[0]);
    }
    // Where both sides are least, both points may lie on the axis between, whose joint is then free.
    if (!ends.least) return;
    const int next = found.count;
    add(found, at_least(f), at_least(g));
    if (found.count > next) found.on_axis = next;
}

}  // namespace pair

}  // namespace cspace::inline CSPACE_ISA
