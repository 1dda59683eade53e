// Real roots against polynomials multiplied out from roots that are known.
#include <algorithm>

#include "check.hpp"
#include "cspace/math/polynomial.hpp"
#include "cspace/math/trig_polynomial.hpp"
#include "cspace/math/wrapping.hpp"
#include "random.hpp"

using namespace cspace;
using check::Random;

namespace {

// The power of two 2ᵏ of Fujiwara's bound (1916) 2 max |a_{n−i} / a_n|^{1/i}, rounded up: the roots of
// Σ a_i 2ᵏⁱ yⁱ lie within the unit circle, and none of its coefficients exceeds the leading one.
inline int root_exponent(const double* a, int n) {
    int k = -2000;
    for (int i = 1; i <= n; ++i) {
        if (a[n - i] == 0) continue;
        const int e = std::ilogb(a[n - i]) - std::ilogb(a[n]) + 1;
        const int up = e >= 0 ? (e + i - 1) / i : -(-e / i);
        k = up > k ? up : k;
    }
    return k + 1;
}

// The real roots of a[0] + a[1] x + … + a[n] xⁿ, n ≤ 4. Coefficients of any scale; a root beyond 2¹⁰⁰⁰ counts
// as infinite and is left out. Roots are distinguished as long as their sizes lie within 1e70 of each other.
template <int n>
RealRoots real_roots(const double* a, double unit = 0.0) {
    if constexpr (n == 0) {
        RealRoots none;
        none.everywhere = a[0] == 0;
        return none;
    } else {
        if (a[n] == 0) return real_roots<n - 1>(a, unit);
        const int k = root_exponent(a, n);
        if (k > 1000) return real_roots<n - 1>(a, unit);
        RealRoots roots;
        if (k < -1000) {
            polynomial::append_root(roots, 0.0, n);
            return roots;
        }
        polynomial::Uncertain<n> p;
        const int top = std::ilogb(a[n]);
        for (int i = 0; i <= n; ++i) {
            p.a[i] = std::ldexp(a[i], (i - n) * k - top);
            p.error[i] = polynomial::evaluation_error<n> * std::fabs(p.a[i]);
        }
        roots = polynomial::bounded_roots(p, 1.0, std::ldexp(unit, -k));
        for (int i = 0; i < roots.count; ++i) roots.x[i] = std::ldexp(roots.x[i], k);
        return roots;
    }
}

// Multiplies the polynomial a (degree n, room for n + 2) by (x − root).
void times_linear(double* a, int n, double root) {
    a[n + 1] = a[n];
    for (int i = n; i > 0; --i) a[i] = a[i - 1] - root * a[i];
    a[0] *= -root;
}
// Multiplies by x² − 2 re x + re² + im².
void times_pair(double* a, int n, double re, double im) {
    double b[7] = {};
    for (int i = 0; i <= n; ++i) {
        b[i] += a[i] * (re * re + im * im);
        b[i + 1] -= 2 * re * a[i];
        b[i + 2] += a[i];
    }
    std::copy(b, b + n + 3, a);
}
template <int n>
void check_roots(const double* a, std::vector<double> expected, double tolerance) {
    std::sort(expected.begin(), expected.end());
    const RealRoots r = real_roots<n>(a);
    CHECK(r.count == int(expected.size()));
    if (r.count != int(expected.size())) return;
    for (int i = 0; i < r.count; ++i) CHECK_NEAR(r.x[i], expected[i], tolerance * std::fabs(expected[i]));
}
bool apart(const std::vector<double>& x, double gap) {
    for (size_t i = 0; i < x.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            if (std::fabs(x[i] - x[j]) < gap) return false;
    return true;
}

}  // namespace

TEST(random_roots_come_back_at_every_scale) {
    Random random{1};
    for (int repeat = 0; repeat < 20000; ++repeat) {
        const double unit = std::pow(10.0, random.uniform(-20, 20));
        const double factor = std::pow(10.0, random.uniform(-150, 150));
        const int n = 2 + random.below(3), pairs = random.below(n / 2 + 1);
        double a[7] = {1};
        std::vector<double> real;
        int degree = 0;
        for (; degree < 2 * pairs; degree += 2)
            times_pair(a, degree, unit * random.uniform(-1, 1), unit * random.uniform(0.05, 1));
        for (; degree < n; ++degree) {
            real.push_back(unit * random.uniform(-1, 1));
            times_linear(a, degree, real.back());
        }
        for (double& c : a) c *= factor;
        bool representable = apart(real, 0.02 * unit) && std::fabs(a[0]) > 1e-280 && std::isfinite(a[0]);
        for (double x : real) representable = representable && std::fabs(x) > 0.01 * unit;
        for (int i = 0; i <= n; ++i) representable = representable && std::isfinite(a[i]);
        if (!representable) continue;
        if (n == 2) check_roots<2>(a, real, 1e-9);
        if (n == 3) check_roots<3>(a, real, 1e-9);
        if (n == 4) check_roots<4>(a, real, 1e-9);
    }
}

TEST(roots_of_very_different_sizes_come_back) {
    for (double small = 1e-3; small > 1e-14; small *= 0.1) {
        double a[7] = {1};
        times_linear(a, 0, 1 / small);
        times_linear(a, 1, -1);
        times_linear(a, 2, small);
        times_linear(a, 3, -small * small);
        check_roots<4>(a, {1 / small, -1, small, -small * small}, 1e-12);
    }
}

TEST(roots_beside_a_flat_turning_point_come_back) {
    // Coefficients in between that are zero or nothing but rounding: Halley's step vanishes with the slope.
    Random random{6};
    for (int repeat = 0; repeat < 20000; ++repeat) {
        const double rounding = random.below(3) ? std::pow(10.0, random.uniform(-20, -12)) : 0.0;
        const double far = std::pow(10.0, random.uniform(-2, 2)), fourth = far * far * far * far;
        const double unit[5] = {fourth, far * far * far, far * far, far, 1};
        double a[5] = {-fourth, 0, 0, 0, 1};
        for (int i = 1; i < 4; ++i) a[i] = random.below(2) * rounding * random.uniform(-1, 1) * unit[i];
        check_roots<4>(a, {-far, far}, 1e-10);
        a[0] = -unit[1];
        a[1] *= 1 / far, a[2] *= 1 / far, a[3] = 1;
        check_roots<3>(a, {far}, 1e-10);
    }
}

TEST(clusters_keep_their_multiplicity) {
    Random random{2};
    for (int repeat = 0; repeat < 2000; ++repeat) {
        // Small binary fractions: every coefficient is exact, so is the multiplicity.
        const double x = random.below(64) / 16.0 - 2, y = x + 1 + random.below(8) / 8.0;
        double a[7] = {1};
        const int kind = random.below(5);
        const int many[5][2] = {{2, 1}, {2, 2}, {3, 1}, {4, 0}, {1, 3}};
        int degree = 0;
        for (int i = 0; i < many[kind][0]; ++i) times_linear(a, degree++, x);
        for (int i = 0; i < many[kind][1]; ++i) times_linear(a, degree++, y);
        const RealRoots r = degree == 3 ? real_roots<3>(a) : real_roots<4>(a);
        const double blur = many[kind][0] == 2 || kind == 4 ? 1e-7 : 2e-4;
        CHECK(r.count == (many[kind][1] ? 2 : 1));
        CHECK(r.multiplicity[0] == many[kind][0]);
        CHECK_NEAR(r.x[0], x, blur);
        if (many[kind][1]) CHECK(r.multiplicity[1] == many[kind][1]);
        if (many[kind][1]) CHECK_NEAR(r.x[1], y, kind == 4 ? 2e-4 : 1e-7);
    }
}

TEST(close_roots_are_told_apart_and_nearly_real_pairs_are_double) {
    for (double gap = 1e-2; gap > 1e-6; gap *= 0.5) {
        double a[7] = {1}, b[7] = {1};
        times_linear(a, 0, 1);
        times_linear(a, 1, 1 + gap);
        times_pair(a, 2, -2, 1);
        CHECK(real_roots<4>(a).count == 2);
        times_pair(b, 0, 1, gap);
        times_pair(b, 2, -2, 1);
        CHECK(real_roots<4>(b).count == 0);
    }
    for (double im : {1e-8, 1e-10, 0.0}) {
        double b[7] = {1};
        times_pair(b, 0, 0.7, im);
        times_pair(b, 2, -2, 1);
        const RealRoots r = real_roots<4>(b);
        CHECK(r.count == 1 && r.multiplicity[0] == 2);
        CHECK_NEAR(r.x[0], 0.7, 1e-7);
    }
}

TEST(lower_degrees_and_the_zero_polynomial) {
    const double cubic[5] = {-6, 11, -6, 1, 0}, line[5] = {-3, 2, 0, 0, 0}, zero[5] = {}, one[5] = {1};
    CHECK(real_roots<4>(cubic).count == 3);
    CHECK_NEAR(real_roots<4>(line).x[0], 1.5, 1e-15);
    CHECK(real_roots<4>(zero).everywhere);
    CHECK(real_roots<4>(one).count == 0 && !real_roots<4>(one).everywhere);
    const double far[5] = {-1, 1, 0, 0, 1e-320};
    CHECK_NEAR(real_roots<4>(far).x[real_roots<4>(far).count - 1], 1, 1e-12);
    const double quartic_zero[5] = {0, 0, 0, 0, 5};
    CHECK(real_roots<4>(quartic_zero).multiplicity[0] == 4);
}

TEST(quadratics_on_a_pack_agree_with_one_lane) {
    Random random{3};
    using V = Pack<4>;
    for (int repeat = 0; repeat < 1000; ++repeat) {
        V a, b, c;
        for (int i = 0; i < 4; ++i) {
            set_lane(a, i, random.uniform(-1, 1));
            set_lane(b, i, random.below(5) ? random.uniform(-1, 1) : 0.0);
            set_lane(c, i, random.below(5) ? random.uniform(-1, 1) : 0.0);
        }
        const auto r = quadratic_roots(a, b, c);
        for (int i = 0; i < 4; ++i) {
            const auto one = quadratic_roots(get_lane(a, i), get_lane(b, i), get_lane(c, i));
            CHECK(get_lane(r.real, i) == one.real && get_lane(r.two, i) == one.two);
            for (int j = 0; j < 2; ++j) {
                CHECK_NEAR(get_lane(r.x[j], i), one.x[j], 1e-15 * std::fabs(one.x[j]));
                const double x = one.x[j], A = get_lane(a, i) * x * x, B = get_lane(b, i) * x,
                             C = get_lane(c, i);
                if (one.real) CHECK_NEAR(A + B + C, 0, 4e-16 * (std::fabs(A) + std::fabs(B) + std::fabs(C)));
            }
        }
    }
}

TEST(trigonometric_roots_are_all_found) {
    Random random{4};
    for (int repeat = 0; repeat < 5000; ++repeat) {
        const double factor = std::pow(10.0, random.uniform(-100, 100));
        const auto any = [&] { return factor * random.uniform(-1, 1); };
        TrigPolynomial f = {any(), any(), any(), any(), any()};
        if (random.below(4) == 0) f.a2 = f.b2 = 0;
        if (random.below(4) == 0) f.a0 = f.a1 - f.a2;  // a root at π
        const TrigRoots r = trig_roots(f);
        int roots = 0, crossings = 0;
        for (int i = 0; i < r.count; ++i) {
            CHECK_NEAR(evaluate_polynomial(f, r.theta[i]) / factor, 0,
                       r.multiplicity[i] == 1 ? 3e-15 : 1e-13);
            CHECK_NEAR(std::hypot(r.theta[i].c, r.theta[i].s), 1, 1e-15);
            roots += r.multiplicity[i];
        }
        double before = evaluate_polynomial(f, turn_by(1e-3));
        for (int j = 1; j <= 400; ++j) {
            const double after = evaluate_polynomial(f, turn_by(1e-3 + 2 * pi * j / 400));
            crossings += before * after < 0;
            before = after;
        }
        CHECK(roots % 2 == 0 && roots <= 4 && crossings <= roots);
    }
}

TEST(a_trigonometric_polynomial_of_degree_one_has_two_roots_wherever_they_lie) {
    Random random{7};
    for (int repeat = 0; repeat < 20000; ++repeat) {
        const double rounding = random.below(3) ? std::pow(10.0, random.uniform(-20, -13)) : 0.0;
        const auto any = [&] { return random.below(2) * rounding * random.uniform(-1, 1); };
        const double middle = random.below(3) ? 0.25 * pi * random.below(8) : random.uniform(-3, 3);
        const double aside = random.below(3) ? 0.5 * pi : random.uniform(0.2, 2.9);
        const double size = std::pow(10.0, random.uniform(-3, 3));
        const TrigPolynomial f = {size * (any() - std::cos(aside)), size * (any() + std::cos(middle)),
                                  size * (any() + std::sin(middle)), size * any(), size * any()};
        const TrigRoots r = trig_roots(f, size);
        CHECK(r.count == 2);
        for (const double expected : {middle + aside, middle - aside}) {
            double nearest = 10;
            for (int i = 0; i < r.count; ++i)
                nearest = std::fmin(nearest, std::fabs(short_way(angle_of(r.theta[i]) - expected)));
            CHECK_NEAR(nearest, 0, 1e-11);
        }
    }
}

TEST(a_touching_trigonometric_polynomial_has_double_roots) {
    Random random{5};
    for (int repeat = 0; repeat < 1000; ++repeat) {
        const double p = random.uniform(-3, 3), q = random.uniform(-3, 3);
        if (std::fabs(std::sin(0.5 * (p - q))) < 0.4) continue;
        // (1 − cos(θ − p)) (1 − cos(θ − q)) touches zero at p and q.
        const TrigRoots r =
            trig_roots(product({1, -std::cos(p), -std::sin(p)}, {1, -std::cos(q), -std::sin(q)}));
        CHECK(r.count == 2 && r.multiplicity[0] == 2 && r.multiplicity[1] == 2);
        for (int i = 0; i < r.count; ++i) {
            const double to_p = std::hypot(r.theta[i].c - std::cos(p), r.theta[i].s - std::sin(p));
            const double to_q = std::hypot(r.theta[i].c - std::cos(q), r.theta[i].s - std::sin(q));
            CHECK_NEAR(std::fmin(to_p, to_q), 0, 1e-7);
        }
    }
    CHECK(trig_roots({1e-17, 0, 0, 0, 1e-17}, 1.0).everywhere);
}
