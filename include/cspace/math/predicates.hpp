// Decisions about points of the plane that rounding cannot turn: an estimate with a bound of its error, and
// where that leaves the sign open, sums without rounding (Shewchuk 1997, "Adaptive precision floating-point
// arithmetic and fast robust geometric predicates"). Exact where no product overflows or underflows.
#pragma once

#include <cmath>

#include "cspace/math/isa.hpp"
#include "cspace/math/plane.hpp"

namespace cspace {

namespace exact {

// a + b = sum + rest, without rounding (Knuth).
struct Pair {
    double sum, rest;
};
inline Pair two_sum(double a, double b) {
    const double sum = a + b, b_part = sum - a;
    return {sum, (a - (sum - b_part)) + (b - b_part)};
}
inline Pair two_product(double a, double b) {
    const double product = a * b;
    return {product, std::fma(a, b, -product)};
}

// A sum of up to N numbers kept without rounding: parts that do not overlap, the largest last.
template <int N>
struct Expansion {
    double part[N];
    int size = 0;

    void add(double b) {
        int kept = 0;
        for (int i = 0; i < size; ++i) {
            const Pair s = two_sum(b, part[i]);
            if (s.rest != 0) part[kept++] = s.rest;
            b = s.sum;
        }
        if (b != 0) part[kept++] = b;
        size = kept;
    }
    void add_product(double a, double b) {
        const Pair p = two_product(a, b);
        add(p.rest);
        add(p.sum);
    }
    int sign() const { return size == 0 ? 0 : part[size - 1] > 0 ? 1 : -1; }
};

inline int sign(double value) { return (value > 0) - (value < 0); }

// The sign of a·b − c·d; rounding keeps the order of products, so equal ones are compared by their
// remainders.
inline int sign_of_difference(double a, double b, double c, double d) {
    const Pair left = two_product(a, b), right = two_product(c, d);
    return left.sum != right.sum ? sign(left.sum - right.sum) : sign(left.rest - right.rest);
}

inline Expansion<12> expanded_determinant(Point a, Point b, Point c) {
    Expansion<12> det;
    det.add_product(a.x, b.y);
    det.add_product(-a.y, b.x);
    det.add_product(b.x, c.y);
    det.add_product(-b.y, c.x);
    det.add_product(c.x, a.y);
    det.add_product(-c.y, a.x);
    return det;
}

// Calls with_differences(a − c, b − c) where these are exact, else with_expansion().
template <class WithDifferences, class WithExpansion>
auto with_exact_differences(Point a, Point b, Point c, WithDifferences with_differences,
                            WithExpansion with_expansion) {
    const Pair ax = two_sum(a.x, -c.x), ay = two_sum(a.y, -c.y);
    const Pair bx = two_sum(b.x, -c.x), by = two_sum(b.y, -c.y);
    if (ax.rest == 0 && ay.rest == 0 && bx.rest == 0 && by.rest == 0)
        return with_differences(Point{ax.sum, ay.sum}, Point{bx.sum, by.sum});
    return with_expansion();
}

CSPACE_COLD inline int orientation(Point a, Point b, Point c) {
    return with_exact_differences(
        a, b, c, [](Point u, Point v) { return sign_of_difference(u.x, v.y, u.y, v.x); },
        [&] { return expanded_determinant(a, b, c).sign(); });
}

// Twice the area of the triangle a, b, c, rounded once or twice.
inline double determinant(Point a, Point b, Point c) {
    return with_exact_differences(
        a, b, c,
        [](Point u, Point v) {
            const Pair left = two_product(u.x, v.y), right = two_product(u.y, v.x);
            return (left.sum - right.sum) + (left.rest - right.rest);
        },
        [&] {
            const Expansion<12> det = expanded_determinant(a, b, c);
            double sum = 0;
            for (int i = 0; i < det.size; ++i) sum += det.part[i];
            return sum;
        });
}

}  // namespace exact

// Where c lies seen from a towards b: +1 to the left, −1 to the right, 0 on the line.
CSPACE_INLINE int orientation(Point a, Point b, Point c) {
    const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
    const double det = left - right;
    constexpr double error = 3.3306690738754716e-16;  // (3 + 16ε) ε, ε = 2⁻⁵³
    if (std::abs(det) > error * (std::abs(left) + std::abs(right))) return det > 0 ? 1 : -1;
    return exact::orientation(a, b, c);
}

// Whether d certainly lies inside the circle through a, b, c (counterclockwise); false where rounding leaves
// it open. Flips that this allows only ever lower the lifted surface, so they come to an end.
inline bool surely_in_circle(Point a, Point b, Point c, Point d) {
    const Point u = a - d, v = b - d, w = c - d;
    const double u2 = squared_norm(u), v2 = squared_norm(v), w2 = squared_norm(w);
    const double vw = v.x * w.y, wv = w.x * v.y, wu = w.x * u.y, uw = u.x * w.y, uv = u.x * v.y,
                 vu = v.x * u.y;
    const double det = u2 * (vw - wv) + v2 * (wu - uw) + w2 * (uv - vu);
    const double size = u2 * (std::abs(vw) + std::abs(wv)) + v2 * (std::abs(wu) + std::abs(uw)) +
                        w2 * (std::abs(uv) + std::abs(vu));
    constexpr double error = 1.1102230246251577e-15;  // (10 + 96ε) ε
    return det > error * size;
}

// Of three points on one line: whether b lies between a and c, ends included.
inline bool is_between(Point a, Point b, Point c) {
    if (a.x != c.x) return b.x >= std::fmin(a.x, c.x) && b.x <= std::fmax(a.x, c.x);
    return b.y >= std::fmin(a.y, c.y) && b.y <= std::fmax(a.y, c.y);
}

}  // namespace cspace
