// Values of the first and the last of three joints that satisfy one condition on both.
#pragma once

#include "cspace/ik/position/curve.hpp"
#include "cspace/ik/subproblems/two_angles.hpp"

namespace cspace::ik {

struct PairCandidates {
    int count = 0;
    double first[48], last[48];
    int stage[48];  // 0: from the conditions; later ones represent families
    int now = 0;
    int on_axis = -1;  // the one where both points may lie on the axis between
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline void add(PairCandidates& found, double first, double last) {
    if (found.count == 48 || !std::isfinite(first) || !std::isfinite(last)) return;
    found.first[found.count] = first;
    found.stage[found.count] = found.now;
    found.last[found.count++] = last;
}

namespace pair {

// The q with f(q) = target on a line: at most two. If a parabola does not reach the target, its vertex is
// returned.
inline int values_on_line(const OnCurve& f, double target, double* q) {
    const double k = f.k - target;
    if (std::fabs(f.square) <= tolerance::rounding) {
        if (std::fabs(f.a) <= tolerance::rounding) return 0;
        q[0] = -k / f.a;
        return 1;
    }
    const QuadraticRoots<double> r = quadratic_roots(f.square, f.a, k, 1.0);
    q[0] = r.x[0], q[1] = r.x[1];
    return r.two ? 2 : 1;
}
inline int values_on_circle(const OnCurve& f, double target, double* q) {
    const CosSinRoots<double> r = cos_sin_roots(f.a, f.b, target - f.k, 1.0);
    q[0] = angle_of(r.theta[0]), q[1] = angle_of(r.theta[1]);
    return r.two ? 2 : 1;
}
inline int values(const OnCurve& f, double target, double* q) {
    return f.line ? values_on_line(f, target, q) : values_on_circle(f, target, q);
}
inline double value(const OnCurve& f, double q) {
    if (f.line) return f.k + q * (f.a + q * f.square);
    double s, c;
    sincos(q, s, c);
    return f.k + c * f.a + s * f.b;
}
inline double weight(const OnCurve& f) { return std::fabs(f.a) + std::fabs(f.b) + std::fabs(f.square); }

// The lowest point of a parabola, or zero.
inline double vertex(const OnCurve& f) { return f.line && f.square > 0 ? -f.a / (2 * f.square) : 0; }

}  // namespace pair

}  // namespace cspace::ik::inline CSPACE_ISA
