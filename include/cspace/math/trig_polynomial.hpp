// The real roots of a trigonometric polynomial of degree two in one angle.
//
//     f(θ) = a0 + a1 cos θ + b1 sin θ + a2 cos 2θ + b2 sin 2θ
//
// With t = tan(φ/2), (1 + t²)² f is a quartic in t whose leading coefficient is f at φ = π. The origin of φ
// is turned so that this is the largest of five evenly spaced values of f: these five determine f, so the
// leading coefficient is small only if all of f is, and no root escapes to infinity. At most four roots.
#pragma once

#include "cspace/math/polynomial.hpp"
#include "cspace/math/turn.hpp"

namespace cspace {

struct TrigPolynomial {
    double a0, a1, b1, a2, b2;
};
// k + c cos θ + s sin θ
struct LinearInTurn {
    double k, c, s;
};
// `everywhere` if f is zero for every angle. multiplicity as in RealRoots.
struct TrigRoots {
    int count = 0;
    Turn<double> theta[4] = {};
    int multiplicity[4] = {};
    bool everywhere = false;
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

inline double evaluate_polynomial(const TrigPolynomial& f, const Turn<double>& t) {
    const Turn<double> twice = t + t;
    return f.a0 + f.a1 * t.c + f.b1 * t.s + f.a2 * twice.c + f.b2 * twice.s;
}
inline double slope_at(const TrigPolynomial& f, const Turn<double>& t) {
    const Turn<double> twice = t + t;
    return f.b1 * t.c - f.a1 * t.s + 2 * (f.b2 * twice.c - f.a2 * twice.s);
}
// φ ↦ f(origin + φ).
inline TrigPolynomial seen_from(const Turn<double>& origin, const TrigPolynomial& f) {
    const Turn<double> o = origin, oo = o + o;
    return {f.a0, f.a1 * o.c + f.b1 * o.s, f.b1 * o.c - f.a1 * o.s, f.a2 * oo.c + f.b2 * oo.s,
            f.b2 * oo.c - f.a2 * oo.s};
}
inline TrigPolynomial operator+(const TrigPolynomial& f, const TrigPolynomial& g) {
    return {f.a0 + g.a0, f.a1 + g.a1, f.b1 + g.b1, f.a2 + g.a2, f.b2 + g.b2};
}
inline LinearInTurn operator+(const LinearInTurn& f, const LinearInTurn& g) {
    return {f.k + g.k, f.c + g.c, f.s + g.s};
}
inline LinearInTurn operator*(double factor, const LinearInTurn& f) {
    return {factor * f.k, factor * f.c, factor * f.s};
}
inline TrigPolynomial product(const LinearInTurn& f, const LinearInTurn& g) {
    return {f.k * g.k + 0.5 * (f.c * g.c + f.s * g.s), f.k * g.c + f.c * g.k, f.k * g.s + f.s * g.k,
            0.5 * (f.c * g.c - f.s * g.s), 0.5 * (f.c * g.s + f.s * g.c)};
}

// One Newton step on the circle, kept if it brings f closer to zero.
inline Turn<double> polish_root(const TrigPolynomial& f, const Turn<double>& t) {
    const double value = evaluate_polynomial(f, t), rise = slope_at(f, t);
    if (rise == 0) return t;
    const double step = -value / rise, length = std::sqrt(1 + step * step);
    const Turn<double> next = t + Turn<double>{1 / length, step / length};
    return std::fabs(evaluate_polynomial(f, next)) < std::fabs(value) ? next : t;
}

// scale: the size of the numbers the coefficients were made of; f within rounding of it counts as zero.
inline TrigRoots trig_roots(const TrigPolynomial& f, double scale = 0.0) {
    TrigRoots roots;
    const double largest_coefficient =
        std::fmax(std::fmax(std::fabs(f.a0), std::fmax(std::fabs(f.a1), std::fabs(f.b1))),
                  std::fmax(std::fabs(f.a2), std::fabs(f.b2)));
    roots.everywhere = largest_coefficient <= tolerance::rounding * scale;
    if (roots.everywhere) return roots;

    constexpr double fifths[5][2] = {{1.0, 0.0},
                                     {0.30901699437494742, 0.95105651629515357},
                                     {-0.80901699437494742, 0.58778525229247313},
                                     {-0.80901699437494742, -0.58778525229247313},
                                     {0.30901699437494742, -0.95105651629515357}};
    Turn<double> origin{};
    double largest = -1;
    for (const auto& v : fifths) {
        const double size = std::fabs(evaluate_polynomial(f, {v[0], v[1]}));
        if (size > largest) largest = size, origin = {-v[0], -v[1]};
    }
    const TrigPolynomial g = seen_from(origin, f);
    const double q[5] = {g.a0 + g.a1 + g.a2, 2 * g.b1 + 4 * g.b2, 2 * g.a0 - 6 * g.a2, 2 * g.b1 - 4 * g.b2,
                         g.a0 - g.a1 + g.a2};
    polynomial::Uncertain<4> quartic;
    double bound = 0;
    for (int i = 0; i < 5; ++i) {
        quartic.a[i] = q[i] / largest_coefficient;
        quartic.error[i] = polynomial::evaluation_error<4>;
        if (i < 4) bound = std::fmax(bound, std::fabs(quartic.a[i]));
    }
    // Every root lies within Cauchy's bound 1 + max |a_i / a_4|.
    const RealRoots tangents = polynomial::bounded_roots(quartic, 1 + bound / std::fabs(quartic.a[4]), 1.0);
    for (int i = 0; i < tangents.count; ++i) {
        const double t = tangents.x[i], inverse = 1 / (1 + t * t);
        Turn<double> root = origin + Turn<double>{(1 - t * t) * inverse, 2 * t * inverse};
        if (tangents.multiplicity[i] == 1) root = polish_root(f, polish_root(f, root));
        roots.theta[roots.count] = root;
        roots.multiplicity[roots.count++] = tangents.multiplicity[i];
    }
    return roots;
}

}  // namespace cspace::inline CSPACE_ISA
