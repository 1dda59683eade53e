// Every real root of a polynomial of degree one to four.
//
// A quadratic is solved in closed form, on lanes. For cubics and quartics the real roots of the derivative
// cut the line into pieces on which the polynomial rises or falls throughout (Rolle): each piece contains one
// simple root if the signs at its ends differ, and none otherwise. Halley's method inside such a bracket,
// with bisection where it stalls, cannot miss a root or find one twice, however close they lie. Multiple
// roots are roots of the derivative too: a point where the derivative vanishes and the polynomial is zero
// within rounding, or so close that a conjugate pair hangs over it at a distance below
// tolerance::double_root, is reported once with its multiplicity.
#pragma once

#include <cstring>

#include "cspace/math/lanes.hpp"
#include "cspace/tolerances.hpp"

namespace cspace {

// Ascending; `everywhere` if the polynomial is zero. multiplicity 2 also denotes a pair that is complex by
// less than the band.
struct RealRoots {
    int count = 0;
    double x[4] = {};
    int multiplicity[4] = {};
    bool everywhere = false;
};

// x[0] ≤ x[1]. If `real` is false, both are the real part of the conjugate pair.
template <class V>
struct QuadraticRoots {
    V x[2];
    mask_of<V> real, two;
};

}  // namespace cspace

