// A trigonometric polynomial of degree 8 from its values, arc by arc in Bernstein form.
//
// On an arc of the circle the half angle's cosine and sine, scaled, are linear in u ∈ [0, 1]: with the arc's
// centre φ and a quarter α of its width, (C, S) ∝ (cos α, (2u − 1) sin α). Times the 16th power of their
// length a polynomial of degree 8 in cos and sin is one of degree 16 in u, whose Bernstein coefficients show
// its signs.
#pragma once

#include "cspace/math/bernstein.hpp"
#include "cspace/math/rows.hpp"
#include "cspace/math/trig.hpp"
#include "cspace/tolerances.hpp"

namespace cspace::ik {

inline constexpr int harmonics = 8, degree = 2 * harmonics, samples = 20, arcs = 10;
// [rad] No arc, nor a half of one, ends at an angle that has a name: solutions like to merge there, and a
// double root on a border shows no sign.
inline constexpr double askew = 0.1;
inline constexpr int padded = 20;  // degree + 1 coefficients or nodes, up to whole packs of four

// Ten arcs of 36° share one matrix: two samples stand on each, and the next arc sees them two further on.
struct SamplerTables {
    double angle[samples];
    double cosine[samples], sine[samples];
    double to_arc[samples][padded];           // samples, from the arc's first on, to coefficients
    double arc_gain;                          // largest sum of magnitudes over the samples
    double alias[3][samples];                 // to the harmonics 9 and 10, which a true polynomial lacks
    double node[padded];                      // u where an arc is sampled anew (Chebyshev)
    double to_chebyshev[degree + 1][padded];  // values at the nodes to Chebyshev coefficients, a row each
    double to_bernstein[degree + 1][padded];  // T_n in Bernstein form, a row each
    double bernstein_gain[degree + 1];        // its largest coefficient
    // The coefficients of an arc, a row each, to those of its two halves.
    double lower_half[degree + 1][padded], upper_half[degree + 1][padded];
};

// A piece of the circle: the part [from, to] of an arc sampled at once.
struct Arc {
    double b[padded];
    double centre, quarter;
    double from, to;
    double noise;  // of the coefficients
    bool resampled;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

inline double binomial(int n, int k) {
    if (k < 0 || k > n) return 0;
    double out = 1;
    for (double i = 0; i < k; ++i) out = out * (n - i) / (i + 1);
    return out;
}

// The angle on an arc, from its centre.
inline double arc_angle(double u, double quarter) {
    return 2 * std::atan2((2 * u - 1) * std::sin(quarter), std::cos(quarter));
}
// The factor between the function on an arc and its polynomial.
inline double arc_weight(double u, double quarter) {
    const double c = std::cos(quarter), s = (2 * u - 1) * std::sin(quarter);
    double r = c * c + s * s;
    r *= r;
    r *= r;
    return r * r;
}

// The Bernstein coefficient i of cos kθ and sin kθ on an arc around zero: with z = C + iS the functions are
// the parts of z^(8+k) z̄^(8−k), a product of linear factors.
inline void harmonic_coefficient(int k, int i, double quarter, double& cosine, double& sine) {
    cosine = sine = 0;
    for (int j = 0; j <= i; ++j) {
        const double weight =
            binomial(harmonics + k, j) * binomial(harmonics - k, i - j) / binomial(degree, i);
        cosine += weight * std::cos(quarter * (4 * j - 2 * i - 2 * k));
        sine += weight * std::sin(quarter * (4 * j - 2 * i - 2 * k));
    }
}

inline void fill_arc_matrix(SamplerTables& t) {
    constexpr double quarter = 2 * pi / arcs / 4, step = 2 * pi / samples;
    t.arc_gain = 0;
    for (int i = 0; i <= degree; ++i) {
        double c[harmonics + 1], s[harmonics + 1], gain = 0;
        for (int k = 0; k <= harmonics; ++k) harmonic_coefficient(k, i, quarter, c[k], s[k]);
        for (int j = 0; j < samples; ++j) {
            const double from_centre = (j - 0.5) * step;
            double sum = c[0];
            for (int k = 1; k <= harmonics; ++k)
                sum += 2 * (c[k] * std::cos(k * from_centre) + s[k] * std::sin(k * from_centre));
            t.to_arc[j][i] = sum / samples;
            gain += std::fabs(t.to_arc[j][i]);
        }
        t.arc_gain = max(t.arc_gain, gain);
    }
}

inline void fill_node_matrices(SamplerTables& t) {
    constexpr int n_nodes = degree + 1;
    for (int m = 0; m < padded; ++m) {
        const double angle = pi - pi * (m + 0.5) / n_nodes;
        t.node[m] = m < n_nodes ? 0.5 + 0.5 * std::cos(angle) : 0.5;
        for (int n = 0; n < n_nodes; ++n)
            t.to_chebyshev[n][m] = m < n_nodes ? (n == 0 ? 1.0 : 2.0) / n_nodes * std::cos(n * angle) : 0;
    }
    for (int n = 0; n < n_nodes; ++n) {
        double* b = t.to_bernstein[n];
        for (int i = 0; i <= n; ++i)
            b[i] = ((n - i) % 2 ? -1.0 : 1.0) * binomial(2 * n, 2 * i) / binomial(n, i);
        for (int d = n; d < degree; ++d)  // raise the degree from d to d + 1
            for (int i = d + 1; i >= 0; --i)
                b[i] = double(i) / (d + 1) * (i > 0 ? b[i - 1] : 0) + (1 - double(i) / (d + 1)) * b[i];
        t.bernstein_gain[n] = 0;
        for (int i = 0; i < n_nodes; ++i) t.bernstein_gain[n] = max(t.bernstein_gain[n], std::fabs(b[i]));
    }
}

// de Casteljau (1959): coefficient i of the lower half is the mean of those up to i by the weights of i
// tosses.
inline void fill_halves(SamplerTables& t) {
    for (int i = 0; i <= degree; ++i)
        for (int j = 0; j <= i; ++j) {
            const double weight = std::ldexp(binomial(i, j), -i);
            t.lower_half[j][i] = weight;
            t.upper_half[degree - j][degree - i] = weight;
        }
}

inline SamplerTables make_sampler_tables() {
    SamplerTables t{};
    for (int j = 0; j < samples; ++j) {
        const double on_grid = 2 * pi * (j + 0.5) / samples;
        t.angle[j] = on_grid + askew;
        t.cosine[j] = std::cos(t.angle[j]);
        t.sine[j] = std::sin(t.angle[j]);
        t.alias[0][j] = 2.0 / samples * std::cos(9 * on_grid);
        t.alias[1][j] = 2.0 / samples * std::sin(9 * on_grid);
        t.alias[2][j] = 1.0 / samples * std::sin(10 * on_grid);
    }
    fill_arc_matrix(t);
    fill_node_matrices(t);
    fill_halves(t);
    return t;
}
#ifdef CSPACE_TABLES_AT_START  // made on first use they would need the run-time library of C++
static const SamplerTables tables_of_sampler = make_sampler_tables();
inline const SamplerTables& sampler_tables() { return tables_of_sampler; }
#else
inline const SamplerTables& sampler_tables() {
    static const SamplerTables tables = make_sampler_tables();
    return tables;
}
#endif

// out = Σ x_j row_j
CSPACE_INLINE void combine_rows(const double (*row)[padded], const double* x, int count, double* out) {
    using V = Pack<native_width>;
    constexpr int whole = padded / native_width, rest = padded % native_width;  // rest: none or four
    V sum[whole];
    Pack<4> last = fill_lanes<Pack<4>>(0.0);
    for (V& v : sum) v = fill_lanes<V>(0.0);
    for (int j = 0; j < count; ++j) {
        for (int i = 0; i < whole; ++i)
            sum[i] = mul_add(fill_lanes<V>(x[j]), load_lanes<V>(row[j] + native_width * i), sum[i]);
        if constexpr (rest > 0)
            last = mul_add(fill_lanes<Pack<4>>(x[j]), load_lanes<Pack<4>>(row[j] + padded - rest), last);
    }
    for (int i = 0; i < whole; ++i) store_lanes(out + native_width * i, sum[i]);
    if constexpr (rest > 0) store_lanes(out + padded - rest, last);
}

// The arc that starts at sample 2 k; f: the samples, twice round.
inline void read_arc(const SamplerTables& t, const double* f, int k, Arc& arc) {
    combine_rows(t.to_arc, f + 2 * k, samples, arc.b);
    arc.centre = t.angle[2 * k] + pi / samples;
    arc.quarter = 2 * pi / arcs / 4;
    arc.from = 0;
    arc.to = 1;
    arc.resampled = false;
}

// A piece of an arc sampled anew by f(c, s) on packs of four, in units of `unit`. Chebyshev coefficients that
// drown in the noise of the samples are dropped: what they would put into the Bernstein form is noise
// enlarged.
template <class Function>
inline void resample_arc(const SamplerTables& t, const Function& f, double unit, double centre,
                         double quarter, Arc& arc) {
    using V = Pack<4>;
    double g[padded], largest = 0;
    for (int m = 0; m < padded; m += 4) {
        V angle, s, c;
        for (int k = 0; k < 4; ++k) set_lane(angle, k, centre + arc_angle(t.node[m + k], quarter));
        sincos(angle, s, c);
        store_lanes(g + m, f(c, s));
    }
    for (int m = 0; m <= degree; ++m) {
        g[m] *= arc_weight(t.node[m], quarter) / unit;
        largest = max(largest, std::fabs(g[m]));
    }
    for (int m = degree + 1; m < padded; ++m) g[m] = 0;
    double c[degree + 1];
    for (int n = 0; n <= degree; ++n) {
        double sum = 0;
        for (int m = 0; m < padded; ++m) sum += t.to_chebyshev[n][m] * g[m];
        c[n] = sum;
    }
    // On a piece of an arc the last coefficients are nothing but noise, and measure it.
    double tail = 0;
    for (int n = degree - 2; n <= degree; ++n) tail = max(tail, std::fabs(c[n]));
    const double noise = max(tolerance::last_digits * largest, 8 * tail);
    int top = 0;
    for (int n = 0; n <= degree; ++n)
        if (std::fabs(c[n]) > noise) top = n;
    combine_rows(t.to_bernstein, c, top + 1, arc.b);
    arc.centre = centre;
    arc.quarter = quarter;
    arc.from = 0;
    arc.to = 1;
    arc.noise = noise * (degree - top + 2 * t.bernstein_gain[top]);
    arc.resampled = true;
}

}  // namespace cspace::ik::inline CSPACE_ISA