namespace cspace::inline CSPACE_ISA {

// x² + 2 h x + c = 0 rounded once per operation would lose half the digits of h² − c near a double root; the
// fused multiply-add returns the rounding error of each product (Kahan 2004).
template <class V>
CSPACE_INLINE V product_difference(V a, V b, V c, V d) {
    V r;
    for (int i = 0; i < Lanes<V>::count; ++i) {
        const double cd = get_lane(c, i) * get_lane(d, i),
                     lost = std::fma(-get_lane(c, i), get_lane(d, i), cd);
        set_lane(r, i, std::fma(get_lane(a, i), get_lane(b, i), -cd) + lost);
    }
    return r;
}

// a x² + b x + c with a ≠ 0. unit: a size, in addition to that of the root, against which the band is
// measured.
template <class V>
CSPACE_INLINE QuadraticRoots<V> quadratic_roots(V a, V b, V c, double unit = 0.0) {
    const V zero = fill_lanes<V>(0.0), one = fill_lanes<V>(1.0), h = 0.5 * b;
    const V inside = product_difference(h, h, a, c);
    const V root = sqrt(max(inside, zero));
    const V q = -(h + copysign(root, h)), middle = -h / a;
    const V distant = q / a, near = select_lanes(q == zero, zero, c / select_lanes(q == zero, one, q));
    const V band = tolerance::double_root * max(abs(middle), fill_lanes<V>(unit)) * a;
    QuadraticRoots<V> r;
    r.two = inside > zero;
    r.real = inside > -(band * band) || inside == zero;
    r.x[0] = select_lanes(r.two, min(distant, near), middle);
    r.x[1] = select_lanes(r.two, max(distant, near), middle);
    return r;
}

namespace polynomial {

// a[0] + a[1] x + … + a[n] xⁿ, each coefficient known up to ±error[i].
template <int n>
struct Uncertain {
    double a[n + 1], error[n + 1];
};
struct Value {
    double value, slope, bend, noise;  // p, p′, p″/2, and the error bound of p
};
// What Horner's rule loses, relative to each coefficient.
template <int n>
inline constexpr double evaluation_error = 2.0 * n * std::numeric_limits<double>::epsilon();
template <int n>
CSPACE_INLINE Value evaluate_polynomial(const Uncertain<n>& p, double x) {
    double value = p.a[n], slope = 0, bend = 0, noise = p.error[n];
    for (int i = n - 1; i >= 0; --i) {
        bend = bend * x + slope;
        slope = slope * x + value;
        value = value * x + p.a[i];
        noise = noise * std::fabs(x) + p.error[i];
    }
    return {value, slope, bend, noise};
}

// The number in the middle of the list of all floating-point numbers between lower and upper: 64 halvings
// exhaust any interval, whatever its scale.
inline double middle_number(double lower, double upper) {
    const double low = std::fabs(lower), high = std::fabs(upper);
    if (lower < 0 && upper > 0) return 0.0;
    if (low < 4 * high && high < 4 * low) return 0.5 * (lower + upper);
    std::uint64_t i, j;
    std::memcpy(&i, &low, 8);
    std::memcpy(&j, &high, 8);
    const std::uint64_t half = i / 2 + j / 2 + (i & j & 1);
    double r;
    std::memcpy(&r, &half, 8);
    return lower < 0 || upper < 0 ? -r : r;
}

// The root between lower and upper, where the polynomial has the signs −rising and +rising.
template <int n>
double bracketed_root(const Uncertain<n>& polynomial, double lower, double upper, double rising) {
    double x = middle_number(lower, upper), last_step = upper - lower;
    for (int i = 0; i < 200; ++i) {
        const Value p = evaluate_polynomial(polynomial, x);
        if (p.value == 0) return x;
        (p.value * rising < 0 ? lower : upper) = x;
        const double halley = p.slope * p.slope - p.value * p.bend;
        const double step = halley != 0 ? -p.value * p.slope / halley : last_step;
        double next = x + step;
        const bool rests = next == x;  // at a root, or where the slope vanishes and Halley's step with it
        if (rests && std::fabs(p.value) <= p.noise) return x;
        const bool stalls = std::fabs(step) > 0.5 * std::fabs(last_step);
        if (rests || !(next > lower && next < upper) || (stalls && i % 3 == 2))
            next = middle_number(lower, upper);
        if (next == lower || next == upper) return next;
        last_step = next - x;
        x = next;
    }
    return x;
}

inline void append_root(RealRoots& roots, double x, int multiplicity) {
    roots.x[roots.count] = x;
    roots.multiplicity[roots.count++] = multiplicity;
}

// The sign of the polynomial at a root of its derivative: 0 where it makes a multiple root.
template <int n>
int sign_at_turning_point(const Uncertain<n>& polynomial, double x, double unit) {
    const Value p = evaluate_polynomial(polynomial, x);
    const double band = tolerance::double_root * std::fmax(std::fabs(x), unit);
    const bool conjugate_pair = p.value * p.bend > 0 && std::fabs(p.value) <= std::fabs(p.bend) * band * band;
    if (std::fabs(p.value) <= p.noise || conjugate_pair) return 0;
    return p.value > 0 ? 1 : -1;
}

// All roots lie within (−bound, bound); `turns` are the real roots of the derivative.
template <int n>
RealRoots roots_between(const Uncertain<n>& p, const RealRoots& turns, double bound, double unit) {
    RealRoots roots;
    const int at_right = p.a[n] > 0 ? 1 : -1, at_left = n % 2 ? -at_right : at_right;
    const auto sign_at = [&](int i) {
        return i < turns.count ? sign_at_turning_point(p, turns.x[i], unit) : at_right;
    };
    double lower = -bound;
    int before = at_left;
    for (int i = 0; i <= turns.count;) {
        int sign = sign_at(i), many = 0;
        double sum = 0;
        while (sign == 0) {
            many += turns.multiplicity[i];
            sum += turns.multiplicity[i] * turns.x[i];
            sign = sign_at(++i);
        }
        if (many > 0) {  // the next turning point, not yet passed, has the sign of this side
            const int crosses = sign != before;
            append_root(roots, sum / many, many + 1 + ((many + 1) % 2 != crosses));
            lower = turns.x[i - 1];
        } else {
            const double x = i < turns.count ? turns.x[i] : bound;
            if (sign != before) append_root(roots, bracketed_root(p, lower, x, sign), 1);
            lower = x;
            ++i;
        }
        before = sign;
    }
    return roots;
}

inline RealRoots quadratic(const Uncertain<2>& p, double unit) {
    RealRoots roots;
    const QuadraticRoots<double> r = quadratic_roots(p.a[2], p.a[1], p.a[0], unit);
    if (r.two)
        append_root(roots, r.x[0], 1), append_root(roots, r.x[1], 1);
    else if (r.real)
        append_root(roots, r.x[0], 2);
    return roots;
}

// Degree n ≥ 1 with a[n] ≠ 0 and every root within (−bound, bound).
template <int n>
RealRoots bounded_roots(const Uncertain<n>& p, double bound, double unit) {
    if constexpr (n == 1) {
        RealRoots roots;
        append_root(roots, -p.a[0] / p.a[1], 1);
        return roots;
    } else if constexpr (n == 2) {
        return quadratic(p, unit);
    } else {
        Uncertain<n - 1> derivative;
        for (int i = 0; i < n; ++i) {
            derivative.a[i] = (i + 1) * p.a[i + 1];
            derivative.error[i] = (i + 1) * p.error[i + 1];
        }
        const RealRoots turns = bounded_roots(derivative, bound, unit);
        return roots_between(p, turns, bound, unit);
    }
}

}  // namespace polynomial

}  // namespace cspace::inline CSPACE_ISA
